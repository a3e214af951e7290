// Content digests: equal contents have equal names. Not cryptographic.
// Source: XXH3 with 128 bits (Collet).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace vobench::campaign {

// 32 hexadecimal digits of a text.
std::string Digest(std::string_view text);

// The same of a file's content; "absent" where it cannot be opened.
std::string DigestOfFile(const std::filesystem::path& file);

// Of the program that runs: another build is another program.
std::string DigestOfProgram();

}  // namespace vobench::campaign
