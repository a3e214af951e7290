#include "tools/bench/run/calibration.h"

#include <fmt/format.h>

#include <stdexcept>

namespace vobench {
namespace {

using campaign::CalibrationFormat;
using sim::CameraParams;

bool IsFisheye(const CameraParams& c) { return c.lens == sim::Lens::fisheye; }

void Refuse(bool impossible, CalibrationFormat format, const char* why) {
  if (impossible) {
    throw std::invalid_argument(
        fmt::format("a calibration for {} has no place for {} (`images: rectified`)", Name(format), why));
  }
}

// Settings of both ORB-SLAMs beside the camera: the values of their own samples for TUM RGB-D.
constexpr const char* kOrb = R"(
ORBextractor.nFeatures: 1000
ORBextractor.scaleFactor: 1.2
ORBextractor.nLevels: 8
ORBextractor.iniThFAST: 20
ORBextractor.minThFAST: 7

Viewer.KeyFrameSize: 0.05
Viewer.KeyFrameLineWidth: 1.0
Viewer.GraphLineWidth: 0.9
Viewer.PointSize: 2.0
Viewer.CameraSize: 0.08
Viewer.CameraLineWidth: 3.0
Viewer.ViewpointX: 0.0
Viewer.ViewpointY: -0.7
Viewer.ViewpointZ: -1.8
Viewer.ViewpointF: 500.0
)";

// A real number for OpenCV's reader, which requires a point or an exponent.
std::string Real(double value) {
  const std::string text = fmt::format("{}", value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string Orb(const CameraParams& c, double rate_hz, CalibrationFormat format) {
  const bool three = format == CalibrationFormat::orb_slam3;
  Refuse(IsFisheye(c) && !three, format, "a fisheye lens");
  const std::string name = three ? "Camera1" : "Camera";
  std::string text = "%YAML:1.0\n---\n";
  if (three) text += "File.version: \"1.0\"\n";
  text += fmt::format("Camera.type: \"{}\"\n", IsFisheye(c) ? "KannalaBrandt8" : "PinHole");
  const auto add = [&](const char* key, double value) { text += fmt::format("{}.{}: {}\n", name, key, Real(value)); };
  add("fx", c.fx), add("fy", c.fy), add("cx", c.cx), add("cy", c.cy);
  add("k1", c.k1), add("k2", c.k2);
  if (IsFisheye(c)) {
    add("k3", c.k3), add("k4", c.k4);
  } else {
    add("p1", c.p1), add("p2", c.p2);
    if (c.k3 != 0) add("k3", c.k3);
  }
  text += fmt::format("Camera.width: {}\nCamera.height: {}\n", c.width, c.height);
  // ORB-SLAM3 requires a whole number here.
  text += three ? fmt::format("Camera.fps: {:.0f}\n", rate_hz) : fmt::format("Camera.fps: {}\n", Real(rate_hz));
  return text + "Camera.RGB: 1\n" + kOrb;
}

// Four lines: the camera in fractions of the size, the size, the rectification, the size after it. Rectified images are
// cropped, and those whose sides are not multiples of 16, which are halved four times; others are unchanged.
std::string Lines(const CameraParams& c, const std::string& model, double offset, const std::string& lens) {
  const int width = c.width / kSideMultiple * kSideMultiple, height = c.height / kSideMultiple * kSideMultiple;
  const bool whole = width == c.width && height == c.height;
  return fmt::format("{}{} {} {} {}{}\n{} {}\n{}\n{} {}\n", model, c.fx / c.width, c.fy / c.height,
                     (c.cx + offset) / c.width, (c.cy + offset) / c.height, lens, c.width, c.height,
                     IsDistorted(c) || !whole ? "crop" : "none", width, height);
}

std::string Dso(const CameraParams& c) {
  if (IsFisheye(c)) return Lines(c, "EquiDistant ", 0.5, fmt::format(" {} {} {} {}", c.k1, c.k2, c.k3, c.k4));
  Refuse(c.k3 != 0, CalibrationFormat::dso, "k3");
  if (!IsDistorted(c)) return Lines(c, "Pinhole ", 0.5, " 0");
  return Lines(c, "RadTan ", 0.5, fmt::format(" {} {} {} {}", c.k1, c.k2, c.p1, c.p2));
}

// With eight numbers its reader uses OpenCV's convention, with five its own.
std::string LsdSlam(const CameraParams& c) {
  Refuse(IsFisheye(c), CalibrationFormat::lsd_slam, "a fisheye lens");
  Refuse(c.k3 != 0, CalibrationFormat::lsd_slam, "k3");
  if (!IsDistorted(c)) return Lines(c, "", 0.5, " 0");
  return Lines(c, "", 0, fmt::format(" {} {} {} {}", c.k1, c.k2, c.p1, c.p2));
}

std::string Svo(const CameraParams& c) {
  Refuse(IsFisheye(c), CalibrationFormat::svo, "a fisheye lens");
  Refuse(c.k3 != 0, CalibrationFormat::svo, "k3");
  Refuse(c.width % kSideMultiple != 0 || c.height % kSideMultiple != 0, CalibrationFormat::svo,
         "sides that are no multiples of 16");
  return fmt::format(
      "cam_model: Pinhole\ncam_width: {}\ncam_height: {}\ncam_fx: {}\ncam_fy: {}\ncam_cx: {}\ncam_cy: {}\n"
      "cam_d0: {}\ncam_d1: {}\ncam_d2: {}\ncam_d3: {}\n",
      c.width, c.height, Real(c.fx), Real(c.fy), Real(c.cx), Real(c.cy), Real(c.k1), Real(c.k2), Real(c.p1),
      Real(c.p2));
}

}  // namespace

bool IsDistorted(const CameraParams& c) {
  return IsFisheye(c) || c.k1 != 0 || c.k2 != 0 || c.p1 != 0 || c.p2 != 0 || c.k3 != 0 || c.k4 != 0;
}

std::string WriteCalibration(const CameraParams& camera, double rate_hz, CalibrationFormat format) {
  switch (format) {
    case CalibrationFormat::orb_slam2:
    case CalibrationFormat::orb_slam3:
      return Orb(camera, rate_hz, format);
    case CalibrationFormat::dso:
      return Dso(camera);
    case CalibrationFormat::svo:
      return Svo(camera);
    case CalibrationFormat::lsd_slam:
      return LsdSlam(camera);
    case CalibrationFormat::none:
    case CalibrationFormat::camera_yaml:  // lies in the sequence
      break;
  }
  return "";
}

}  // namespace vobench
