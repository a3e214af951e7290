#include "sim/world/image_file.h"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "tools/base/limits/picture.h"

namespace sim {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a};

std::uint32_t BigEndian32(Bytes b) {
  return (std::uint32_t{b[0]} << 24) | (std::uint32_t{b[1]} << 16) | (std::uint32_t{b[2]} << 8) | b[3];
}

void CheckPng(Bytes bytes) {
  std::size_t at = kPngSignature.size();
  for (;;) {  // length, type, data, checksum
    if (at + 12 > bytes.size()) throw std::runtime_error("truncated PNG: the end chunk is missing");
    const std::size_t length = BigEndian32(bytes.subspan(at));
    if (length > bytes.size() - at - 12) throw std::runtime_error("truncated PNG: a chunk is cut off");
    const Bytes type_and_data = bytes.subspan(at + 4, length + 4);
    if (libdeflate_crc32(0, type_and_data.data(), type_and_data.size()) !=
        BigEndian32(bytes.subspan(at + 8 + length))) {
      throw std::runtime_error("damaged PNG: wrong checksum in the chunk at byte " + std::to_string(at));
    }
    const std::array<std::uint8_t, 4> end{'I', 'E', 'N', 'D'};
    if (std::equal(end.begin(), end.end(), type_and_data.begin())) return;
    at += length + 12;
  }
}

void CheckJpeg(Bytes bytes) {
  constexpr std::uint8_t kStartOfScan = 0xda, kEndOfImage = 0xd9;
  const auto truncated = [] { return std::runtime_error("truncated JPEG: the end marker is missing"); };
  std::size_t at = 2;
  bool in_scan = false;
  for (;;) {
    if (in_scan) {  // entropy-coded data goes on until a marker that is neither a stuffed zero nor a restart
      while (at + 1 < bytes.size() &&
             (bytes[at] != 0xff || bytes[at + 1] == 0x00 || (bytes[at + 1] >= 0xd0 && bytes[at + 1] <= 0xd7))) {
        ++at;
      }
    }
    while (at + 1 < bytes.size() && bytes[at] == 0xff && bytes[at + 1] == 0xff) ++at;  // fill bytes
    if (at + 2 > bytes.size()) throw truncated();
    if (bytes[at] != 0xff) throw std::runtime_error("damaged JPEG: no marker at byte " + std::to_string(at));
    const std::uint8_t marker = bytes[at + 1];
    if (marker == kEndOfImage) return;
    if (at + 4 > bytes.size()) throw truncated();
    at += 2 + ((std::size_t{bytes[at + 2]} << 8) | bytes[at + 3]);
    in_scan = marker == kStartOfScan;
  }
}

}  // namespace

cv::Mat DecodeMatrix(Bytes bytes, int flags) {
  cv::Mat picture;
  try {
    const cv::Mat data(1, static_cast<int>(bytes.size()), CV_8U, const_cast<std::uint8_t*>(bytes.data()));
    if (!bytes.empty()) picture = cv::imdecode(data, flags);
  } catch (const cv::Exception& error) {
    throw std::runtime_error("cannot be decoded: " + error.err);
  }
  if (picture.empty()) throw std::runtime_error("not a picture that can be decoded");
  return picture;
}

DecodedImage DecodeImage(Bytes bytes, bool with_alpha) {
  if (bytes.empty()) throw std::runtime_error("the file is empty");
  if (const std::string problem = limits::PictureProblem(bytes); !problem.empty()) throw std::runtime_error(problem);
  if (bytes.size() >= kPngSignature.size() && std::equal(kPngSignature.begin(), kPngSignature.end(), bytes.begin())) {
    CheckPng(bytes);
  } else if (bytes.size() >= 2 && bytes[0] == 0xff && bytes[1] == 0xd8) {
    CheckJpeg(bytes);
  }
  const cv::Mat bgr = DecodeMatrix(bytes, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION),
                all = with_alpha ? DecodeMatrix(bytes, cv::IMREAD_UNCHANGED) : cv::Mat();
  DecodedImage image{bgr.cols, bgr.rows, std::vector<std::uint8_t>(bgr.total() * 3), {}};
  if (all.channels() == 4 && all.size() == bgr.size() && (all.depth() == CV_8U || all.depth() == CV_16U)) {
    cv::Mat alpha;
    cv::extractChannel(all, alpha, 3);
    alpha.convertTo(alpha, CV_8U, all.depth() == CV_16U ? 1.0 / 257.0 : 1.0);
    image.alpha.assign(alpha.begin<std::uint8_t>(), alpha.end<std::uint8_t>());
  }
  cv::cvtColor(bgr, cv::Mat(bgr.size(), CV_8UC3, image.rgb.data()), cv::COLOR_BGR2RGB);
  return image;
}

}  // namespace sim
