// Decoder of image files that rejects damaged ones, which decoders complete with grey.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace cv {
class Mat;
}

namespace sim {

struct DecodedImage {
  explicit DecodedImage(const cv::Mat& of);  // of CV_8UC3, whose memory it shares

  int width = 0, height = 0;
  std::shared_ptr<cv::Mat> pixels;
  std::span<std::uint8_t> rgb;      // of the pixels: width * height * 3, rows from the top
  std::vector<std::uint8_t> alpha;  // width * height where requested and present in the picture, or nothing
};

// Decodes the kinds and sizes of picture that tools/base/limits/picture.h accepts (PNG, JPEG, BMP, TIFF, WebP, ...) to
// 8 bits a channel. EXIF orientation is not applied. PNG chunks (lengths, checksums, the end chunk) and JPEG segments
// (the end marker) are checked first, since decoders accept some truncated files. Throws std::runtime_error with the
// problem, without a file name.
DecodedImage DecodeImage(std::span<const std::uint8_t> bytes, bool with_alpha = false);

// What stands in the place of a file that was not fetched, and the remedy; empty: nothing of the kind.
std::string StandInProblem(std::span<const std::uint8_t> bytes);

// Alpha of `image`: the mask's own, or its brightness where that is opaque; of the image's size.
void SetAlpha(const DecodedImage& mask, DecodedImage& image);

// OpenCV's decoding, with its flags IMREAD_...; without prior checks. Throws as DecodeImage.
cv::Mat DecodeMatrix(std::span<const std::uint8_t> bytes, int flags);

}  // namespace sim
