#include "tools/bench/campaign/calibration.h"

#include <fmt/format.h>

#include <sstream>
#include <stdexcept>

#include "tools/bench/campaign/opencv_yaml.h"

namespace campaign {
namespace {

bool Distorted(const Calibration& c) {
  return c.k1 != 0 || c.k2 != 0 || c.p1 != 0 || c.p2 != 0 || c.k3 != 0 || c.k4 != 0;
}

void Refuse(bool impossible, CalibrationFormat format, const char* why) {
  if (impossible)
    throw std::invalid_argument(fmt::format("a calibration for {} has no place for {}", Name(format), why));
}

// What both ORB-SLAMs want beside the camera: the values of their own samples for TUM RGB-D.
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

// OpenCV's reader takes a number for a real one only where it has a point or an exponent.
std::string Real(double value) {
  const std::string text = fmt::format("{}", value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string Orb(const Calibration& c, CalibrationFormat format) {
  const bool three = format == CalibrationFormat::orb_slam3;
  Refuse(c.fisheye && !three, format, "a fisheye lens");
  const std::string name = three ? "Camera1" : "Camera";
  std::string text = "%YAML:1.0\n---\n";
  if (three) text += "File.version: \"1.0\"\n";
  text += fmt::format("Camera.type: \"{}\"\n", c.fisheye ? "KannalaBrandt8" : "PinHole");
  const auto add = [&](const char* key, double value) { text += fmt::format("{}.{}: {}\n", name, key, Real(value)); };
  add("fx", c.fx), add("fy", c.fy), add("cx", c.cx), add("cy", c.cy);
  add("k1", c.k1), add("k2", c.k2);
  if (c.fisheye) {
    add("k3", c.k3), add("k4", c.k4);
  } else {
    add("p1", c.p1), add("p2", c.p2);
    if (c.k3 != 0) add("k3", c.k3);
  }
  text += fmt::format("Camera.width: {}\nCamera.height: {}\n", c.width, c.height);
  // ORB-SLAM3 reads a whole number here and refuses any other.
  text += three ? fmt::format("Camera.fps: {:.0f}\n", c.rate_hz) : fmt::format("Camera.fps: {}\n", Real(c.rate_hz));
  return text + "Camera.RGB: 1\n" + kOrb;
}

Calibration FromOrb(const std::string& text, CalibrationFormat format) {
  const OpenCvYaml file(text);
  const std::string name = format == CalibrationFormat::orb_slam3 ? "Camera1." : "Camera.";
  Calibration c;
  c.fisheye = file.Text("Camera.type") == "KannalaBrandt8";
  c.width = static_cast<int>(file.Number("Camera.width"));
  c.height = static_cast<int>(file.Number("Camera.height"));
  c.rate_hz = file.Number("Camera.fps");
  c.fx = file.Number(name + "fx"), c.fy = file.Number(name + "fy");
  c.cx = file.Number(name + "cx"), c.cy = file.Number(name + "cy");
  c.k1 = file.Number(name + "k1"), c.k2 = file.Number(name + "k2");
  if (c.fisheye) {
    c.k3 = file.Number(name + "k3"), c.k4 = file.Number(name + "k4");
  } else {
    c.p1 = file.Number(name + "p1"), c.p2 = file.Number(name + "p2");
    c.k3 = file.Has(name + "k3") ? file.Number(name + "k3") : 0;
  }
  return c;
}

// Four lines: the camera in shares of the size, the size, how to rectify, the size after it. Rectified images are
// cropped; those without distortion stay as they are.
std::string Lines(const Calibration& c, const std::string& model, double offset, const std::string& lens) {
  return fmt::format("{}{} {} {} {}{}\n{} {}\n{}\n{} {}\n", model, c.fx / c.width, c.fy / c.height,
                     (c.cx + offset) / c.width, (c.cy + offset) / c.height, lens, c.width, c.height,
                     Distorted(c) || c.fisheye ? "crop" : "none", c.width, c.height);
}

std::string Dso(const Calibration& c) {
  if (c.fisheye) return Lines(c, "EquiDistant ", 0.5, fmt::format(" {} {} {} {}", c.k1, c.k2, c.k3, c.k4));
  Refuse(c.k3 != 0, CalibrationFormat::dso, "k3");
  if (!Distorted(c)) return Lines(c, "Pinhole ", 0.5, " 0");
  return Lines(c, "RadTan ", 0.5, fmt::format(" {} {} {} {}", c.k1, c.k2, c.p1, c.p2));
}

// With eight numbers its reader uses OpenCV's convention, with five its own.
std::string LsdSlam(const Calibration& c) {
  Refuse(c.fisheye, CalibrationFormat::lsd_slam, "a fisheye lens");
  Refuse(c.k3 != 0, CalibrationFormat::lsd_slam, "k3");
  if (!Distorted(c)) return Lines(c, "", 0.5, " 0");
  return Lines(c, "", 0, fmt::format(" {} {} {} {}", c.k1, c.k2, c.p1, c.p2));
}

Calibration FromLines(const std::string& text, bool dso) {
  std::istringstream stream(text);
  std::string line, model;
  std::getline(stream, line);
  std::istringstream first(line);
  if (dso) first >> model;
  std::vector<double> n;
  for (double value = 0; first >> value;) n.push_back(value);
  Calibration c;
  if (!(stream >> c.width >> c.height) || (n.size() != 5 && n.size() != 8)) {
    throw std::invalid_argument("not four lines of a calibration: " + line);
  }
  const double offset = dso || n.size() == 5 ? 0.5 : 0;
  c.fx = n[0] * c.width, c.fy = n[1] * c.height;
  c.cx = n[2] * c.width - offset, c.cy = n[3] * c.height - offset;
  c.fisheye = model == "EquiDistant";
  if (n.size() == 8) {
    c.k1 = n[4], c.k2 = n[5];
    (c.fisheye ? c.k3 : c.p1) = n[6];
    (c.fisheye ? c.k4 : c.p2) = n[7];
  }
  return c;
}

std::string Svo(const Calibration& c) {
  Refuse(c.fisheye, CalibrationFormat::svo, "a fisheye lens");
  Refuse(c.k3 != 0, CalibrationFormat::svo, "k3");
  return fmt::format(
      "cam_model: Pinhole\ncam_width: {}\ncam_height: {}\ncam_fx: {}\ncam_fy: {}\ncam_cx: {}\ncam_cy: {}\n"
      "cam_d0: {}\ncam_d1: {}\ncam_d2: {}\ncam_d3: {}\n",
      c.width, c.height, Real(c.fx), Real(c.fy), Real(c.cx), Real(c.cy), Real(c.k1), Real(c.k2), Real(c.p1),
      Real(c.p2));
}

Calibration FromSvo(const std::string& text) {
  const OpenCvYaml file(text);
  Calibration c;
  c.width = static_cast<int>(file.Number("cam_width"));
  c.height = static_cast<int>(file.Number("cam_height"));
  c.fx = file.Number("cam_fx"), c.fy = file.Number("cam_fy"), c.cx = file.Number("cam_cx"),
  c.cy = file.Number("cam_cy");
  c.k1 = file.Number("cam_d0"), c.k2 = file.Number("cam_d1"), c.p1 = file.Number("cam_d2"),
  c.p2 = file.Number("cam_d3");
  return c;
}

}  // namespace

std::string WriteCalibration(const Calibration& camera, CalibrationFormat format) {
  switch (format) {
    case CalibrationFormat::orb_slam2:
    case CalibrationFormat::orb_slam3:
      return Orb(camera, format);
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

Calibration ReadCalibration(const std::string& text, CalibrationFormat format) {
  switch (format) {
    case CalibrationFormat::orb_slam2:
    case CalibrationFormat::orb_slam3:
      return FromOrb(text, format);
    case CalibrationFormat::dso:
    case CalibrationFormat::lsd_slam:
      return FromLines(text, format == CalibrationFormat::dso);
    case CalibrationFormat::svo:
      return FromSvo(text);
    case CalibrationFormat::none:
    case CalibrationFormat::camera_yaml:
      break;
  }
  throw std::invalid_argument("no calibration of ours is in the format " + Name(format));
}

}  // namespace campaign
