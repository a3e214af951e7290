// Text formats of docs/sequence_format.md, and image files.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/sensor/camera.h"
#include "sim/sensor/image.h"
#include "sim/simulator.h"

namespace sim {

// Seconds with nine decimals: exact.
std::string FormatStamp(std::int64_t stamp_ns);
// Twelve decimals: beyond any use, so that rounding is never a question; a negative zero loses its sign.
std::string FormatDecimal(double number);
// "stamp tx ty tz qx qy qz qw" and "stamp vx vy vz wx wy wz", with the newline.
std::string TruthLine(std::int64_t stamp_ns, const Truth& truth);
std::string VelocityLine(std::int64_t stamp_ns, const Truth& truth);
// "stamp ax ay az alphax alphay alphaz", the same.
std::string AccelerationLine(std::int64_t stamp_ns, const Truth& truth);
// "stamp exposure gain", the time in seconds.
std::string ExposureLine(std::int64_t stamp_ns, const ExposureSetting& setting);
// readout_s: of the rolling shutter, 0: none.
std::string CameraYaml(const CameraParams& camera, double readout_s);

// PNG files. Depth: 16 bits, round(5000 Z), 0 for what is 0 or does not fit. Throw as in png.h.
std::vector<std::uint8_t> EncodePng(const Image& image);
std::vector<std::uint8_t> EncodeDepthPng(std::span<const float> depth_m, int width, int height);

}  // namespace sim
