#include "tools/bench/result/json_file.h"

#include <optional>

#include "tools/base/files.h"
#include "tools/base/limits/structured_text.h"

namespace vobench {

nlohmann::ordered_json ReadJson(const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& why) { return evaluation::InputError({file.string() + ": " + why}); };
  const std::optional<std::string> text = base::ReadFile(file);
  if (!text) throw refuse("cannot be opened");
  if (const std::string problem = limits::JsonProblem(*text); !problem.empty()) throw refuse(problem);
  try {
    return nlohmann::ordered_json::parse(*text);
  } catch (const nlohmann::json::exception& error) {
    throw refuse(error.what());
  }
}

}  // namespace vobench
