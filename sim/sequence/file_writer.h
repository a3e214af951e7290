// Purpose: bytes onto the disk, or a clear word why not.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace sim {

// Makes a new file; every step is checked, closing too. Throws std::runtime_error naming the file and the system's
// reason.
void WriteNewFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void WriteNewFile(const std::filesystem::path& path, std::string_view text);

}  // namespace sim
