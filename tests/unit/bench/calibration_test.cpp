// Calibration files of external systems.
#include "tools/bench/run/calibration.h"

#include <gmock/gmock.h>

#include <map>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace vobench {
namespace {

using campaign::CalibrationFormat;
using Camera = sim::CameraParams;
using testing::HasSubstr;

Camera Plain() { return {640, 480, 525.25, 524.5, 319.5, 239.25}; }
Camera Distorted() {
  Camera c = Plain();
  c.k1 = 0.1, c.k2 = -0.2, c.p1 = 0.001, c.p2 = -0.002;
  return c;
}
Camera Fisheye() {
  Camera c = Plain();
  c.lens = sim::Lens::fisheye;
  c.k1 = 0.01, c.k2 = -0.02, c.k3 = 0.003, c.k4 = -0.0004;
  return c;
}

void ExpectSame(const Camera& a, const Camera& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.lens, b.lens);
  for (const auto member : {&Camera::fx, &Camera::fy, &Camera::cx, &Camera::cy, &Camera::k1, &Camera::k2, &Camera::p1,
                            &Camera::p2, &Camera::k3, &Camera::k4}) {
    EXPECT_NEAR(a.*member, b.*member, 1e-12 * 640);
  }
}

// Minimal readers of the formats that WriteCalibration writes.
std::map<std::string, std::string> KeysAndValues(const std::string& text) {
  std::map<std::string, std::string> values;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) values[line.substr(0, colon)] = line.substr(colon + 2);
  }
  return values;
}

Camera FromKeys(const std::string& text, bool svo, const std::string& camera) {
  const std::map<std::string, std::string> file = KeysAndValues(text);
  const auto number = [&](const std::string& key) { return file.contains(key) ? std::stod(file.at(key)) : 0; };
  const std::string size = svo ? "cam_" : "Camera.";
  Camera c;
  if (!svo && file.at("Camera.type") == "\"KannalaBrandt8\"") c.lens = sim::Lens::fisheye;
  c.width = static_cast<int>(number(size + "width"));
  c.height = static_cast<int>(number(size + "height"));
  c.fx = number(camera + "fx"), c.fy = number(camera + "fy"), c.cx = number(camera + "cx"),
  c.cy = number(camera + "cy");
  c.k1 = number(camera + (svo ? "d0" : "k1")), c.k2 = number(camera + (svo ? "d1" : "k2"));
  c.p1 = number(camera + (svo ? "d2" : "p1")), c.p2 = number(camera + (svo ? "d3" : "p2"));
  c.k3 = number(camera + "k3"), c.k4 = number(camera + "k4");
  return c;
}

Camera FromLines(const std::string& text, bool dso) {
  std::istringstream stream(text);
  std::string line, model;
  std::getline(stream, line);
  std::istringstream first(line);
  if (dso) first >> model;
  std::vector<double> n;
  for (double value = 0; first >> value;) n.push_back(value);
  Camera c;
  if (!(stream >> c.width >> c.height) || (n.size() != 5 && n.size() != 8)) {
    ADD_FAILURE() << line;
    return c;
  }
  const double offset = dso || n.size() == 5 ? 0.5 : 0;
  c.fx = n[0] * c.width, c.fy = n[1] * c.height;
  c.cx = n[2] * c.width - offset, c.cy = n[3] * c.height - offset;
  const bool fisheye = model == "EquiDistant";
  if (fisheye) c.lens = sim::Lens::fisheye;
  if (n.size() == 8) {
    c.k1 = n[4], c.k2 = n[5];
    (fisheye ? c.k3 : c.p1) = n[6];
    (fisheye ? c.k4 : c.p2) = n[7];
  }
  return c;
}

Camera ReadCalibration(const std::string& text, CalibrationFormat format) {
  using F = CalibrationFormat;
  if (format == F::dso || format == F::lsd_slam) return FromLines(text, format == F::dso);
  if (format == F::svo) return FromKeys(text, true, "cam_");
  return FromKeys(text, false, format == F::orb_slam3 ? "Camera1." : "Camera.");
}

TEST(Calibration, IsReadBackAsItWasWritten) {
  using F = CalibrationFormat;
  for (const F format : {F::orb_slam2, F::orb_slam3, F::dso, F::svo, F::lsd_slam}) {
    SCOPED_TRACE(Name(format));
    ExpectSame(ReadCalibration(WriteCalibration(Plain(), 30, format), format), Plain());
    ExpectSame(ReadCalibration(WriteCalibration(Distorted(), 30, format), format), Distorted());
    Camera k3 = Distorted();
    k3.k3 = 0.05;
    if (format == F::orb_slam2 || format == F::orb_slam3) {
      ExpectSame(ReadCalibration(WriteCalibration(k3, 30, format), format), k3);
    } else {
      EXPECT_THROW(WriteCalibration(k3, 30, format), std::invalid_argument);
    }
    if (format == F::orb_slam3 || format == F::dso) {
      ExpectSame(ReadCalibration(WriteCalibration(Fisheye(), 30, format), format), Fisheye());
    } else {
      EXPECT_THROW(WriteCalibration(Fisheye(), 30, format), std::invalid_argument);
    }
  }
}

// Values worked by hand from each system's documentation: writer and reader here could share an error.
TEST(Calibration, SaysWhatEachSystemDocuments) {
  Camera c = Plain();
  c.width = 640, c.height = 400, c.fx = 320, c.fy = 300, c.cx = 319.5, c.cy = 199.5;
  EXPECT_EQ(WriteCalibration(c, 30, CalibrationFormat::dso), "Pinhole 0.5 0.75 0.5 0.5 0\n640 400\nnone\n640 400\n")
      << "K(0,2) = width * cx - 0.5";
  EXPECT_EQ(WriteCalibration(c, 30, CalibrationFormat::lsd_slam), "0.5 0.75 0.5 0.5 0\n640 400\nnone\n640 400\n");
  c.k1 = 0.25, c.p2 = -0.5, c.cx = 320, c.cy = 200;
  EXPECT_EQ(WriteCalibration(c, 30, CalibrationFormat::lsd_slam),
            "0.5 0.75 0.5 0.5 0.25 0 0 -0.5\n640 400\ncrop\n640 400\n")
      << "its OpenCV model has no half pixel";
  EXPECT_THAT(WriteCalibration(c, 30, CalibrationFormat::svo),
              HasSubstr("cam_model: Pinhole\ncam_width: 640\ncam_height: 400\ncam_fx: 320.0\n"));
  EXPECT_THAT(WriteCalibration(c, 30, CalibrationFormat::orb_slam2), HasSubstr("\nCamera.fx: 320.0\n"));
  const std::string orb3 = WriteCalibration(Fisheye(), 30, CalibrationFormat::orb_slam3);
  EXPECT_THAT(orb3, HasSubstr("%YAML:1.0\n"));
  EXPECT_THAT(orb3, HasSubstr("File.version: \"1.0\"\nCamera.type: \"KannalaBrandt8\"\nCamera1.fx: 525.25\n"));
  EXPECT_THAT(orb3, HasSubstr("\nCamera.fps: 30\n")) << "a whole number";
}

}  // namespace
}  // namespace vobench
