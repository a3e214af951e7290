// Purpose: short names for long contents: the same content has the same name, another one another.
// Source:  XXH3 with 128 bits (Collet): not against malice.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace campaign {

// 32 hexadecimal digits of a text.
std::string Digest(std::string_view text);

// The same of a file's content; "absent" where it cannot be opened.
std::string DigestOfFile(const std::filesystem::path& file);

// Of the program that runs: another build is another program.
std::string DigestOfProgram();

}  // namespace campaign
