#include "vo/geometry/foreign_camera.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace vo {
namespace {

constexpr Lens kPlain = Lens::radial_tangential, kFisheye = Lens::fisheye;

// fx, fy, cx, cy by these names.
void RequirePinhole(settings::Section& section, const std::string& prefix, Camera& camera) {
  section.Require(prefix + "fx", camera.fx, settings::Range::Positive());
  section.Require(prefix + "fy", camera.fy, settings::Range::Positive());
  section.Require(prefix + "cx", camera.cx);
  section.Require(prefix + "cy", camera.cy);
}

void ReadCoefficients(settings::Section& section, const std::string& prefix, Camera& camera) {
  const bool fisheye = camera.lens == Lens::fisheye;
  const std::vector<std::string> names = fisheye
                                             ? std::vector<std::string>{"k1", "k2", "k3", "k4"}
                                             : std::vector<std::string>{"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
  std::vector<double> values;
  std::string missing;
  for (const std::string& name : names) {
    section.Read(prefix + name, values.emplace_back());
    if (fisheye && !section.Has(prefix + name)) missing += (missing.empty() ? "" : ", ") + prefix + name;
  }
  const std::string problem = missing.empty() ? SetLens(values, camera) : "is a fisheye: add its " + missing;
  if (!problem.empty()) section.Reject(prefix + (missing.empty() ? "k4" : "fx"), "the lens " + problem);
}

// ORB-SLAM2 and 3, OpenVSLAM and stella_vslam: prefixes of the keys of the camera and of its projection.
void ReadOrbSlam(settings::Section root, const std::string& general, const std::string& prefix, Camera& camera) {
  enum class Type { pinhole, fisheye, rectified } type = Type::pinhole;
  using Names = std::vector<std::pair<std::string, Type>>;
  const bool is_openvslam = root.Has(general + "model");
  const std::string key = general + (is_openvslam ? "model" : "type");
  const bool known = root.ReadChoice(key, type,
                                     is_openvslam ? Names{{"perspective", Type::pinhole}, {"fisheye", Type::fisheye}}
                                                  : Names{{"PinHole", Type::pinhole},
                                                          {"Pinhole", Type::pinhole},
                                                          {"KannalaBrandt8", Type::fisheye},
                                                          {"Rectified", Type::rectified}});
  if (!known && root.Has(key)) return;
  const bool has_rows = root.Has(general + "cols") || root.Has(general + "rows");
  RequireSize(root, general + (has_rows ? "cols" : "width"), general + (has_rows ? "rows" : "height"), camera);
  RequirePinhole(root, prefix, camera);
  if (type == Type::fisheye) camera.lens = Lens::fisheye;
  if (type != Type::rectified) ReadCoefficients(root, prefix, camera);
}

void ReadCamodocal(settings::Section root, Camera& camera) {
  enum class Type { pinhole, fisheye } type = Type::pinhole;
  if (!root.RequireChoice("model_type", type, {{"PINHOLE", Type::pinhole}, {"KANNALA_BRANDT", Type::fisheye}})) return;
  RequireSize(root, "image_width", "image_height", camera);
  settings::Section projection = root.Child("projection_parameters");
  if (type == Type::pinhole) {
    settings::Section distortion = root.Child("distortion_parameters");
    RequirePinhole(projection, "", camera);
    ReadCoefficients(distortion, "", camera);
    distortion.IgnoreRest();
  } else {
    camera.lens = Lens::fisheye;  // r = theta + k2 theta^3 + ...: our coefficients count from 1
    projection.Require("mu", camera.fx, settings::Range::Positive());
    projection.Require("mv", camera.fy, settings::Range::Positive());
    projection.Require("u0", camera.cx);
    projection.Require("v0", camera.cy);
    projection.Require("k2", camera.k1);
    projection.Require("k3", camera.k2);
    projection.Require("k4", camera.k3);
    projection.Require("k5", camera.k4);
  }
  projection.IgnoreRest();
}

// The first camera of the calibration.
void ReadBasalt(settings::Section value, Camera& camera) {
  std::vector<settings::RawYaml> sizes;
  std::vector<double> size;
  std::vector<settings::Section> cameras = value.List("intrinsics");
  if (value.ReadRaw("resolution", sizes) && !sizes.empty()) {
    settings::Document first = settings::Document::FromText("size: " + sizes[0].yaml, "resolution");
    first.root().Read("size", size);
  }
  value.IgnoreRest();
  for (settings::Section& each : cameras) each.IgnoreRest();
  const auto is_count = [](double n) { return n >= 1 && n <= 1 << 20 && n == std::floor(n); };
  if (cameras.empty()) return value.Reject("intrinsics", "Basalt's 'intrinsics' must have a camera");
  if (size.size() != 2 || !std::ranges::all_of(size, is_count))
    return value.Reject("resolution",
                        "Basalt's 'resolution' must have the width and height of the first camera, whole numbers");
  camera.width = static_cast<int>(size[0]);
  camera.height = static_cast<int>(size[1]);
  enum class Type { pinhole, radtan, fisheye } type = Type::pinhole;
  if (!cameras[0].RequireChoice(
          "camera_type", type, {{"pinhole", Type::pinhole}, {"pinhole-radtan8", Type::radtan}, {"kb4", Type::fisheye}}))
    return;
  settings::Section numbers = cameras[0].Child("intrinsics");
  RequirePinhole(numbers, "", camera);
  if (type == Type::fisheye) camera.lens = Lens::fisheye;
  if (type != Type::pinhole) ReadCoefficients(numbers, "", camera);
  numbers.IgnoreRest();
}

// sensor_msgs/CameraInfo: the calibrator's file, or a message, of ROS 1 with capitals.
void ReadCameraInfo(settings::Section root, Camera& camera) {
  const bool is_file = root.Has("camera_matrix"), capitals = root.Has("K");
  const std::string k = is_file    ? "camera_matrix"
                        : capitals ? "K"
                                   : "k",
                    d = is_file    ? "distortion_coefficients"
                        : capitals ? "D"
                                   : "d";
  std::vector<double> matrix, coefficients;
  RequireSize(root, is_file ? "image_width" : "width", is_file ? "image_height" : "height", camera);
  const bool has_lens = RequireNumbers(root, d, coefficients) && !coefficients.empty();
  std::vector<settings::RawYaml> model;  // which may be empty where there is none
  if (root.ReadRaw("distortion_model", model) && !has_lens && model.size() == 1 && model[0].text == "equidistant")
    root.Reject(d, "an equidistant lens has k1 ... k4, which are missing");
  if (has_lens &&
      root.RequireChoice("distortion_model", camera.lens,
                         {{"plumb_bob", kPlain}, {"rational_polynomial", kPlain}, {"equidistant", kFisheye}})) {
    if (const std::string problem = SetLens(coefficients, camera); !problem.empty())
      root.Reject(d + ".data", "'distortion_coefficients' " + problem);
  }
  if (RequireNumbers(root, k, matrix)) {
    if (const std::string problem = SetMatrix(matrix, camera); !problem.empty()) root.Reject(k + ".data", problem);
  }
  int binning_x = 0, binning_y = 0, left = 0, top = 0, width = 0, height = 0;
  root.Read("binning_x", binning_x);
  root.Read("binning_y", binning_y);
  if (binning_x > 1 || binning_y > 1)
    root.Reject(binning_x > 1 ? "binning_x" : "binning_y", "the images are binned: calibrate them as they are");
  settings::Section roi = root.Child("roi");
  roi.Read("x_offset", left);
  roi.Read("y_offset", top);
  roi.Read("width", width);
  roi.Read("height", height);
  if (left != 0 || top != 0 || (width != 0 && width != camera.width) || (height != 0 && height != camera.height))
    root.Reject("roi", "the images are a region of the sensor (roi): calibrate them as they are");
  roi.IgnoreRest();
}

}  // namespace

void RequireSize(settings::Section& section, const std::string& width, const std::string& height, Camera& camera) {
  if (!section.Has(width) && !section.Has(height))
    return section.Reject(width, "has no '" + width + "' and '" + height + "': add the size of the images");
  section.Require(width, camera.width, settings::Range::Positive());
  section.Require(height, camera.height, settings::Range::Positive());
}

bool RequireNumbers(settings::Section& section, const std::string& key, std::vector<double>& values) {
  std::vector<settings::RawYaml> parts;
  section.ReadRaw(key, parts);
  const auto begins = [&](char c) { return !parts.empty() && parts[0].yaml.starts_with(c); };
  if (begins('{')) {
    settings::Section matrix = section.Child(key);
    int rows = 0, columns = 0;
    constexpr settings::Range kCount{0, std::numeric_limits<int>::max()};
    const bool has_size = matrix.Read("rows", rows, kCount) && matrix.Read("cols", columns, kCount);
    matrix.IgnoreRest();
    if (!RequireNumbers(matrix, "data", values)) return false;
    const std::int64_t count = static_cast<std::int64_t>(rows) * columns;
    if (!has_size || count == static_cast<std::int64_t>(values.size())) return true;
    matrix.Reject("data", "'" + key + ".data': expected " + std::to_string(count) + " numbers, " +
                              std::to_string(rows) + " x " + std::to_string(columns) + ", not " +
                              std::to_string(values.size()));
    return false;
  }
  if (!begins('[')) return section.Require(key, values);
  for (const settings::RawYaml& part : parts) {
    std::vector<double> row;
    if (!settings::Document::FromText("row: " + part.yaml, key).root().Read("row", row)) {
      section.Reject(key, "'" + key + "': expected numbers, or rows of numbers");
      return false;
    }
    values.insert(values.end(), row.begin(), row.end());
  }
  return true;
}

std::string SetMatrix(std::span<const double> matrix, Camera& camera) {
  if (matrix.size() != 9) return "'camera_matrix' must have 3 x 3 numbers";
  camera.fx = matrix[0];
  camera.cx = matrix[2];
  camera.fy = matrix[4];
  camera.cy = matrix[5];
  if (!(camera.fx > 0 && camera.fy > 0)) return "'camera_matrix': fx and fy must be positive";
  if (matrix[1] != 0) return "'camera_matrix': skew is not known here";
  if (matrix[3] != 0 || matrix[6] != 0 || matrix[7] != 0 || matrix[8] != 1)
    return "'camera_matrix' must have the rows fx 0 cx, 0 fy cy, 0 0 1";
  return "";
}

bool ReadSlamCamera(settings::Section root, Camera& camera) {
  const auto refuse = [&](const char* key, const std::string& what) { root.Reject(key, what); };
  const bool has_matrix = std::ranges::any_of(kMatrixKeys, [&](const std::string& key) { return root.Has(key); });
  if (root.Has("Camera.fx") || root.Has("Camera.model")) {
    ReadOrbSlam(root, "Camera.", "Camera.", camera);
  } else if (root.Has("Camera1.fx")) {
    ReadOrbSlam(root, "Camera.", "Camera1.", camera);
  } else if (root.Has("Camera") && !has_matrix) {
    settings::Section section = root.Child("Camera");
    ReadOrbSlam(section, "", "", camera);
    section.IgnoreRest();
  } else if (root.Has("model_type")) {
    ReadCamodocal(root, camera);
  } else if (root.Has("value0")) {
    ReadBasalt(root.Child("value0"), camera);
  } else if (root.Has("intrinsics") && root.Has("T_imu_cam")) {
    ReadBasalt(root, camera);
  } else if ((root.Has("camera_matrix") && root.Has("image_width") && root.Has("distortion_model")) ||
             (root.Has("width") && (root.Has("K") || (root.Has("k") && root.Has("d"))))) {
    ReadCameraInfo(root, camera);
  } else if (root.Has("cameras") && !has_matrix) {
    refuse(
        "cameras",
        "a list of 'cameras', as of OKVIS and SVO, is not read here: docs/conventions.md, \"Camera files\", has a list "
        "of what is");
  } else if (root.Has("cam0_calib")) {
    refuse("cam0_calib", "settings of VINS-Fusion have no calibration: give the file that cam0_calib names");
  } else if (root.Has("relative_config_imucam")) {
    refuse("relative_config_imucam",
           "settings of OpenVINS have no calibration: give the file that "
           "relative_config_imucam names");
  } else {
    return false;
  }
  for (const std::string key : {"LEFT.K", "StereoRectifier.K_left", "StereoRectifier"})
    if (root.Has(key))
      root.Reject(key, "'Camera.fx' and so on are of the images that '" + key +
                           "' rectifies: where yours are, leave it out; else give the calibration of one camera");
  root.IgnoreRest();
  return true;
}

}  // namespace vo
