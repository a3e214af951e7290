// Purpose: bytes onto the disk, or a clear word why not.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace sim {

// The name of a file that is being written.
std::string UnfinishedName(const std::string& name);

// Every step is checked, closing too. All throw std::runtime_error naming the file and the system's reason.

// The file appears under its name when it is whole, and replaces an older one; until then it has a hidden name beside
// it (UnfinishedName), which goes when something is wrong. The folder is made where it is not there.
void WriteFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

// The same for no more bytes than the file has. On a full disk they are written over the old ones, which needs no room.
void ShortenFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

// Behind what is there, with one call to the system.
void AppendToFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

}  // namespace sim
