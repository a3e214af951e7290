#include "sim/sequence/format.h"

#include <cmath>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "tools/settings/quantity.h"

namespace sim {
namespace {

// OpenCV writes blue first, and its matrices borrow what they look at.
cv::Mat ToMat(const Image& image) {
  cv::Mat view;
  if (image.bits == 8) {
    view = cv::Mat(image.height, image.width, CV_8UC(image.channels), const_cast<std::uint8_t*>(image.data.data()));
  } else {  // the highest bits of 16, so that white is white in every viewer
    const cv::Mat wide(image.height, image.width, CV_16UC(image.channels),
                       const_cast<std::uint16_t*>(image.wide.data()));
    wide.convertTo(view, -1, 1 << (16 - image.bits));
  }
  if (image.channels == 1) return view;
  cv::Mat bgr;
  cv::cvtColor(view, bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

std::vector<std::uint8_t> Encode(const cv::Mat& mat) {
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".png", mat, bytes)) throw std::runtime_error("OpenCV cannot encode a PNG picture");
  return bytes;
}

// Numbers separated by blanks; a negative zero loses its sign.
std::string Line(std::int64_t stamp_ns, std::initializer_list<double> numbers) {
  std::string line = FormatStamp(stamp_ns);
  for (const double number : numbers) {
    char text[64];
    std::snprintf(text, sizeof text, " %.12f", number);
    line += std::string(text) == " -0.000000000000" ? " 0.000000000000" : text;
  }
  return line + "\n";
}

}  // namespace

std::string FormatStamp(std::int64_t stamp_ns) {
  char text[32];
  std::snprintf(text, sizeof text, "%lld.%09lld", static_cast<long long>(stamp_ns / 1000000000),
                static_cast<long long>(stamp_ns % 1000000000));
  return text;
}

std::string TruthLine(std::int64_t stamp_ns, const Truth& t) {
  return Line(stamp_ns, {t.p_WC.x, t.p_WC.y, t.p_WC.z, t.q_WC.x, t.q_WC.y, t.q_WC.z, t.q_WC.w});
}

std::string VelocityLine(std::int64_t stamp_ns, const Truth& t) {
  return Line(stamp_ns, {t.v_WC.x, t.v_WC.y, t.v_WC.z, t.w_WC_C.x, t.w_WC_C.y, t.w_WC_C.z});
}

namespace {

std::string Distortion(const CameraParams& c) {
  const auto number = settings::FormatNumber;
  const std::string radial = "k1: " + number(c.k1) + ", k2: " + number(c.k2);
  if (c.lens == Lens::fisheye)
    return "{model: fisheye, " + radial + ", k3: " + number(c.k3) + ", k4: " + number(c.k4) + "}";
  return "{" + radial + ", p1: " + number(c.p1) + ", p2: " + number(c.p2) + ", k3: " + number(c.k3) + "}";
}

}  // namespace

std::string CameraYaml(const CameraParams& c) {
  const auto number = settings::FormatNumber;
  return "width: " + std::to_string(c.width) + "\nheight: " + std::to_string(c.height) + "\nfx: " + number(c.fx) +
         "\nfy: " + number(c.fy) + "\ncx: " + number(c.cx) + "\ncy: " + number(c.cy) +
         "\ndistortion: " + Distortion(c) + "\n";
}

std::vector<std::uint8_t> EncodePng(const Image& image) { return Encode(ToMat(image)); }

std::vector<std::uint8_t> EncodeDepthPng(std::span<const float> depth_m, int width, int height) {
  cv::Mat fifths_of_millimetres(height, width, CV_16UC1);
  for (int y = 0; y < height; ++y) {
    std::uint16_t* row = fifths_of_millimetres.ptr<std::uint16_t>(y);
    for (int x = 0; x < width; ++x) {
      const std::size_t at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      const float value = std::round(5000.0f * depth_m[at]);
      row[x] = value > 0.0f && value <= 65535.0f ? static_cast<std::uint16_t>(value) : std::uint16_t{0};
    }
  }
  return Encode(fifths_of_millimetres);
}

}  // namespace sim
