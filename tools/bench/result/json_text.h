// Text of a JSON file of the result folder, within the limits of tools/base/limits/json.h.
#pragma once

#include <filesystem>
#include <string>

namespace vobench {

// Throws evaluation::InputError naming the file.
std::string ReadJsonText(const std::filesystem::path& file);

}  // namespace vobench
