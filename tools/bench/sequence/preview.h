// Preview of a sequence: a video and a contact sheet.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace vobench {

struct PreviewFrame {
  std::int64_t index = 0;
  std::int64_t stamp_ns = 0;
  std::filesystem::path image;  // 8 or 16 bits, grey or colour
};

// Writes preview.mp4, with so many frames per second, and contact.jpg, up to 24 frames spread evenly, with their
// numbers and stamps. Both appear whole. Throws std::runtime_error naming the file that cannot be written or read back.
void WritePreview(const std::filesystem::path& folder, const std::vector<PreviewFrame>& frames, double rate_hz);

}  // namespace vobench
