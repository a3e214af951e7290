#include "tools/bench/result/json_text.h"

#include <fstream>
#include <iterator>

#include "tools/base/limits/json.h"
#include "tools/judge/evaluation/text_file.h"

namespace vobench {

std::string ReadJsonText(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw evaluation::InputError({file.string() + ": cannot be opened"});
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (const std::string problem = limits::JsonProblem(text); !problem.empty())
    throw evaluation::InputError({file.string() + ": " + problem});
  return text;
}

}  // namespace vobench
