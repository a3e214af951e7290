#include "sim/sequence/format.h"

#include <algorithm>
#include <cstdio>

#include "sim/sequence/png.h"
#include "tools/base/settings/quantity.h"

namespace sim {
namespace {

std::string Line(std::int64_t stamp_ns, std::initializer_list<double> numbers) {
  std::string line = FormatStamp(stamp_ns);
  for (const double number : numbers) line += " " + FormatDecimal(number);
  return line + "\n";
}

}  // namespace

std::string FormatStamp(std::int64_t stamp_ns) {
  char text[32];
  std::snprintf(text, sizeof text, "%lld.%09lld", static_cast<long long>(stamp_ns / 1000000000),
                static_cast<long long>(stamp_ns % 1000000000));
  return text;
}

std::string FormatDecimal(double number) {
  char text[64];
  std::snprintf(text, sizeof text, "%.12f", number);
  return std::string(text) == "-0.000000000000" ? "0.000000000000" : text;
}

std::string TruthLine(std::int64_t stamp_ns, const Truth& t) {
  return Line(stamp_ns, {t.p_WC.x, t.p_WC.y, t.p_WC.z, t.q_WC.x, t.q_WC.y, t.q_WC.z, t.q_WC.w});
}

std::string ExposureLine(std::int64_t stamp_ns, const ExposureSetting& setting) {
  return Line(stamp_ns, {setting.exposure_s, setting.gain});
}

std::string VelocityLine(std::int64_t stamp_ns, const Truth& t) {
  return Line(stamp_ns, {t.v_WC.x, t.v_WC.y, t.v_WC.z, t.w_WC_C.x, t.w_WC_C.y, t.w_WC_C.z});
}

std::string AccelerationLine(std::int64_t stamp_ns, const Truth& t) {
  return Line(stamp_ns, {t.a_WC.x, t.a_WC.y, t.a_WC.z, t.alpha_WC_C.x, t.alpha_WC_C.y, t.alpha_WC_C.z});
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

std::string CameraYaml(const CameraParams& c, double readout_s) {
  const auto number = settings::FormatNumber;
  return "width: " + std::to_string(c.width) + "\nheight: " + std::to_string(c.height) + "\nfx: " + number(c.fx) +
         "\nfy: " + number(c.fy) + "\ncx: " + number(c.cx) + "\ncy: " + number(c.cy) +
         "\ndistortion: " + Distortion(c) + "\n" +
         (readout_s != 0 ? "rolling_shutter: " + number(readout_s) + " s\n" : "");
}

std::vector<std::uint8_t> EncodePng(const Image& image) {
  if (image.bits == 8) return EncodePng(image.width, image.height, image.channels, image.data);
  std::vector<std::uint16_t> highest_bits(image.wide.size());  // of 16, so that white is white in every viewer
  for (std::size_t i = 0; i < image.wide.size(); ++i) {
    highest_bits[i] = static_cast<std::uint16_t>(image.wide[i] << (16 - image.bits));
  }
  return EncodePng(image.width, image.height, image.channels, highest_bits);
}

std::vector<std::uint8_t> EncodeDepthPng(std::span<const float> depth_m, int width, int height) {
  std::vector<std::uint16_t> fifths_of_millimetres(depth_m.size());
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    const float value = 5000.0f * depth_m[i];
    const float kept = value < 65535.5f ? value : 0.0f;  // not a number: 0, too
    const int below = static_cast<int>(std::max(kept, 0.0f));
    const int rounded = below + static_cast<int>(kept - static_cast<float>(below) >= 0.5f);
    fifths_of_millimetres[i] = static_cast<std::uint16_t>(rounded);
  }
  return EncodePng(width, height, 1, fifths_of_millimetres);
}

}  // namespace sim
