// Purpose: the text of a JSON file of the result folder, once it may be parsed (tools/base/limits/json.h).
#pragma once

#include <filesystem>
#include <string>

namespace report {

// Throws evaluation::InputError naming the file.
std::string ReadJsonText(const std::filesystem::path& file);

}  // namespace report
