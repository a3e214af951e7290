#include "tools/report/json_text.h"

#include <fstream>
#include <iterator>

#include "tools/evaluation/text_file.h"
#include "tools/limits/json.h"

namespace report {

std::string ReadJsonText(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw evaluation::InputError({file.string() + ": cannot be opened"});
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (const std::string problem = limits::JsonProblem(text); !problem.empty())
    throw evaluation::InputError({file.string() + ": " + problem});
  return text;
}

}  // namespace report
