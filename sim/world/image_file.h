// Decoder of image files that refuses damaged ones, which decoders complete with grey.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace cv {
class Mat;
}

namespace sim {

struct DecodedImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;    // width * height * 3, rows from the top
  std::vector<std::uint8_t> alpha;  // width * height where it was asked for and the picture has it, or nothing
};

// Decodes the kinds and sizes of picture that tools/base/limits/picture.h lets pass (PNG, JPEG, BMP, TIFF, WebP, ...)
// to 8 bits a channel. EXIF orientation is not applied. PNG chunks (lengths, checksums, the end chunk) and JPEG
// segments (the end marker) are checked first, since decoders accept some truncated files. Throws std::runtime_error
// saying what is wrong, without a file name.
DecodedImage DecodeImage(std::span<const std::uint8_t> bytes, bool with_alpha = false);

// Alpha of `image`: the mask's own, or its brightness where it has none; of the image's size.
void SetAlpha(const DecodedImage& mask, DecodedImage& image);

// What OpenCV makes of it, with its flags IMREAD_...; nothing is checked before. Throws as DecodeImage.
cv::Mat DecodeMatrix(std::span<const std::uint8_t> bytes, int flags);

}  // namespace sim
