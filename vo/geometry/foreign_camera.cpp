#include "vo/geometry/foreign_camera.h"

#include <array>
#include <map>
#include <vector>

#include "tools/base/text.h"

namespace vo {
namespace {

// Parameters of a model: focal lengths (one or two), the principal point, and lens coefficients.
struct Model {
  std::size_t focal_lengths;
  std::size_t coefficients;  // all of them in the order of SetLens, but for one or two: k1, k2
  Lens lens;
};
constexpr Lens kPlain = Lens::radial_tangential, kFisheye = Lens::fisheye;
const std::map<std::string_view, Model>& Models() {
  static const std::map<std::string_view, Model> models = {
      {"SIMPLE_PINHOLE", {1, 0, kPlain}},   {"PINHOLE", {2, 0, kPlain}},
      {"SIMPLE_RADIAL", {1, 1, kPlain}},    {"RADIAL", {1, 2, kPlain}},
      {"OPENCV", {2, 4, kPlain}},           {"FULL_OPENCV", {2, 8, kPlain}},
      {"OPENCV_FISHEYE", {2, 4, kFisheye}}, {"SIMPLE_RADIAL_FISHEYE", {1, 1, kFisheye}},
      {"RADIAL_FISHEYE", {1, 2, kFisheye}}, {"Pinhole", {2, 1, kPlain}},
      {"RadTan", {2, 4, kPlain}},           {"EquiDistant", {2, 4, kFisheye}},
      {"KannalaBrandt", {2, 4, kFisheye}}};
  return models;
}

using Words = std::vector<base::Word>;

// The lines that are no comments, as words.
std::vector<Words> DataLines(std::string_view text) {
  std::vector<Words> lines;
  while (!text.empty() && lines.size() < 8) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const Words words = base::SplitWords(text.substr(0, end));
    if (!words.empty() && words[0].text[0] != '#') lines.push_back(words);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

// Returns the problem of the parameters; empty: none.
std::string SetParameters(const Model& model, std::span<const base::Word> words, Camera& camera) {
  std::vector<double> p;
  for (const base::Word& word : words) {
    const std::optional<double> number = base::ParseNumber(word.text);
    if (!number) return "'" + std::string(word.text) + "' is not a number";
    p.push_back(*number);
  }
  const std::size_t before = model.focal_lengths + 2;
  if (p.size() != before + model.coefficients) {
    return "the model has " + std::to_string(before + model.coefficients) + " parameters, not " +
           std::to_string(p.size());
  }
  camera.fx = p[0];
  camera.fy = p[model.focal_lengths - 1];
  camera.cx = p[before - 2];
  camera.cy = p[before - 1];
  camera.lens = model.lens;
  p.erase(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(before));
  p.resize(std::max<std::size_t>(4, p.size()));
  if (!(camera.fx > 0 && camera.fy > 0)) return "the focal lengths must be positive";
  const std::string problem = SetLens(p, camera);
  return problem.empty() ? "" : "its lens " + problem;
}

// Width and height; false where they are no whole numbers above 0.
bool SetSize(std::span<const base::Word> words, Camera& camera) {
  const auto width = base::ParseWhole(words[0].text), height = base::ParseWhole(words[1].text);
  if (!width || !height || *width < 1 || *height < 1 || *width > 1 << 20 || *height > 1 << 20) return false;
  camera.width = static_cast<int>(*width);
  camera.height = static_cast<int>(*height);
  return true;
}

// fx, fy, cx, cy by these names.
void RequirePinhole(settings::Section& section, const std::string& prefix, Camera& camera) {
  section.Require(prefix + "fx", camera.fx, settings::Range::Positive());
  section.Require(prefix + "fy", camera.fy, settings::Range::Positive());
  section.Require(prefix + "cx", camera.cx);
  section.Require(prefix + "cy", camera.cy);
}

void ReadCoefficients(settings::Section& section, const std::string& prefix, Camera& camera) {
  std::vector<double> values;
  const bool fisheye = camera.lens == Lens::fisheye;
  for (const char* name : {"k1", "k2", fisheye ? "k3" : "p1", fisheye ? "k4" : "p2"}) {
    section.Read(prefix + name, values.emplace_back());
  }
  if (!fisheye) {
    for (const char* name : {"k3", "k4", "k5", "k6"}) section.Read(prefix + name, values.emplace_back());
  }
  if (const std::string problem = SetLens(values, camera); !problem.empty())
    section.Reject(prefix + "k4", "the lens " + problem);
}

void ReadOrbSlam(settings::Section root, const std::string& prefix, Camera& camera) {
  enum class Type { pinhole, fisheye, rectified } type = Type::pinhole;
  root.ReadChoice("Camera.type", type,
                  {{"PinHole", Type::pinhole},
                   {"Pinhole", Type::pinhole},
                   {"KannalaBrandt8", Type::fisheye},
                   {"Rectified", Type::rectified}});
  RequireSize(root, "Camera.width", "Camera.height", camera);
  RequirePinhole(root, prefix, camera);
  if (type == Type::fisheye) camera.lens = Lens::fisheye;
  if (type != Type::rectified) ReadCoefficients(root, prefix, camera);
  if (root.Has("LEFT.K"))
    root.Reject("LEFT.K",
                "'Camera.fx' and so on are of the images that ORB-SLAM rectifies by LEFT.K: where yours are, leave out "
                "LEFT.* and RIGHT.*; else give the calibration of one camera");
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
  if (cameras.empty() || size.size() != 2 ||
      !(size[0] >= 1 && size[0] <= 1 << 20 && size[1] >= 1 && size[1] <= 1 << 20))
    return value.Reject("resolution", "Basalt's 'intrinsics' and 'resolution' must have a camera");
  camera.width = static_cast<int>(size[0]);
  camera.height = static_cast<int>(size[1]);
  enum class Type { pinhole, radtan, fisheye } type = Type::pinhole;
  const bool known = cameras[0].RequireChoice(
      "camera_type", type, {{"pinhole", Type::pinhole}, {"pinhole-radtan8", Type::radtan}, {"kb4", Type::fisheye}});
  settings::Section numbers = cameras[0].Child("intrinsics");
  if (known) {
    RequirePinhole(numbers, "", camera);
    if (type == Type::fisheye) camera.lens = Lens::fisheye;
    if (type != Type::pinhole) ReadCoefficients(numbers, "", camera);
  }
  for (settings::Section& each : cameras) each.IgnoreRest();
  numbers.IgnoreRest();
}

// sensor_msgs/CameraInfo: the calibrator's file, or a message, of ROS 1 with capitals.
void ReadCameraInfo(settings::Section root, Camera& camera) {
  const bool is_file = root.Has("camera_matrix"), capitals = root.Has("K");
  settings::Section of_matrix = is_file ? root.Child("camera_matrix") : root,
                    of_lens = is_file ? root.Child("distortion_coefficients") : root, roi = root.Child("roi");
  const std::string k = is_file ? "data" : capitals ? "K" : "k", d = is_file ? "data" : capitals ? "D" : "d";
  std::array<double, 9> matrix{};
  std::vector<double> coefficients;
  RequireSize(root, is_file ? "image_width" : "width", is_file ? "image_height" : "height", camera);
  const bool has_lens = of_lens.Require(d, coefficients) && !coefficients.empty();
  root.Allow("distortion_model");  // which may be empty where there is none
  if (has_lens) {
    root.RequireChoice("distortion_model", camera.lens,
                       {{"plumb_bob", kPlain}, {"rational_polynomial", kPlain}, {"equidistant", kFisheye}});
    if (const std::string problem = SetLens(coefficients, camera); !problem.empty())
      of_lens.Reject(d, "'distortion_coefficients' " + problem);
  }
  if (of_matrix.Require(k, matrix)) {
    for (const std::string& problem : SetMatrix(matrix, camera)) of_matrix.Reject(k, problem);
  }
  int binning = 0, left = 0, top = 0;
  for (const char* key : {"binning_x", "binning_y"}) {
    if (root.Read(key, binning) && binning > 1) root.Reject(key, "the images are binned: calibrate them as they are");
  }
  if ((roi.Read("x_offset", left) && left != 0) || (roi.Read("y_offset", top) && top != 0))
    root.Reject("roi", "the images are a region of the sensor (roi): calibrate them as they are");
  for (settings::Section* section : {&of_matrix, &of_lens, &roi}) section->IgnoreRest();
}

}  // namespace

void RequireSize(settings::Section& section, const std::string& width, const std::string& height, Camera& camera) {
  if (!section.Has(width) && !section.Has(height))
    return section.Reject(width, "has no '" + width + "' and '" + height + "': add the size of the images");
  section.Require(width, camera.width, settings::Range::Positive());
  section.Require(height, camera.height, settings::Range::Positive());
}

std::vector<std::string> SetMatrix(std::span<const double> matrix, Camera& camera) {
  if (matrix.size() != 9) return {"'camera_matrix' must have 3 x 3 numbers"};
  std::vector<std::string> problems;
  camera.fx = matrix[0];
  camera.cx = matrix[2];
  camera.fy = matrix[4];
  camera.cy = matrix[5];
  if (!(camera.fx > 0 && camera.fy > 0)) problems.emplace_back("'camera_matrix': fx and fy must be positive");
  if (matrix[1] != 0) problems.emplace_back("'camera_matrix': skew is not known here");
  return problems;
}

std::optional<Camera> ReadTextCamera(std::string_view text, const std::filesystem::path& file) {
  const std::vector<Words> lines = DataLines(text);
  if (lines.empty()) return std::nullopt;
  const auto fail = [&](const std::string& what) -> Camera { throw settings::Error({{file.string(), 0, 0, what}}); };
  Camera camera;
  camera.readout_s = std::nullopt;
  const Words& first = lines[0];
  if (first.size() > 4 && SetSize(std::span(first).subspan(2, 2), camera) &&
      !base::ParseNumber(first[1].text)) {  // COLMAP
    const auto model = Models().find(first[1].text);
    if (model == Models().end())
      return fail("COLMAP's model " + std::string(first[1].text) +
                  " is not known here: refine OPENCV or OPENCV_FISHEYE, or undistort the images");
    if (lines.size() > 1) return fail("holds more than one camera: keep the line of one");
    if (const std::string problem = SetParameters(model->second, std::span(first).subspan(4), camera); !problem.empty())
      return fail(problem);
    camera.cx -= 0.5;  // COLMAP's first pixel has its corner at 0
    camera.cy -= 0.5;
    return camera;
  }
  if (lines.size() < 2 || lines[1].size() != 2 || !SetSize(lines[1], camera)) return std::nullopt;
  // DSO, LSD-SLAM: parameters, perhaps after a name, then the size. A lens without its angle is a pinhole.
  const bool has_name = !base::ParseNumber(first[0].text);
  std::string_view name = has_name ? first[0].text : first.size() == 8 ? "RadTan" : first.size() == 5 ? "FOV" : "";
  if (name == "FOV" && base::ParseNumber(first.back().text) == 0) name = "Pinhole";
  const auto model = Models().find(name);
  if (name == "FOV")
    return fail(
        "the field-of-view lens of TUM's monocular dataset and DSO is not known here: calibrate a "
        "radial-tangential or equidistant one, or rectify the images");
  if (model == Models().end()) return std::nullopt;
  if (const std::string problem = SetParameters(model->second, std::span(first).subspan(has_name ? 1 : 0), camera);
      !problem.empty())
    return fail(problem);
  if (camera.cx < 1 && camera.cy < 1) {  // in parts of the image, from its corner
    camera.fx *= camera.width, camera.fy *= camera.height;
    camera.cx = camera.cx * camera.width - 0.5, camera.cy = camera.cy * camera.height - 0.5;
  }
  return camera;
}

bool ReadSlamCamera(settings::Section root, Camera& camera) {
  const auto refuse = [&](const char* key, const std::string& what) { root.Reject(key, what); };
  if (root.Has("Camera.fx")) {
    ReadOrbSlam(root, "Camera.", camera);
  } else if (root.Has("Camera1.fx")) {
    ReadOrbSlam(root, "Camera1.", camera);
  } else if (root.Has("model_type")) {
    ReadCamodocal(root, camera);
  } else if (root.Has("value0")) {
    ReadBasalt(root.Child("value0"), camera);
  } else if ((root.Has("camera_matrix") && root.Has("image_width") && root.Has("distortion_model")) ||
             (root.Has("width") && (root.Has("K") || (root.Has("k") && root.Has("d"))))) {
    ReadCameraInfo(root, camera);
  } else if (root.Has("cam0_calib")) {
    refuse("cam0_calib", "settings of VINS-Fusion have no calibration: give the file that cam0_calib names");
  } else if (root.Has("relative_config_imucam")) {
    refuse("relative_config_imucam",
           "settings of OpenVINS have no calibration: give the file that "
           "relative_config_imucam names");
  } else {
    return false;
  }
  root.IgnoreRest();
  return true;
}

}  // namespace vo
