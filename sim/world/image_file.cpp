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

// Of a PNG that has its end.
void CheckSums(Bytes bytes) {
  for (std::size_t at = kPngSignature.size(); at + 12 <= bytes.size();) {  // length, type, data, checksum
    const std::size_t length = BigEndian32(bytes.subspan(at));
    const Bytes type_and_data = bytes.subspan(at + 4, length + 4);
    if (libdeflate_crc32(0, type_and_data.data(), type_and_data.size()) !=
        BigEndian32(bytes.subspan(at + 8 + length))) {
      throw std::runtime_error("damaged PNG: wrong checksum in the chunk at byte " + std::to_string(at));
    }
    if (type_and_data[1] == 'E' && type_and_data[0] == 'I') return;
    at += length + 12;
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
  for (const std::string& problem : {limits::PictureProblem(bytes), limits::PictureEndProblem(bytes)}) {
    if (!problem.empty()) throw std::runtime_error(problem);
  }
  if (bytes.size() >= kPngSignature.size() && std::equal(kPngSignature.begin(), kPngSignature.end(), bytes.begin())) {
    CheckSums(bytes);
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

void SetAlpha(const DecodedImage& mask, DecodedImage& image) {
  const auto view = [&](const std::vector<std::uint8_t>& bytes, int type) {
    return cv::Mat(mask.height, mask.width, type, const_cast<std::uint8_t*>(bytes.data()));
  };
  cv::Mat alpha;
  if (mask.alpha.empty()) {
    cv::cvtColor(view(mask.rgb, CV_8UC3), alpha, cv::COLOR_RGB2GRAY);
  } else {
    alpha = view(mask.alpha, CV_8UC1);
  }
  cv::Mat fitting;
  cv::resize(alpha, fitting, cv::Size(image.width, image.height), 0, 0, cv::INTER_LINEAR);
  image.alpha.assign(fitting.begin<std::uint8_t>(), fitting.end<std::uint8_t>());
}

}  // namespace sim
