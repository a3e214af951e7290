#include "tools/bench/result/json_text.h"

#include <optional>
#include <utility>

#include "tools/base/files.h"
#include "tools/base/limits/json.h"
#include "tools/judge/evaluation/text_file.h"

namespace vobench {

std::string ReadJsonText(const std::filesystem::path& file) {
  std::optional<std::string> text = base::ReadFile(file);
  if (!text) throw evaluation::InputError({file.string() + ": cannot be opened"});
  if (const std::string problem = limits::JsonProblem(*text); !problem.empty())
    throw evaluation::InputError({file.string() + ": " + problem});
  return std::move(*text);
}

}  // namespace vobench
