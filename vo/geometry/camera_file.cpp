#include "vo/geometry/camera_file.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <vector>

#include "tools/base/settings/settings.h"
#include "vo/geometry/calibration_numbers.h"
#include "vo/geometry/opencv_xml.h"

namespace vo {
namespace {

void RequireLens(settings::Section& section, const std::string& key, const std::string& name, Camera& camera) {
  std::vector<double> coefficients;
  if (!section.Require(key, coefficients)) return;
  const std::string problem = SetLens(coefficients, camera);
  if (!problem.empty()) section.Reject(key, "'" + name + "' " + problem);
}

// sensor.yaml of EuRoC, and a camera of Kalibr's camchain.yaml, which differ in the key of the coefficients.
void ReadEuroc(settings::Section section, const std::string& coefficients, Camera& camera) {
  enum class Model { pinhole } model = Model::pinhole;
  std::array<double, 2> size{};
  std::array<double, 4> intrinsics{};
  section.RequireChoice("camera_model", model, {{"pinhole", Model::pinhole}});
  section.RequireChoice("distortion_model", camera.lens,
                        {{"radial-tangential", Lens::radial_tangential},
                         {"radtan", Lens::radial_tangential},
                         {"none", Lens::radial_tangential},
                         {"equidistant", Lens::fisheye}});
  constexpr settings::Range kPixels{1, std::numeric_limits<int>::max()};
  if (section.Require("resolution", size, settings::Unit::none, kPixels)) {
    camera.width = static_cast<int>(size[0]);
    camera.height = static_cast<int>(size[1]);
    if (camera.width != size[0] || camera.height != size[1])
      section.Reject("resolution", "'resolution': width and height must be whole numbers");
  }
  if (section.Require("intrinsics", intrinsics)) {
    camera.fx = intrinsics[0];
    camera.fy = intrinsics[1];
    camera.cx = intrinsics[2];
    camera.cy = intrinsics[3];
    if (!(camera.fx > 0 && camera.fy > 0)) section.Reject("intrinsics", "'intrinsics': fu and fv must be positive");
  }
  RequireLens(section, coefficients, coefficients, camera);
  section.IgnoreRest();
}

void ReadRos(settings::Section root, Camera& camera) {
  std::array<double, 9> matrix{};
  root.Require("image_width", camera.width, settings::Range::Positive());
  root.Require("image_height", camera.height, settings::Range::Positive());
  root.RequireChoice("distortion_model", camera.lens,
                     {{"plumb_bob", Lens::radial_tangential},
                      {"rational_polynomial", Lens::radial_tangential},
                      {"equidistant", Lens::fisheye}});
  settings::Section of_matrix = root.Child("camera_matrix"), of_lens = root.Child("distortion_coefficients");
  if (of_matrix.Require("data", matrix)) {
    for (const std::string& problem : SetMatrix(matrix, camera)) of_matrix.Reject("data", problem);
  }
  RequireLens(of_lens, "data", "distortion_coefficients", camera);
  of_matrix.IgnoreRest();
  of_lens.IgnoreRest();
  root.IgnoreRest();
}

void ReadOwn(settings::Section root, Camera& camera) {
  root.Require("width", camera.width, settings::Range::Positive());
  root.Require("height", camera.height, settings::Range::Positive());
  root.Require("fx", camera.fx, settings::Unit::pixel, settings::Range::Positive());
  root.Require("fy", camera.fy, settings::Unit::pixel, settings::Range::Positive());
  root.Require("cx", camera.cx, settings::Unit::pixel);
  root.Require("cy", camera.cy, settings::Unit::pixel);
  root.Read("rolling_shutter", camera.readout_s, settings::Unit::time, settings::Range{-1, 1});
  settings::Section lens = root.Child("distortion");
  lens.ReadChoice("model", camera.lens, {{"radial_tangential", Lens::radial_tangential}, {"fisheye", Lens::fisheye}});
  lens.Read("k1", camera.k1);
  lens.Read("k2", camera.k2);
  if (camera.lens == Lens::fisheye) {
    lens.Read("k3", camera.k3);
    lens.Read("k4", camera.k4);
  } else {
    lens.Read("p1", camera.p1);
    lens.Read("p2", camera.p2);
    lens.Read("k3", camera.k3);
  }
}

// Entries row by row; empty after a problem, which the section keeps.
std::vector<double> OpenCvMatrix(settings::Section section, const std::string& name) {
  int rows = 0, columns = 0;
  std::vector<double> values;
  const bool has_rows = section.Require("rows", rows, settings::Range::Positive());
  const bool has_columns = section.Require("cols", columns, settings::Range::Positive());
  const bool has_data = section.Require("data", values);
  section.IgnoreRest();
  if (!has_rows || !has_columns || !has_data) return {};
  const std::int64_t count = static_cast<std::int64_t>(rows) * columns;
  if (count == static_cast<std::int64_t>(values.size())) return values;
  section.Reject("data", "'" + name + ".data': expected " + std::to_string(count) + " numbers, " +
                             std::to_string(rows) + " x " + std::to_string(columns) + ", not " +
                             std::to_string(values.size()));
  return {};
}

// Without cv::FileStorage, whose YAML reader crashes, or does not terminate, on slightly malformed files (OpenCV 4.6).
void ReadOpenCvYaml(settings::Section root, Camera& camera) {
  // The key that is present, of the two spellings of OpenCV's programs.
  const auto either = [&](const char* name, const char* other) {
    return std::string(root.Has(name) || !root.Has(other) ? name : other);
  };
  root.Require(either("image_width", "image_Width"), camera.width, settings::Range::Positive());
  root.Require(either("image_height", "image_Height"), camera.height, settings::Range::Positive());
  int fisheye = 0;
  if (root.Read("fisheye_model", fisheye) && fisheye != 0) camera.lens = Lens::fisheye;
  const std::string matrix_key = either("camera_matrix", "Camera_Matrix");
  if (const std::vector<double> matrix = OpenCvMatrix(root.Child(matrix_key), matrix_key); !matrix.empty()) {
    for (const std::string& problem : SetMatrix(matrix, camera)) root.Reject(matrix_key, problem);
  }
  const std::string lens_key = either("distortion_coefficients", "Distortion_Coefficients");
  if (const std::vector<double> coefficients = OpenCvMatrix(root.Child(lens_key), lens_key); !coefficients.empty()) {
    if (const std::string problem = SetLens(coefficients, camera); !problem.empty())
      root.Reject(lens_key, "'distortion_coefficients' " + problem);
  }
  root.IgnoreRest();
}

std::string FirstLine(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

}  // namespace

Camera ReadCamera(const std::filesystem::path& file) {
  const std::string first_line = FirstLine(file);
  if (first_line.starts_with("<?xml")) return ReadOpenCvXml(file);
  Camera camera;
  const bool of_opencv = first_line.starts_with("%YAML:");
  settings::Document document =
      settings::Document::FromFile(file, of_opencv ? settings::Dialect::opencv : settings::Dialect::ours);
  settings::Section root = document.root();
  if (of_opencv) {
    ReadOpenCvYaml(root, camera);
  } else if (root.Has("intrinsics")) {
    ReadEuroc(root, "distortion_coefficients", camera);
  } else if (root.Has("cam0")) {
    ReadEuroc(root.Child("cam0"), "distortion_coeffs", camera);
    root.IgnoreRest();  // other cameras
  } else if (root.Has("camera_matrix")) {
    ReadRos(root, camera);
  } else {
    ReadOwn(root, camera);
  }
  document.ThrowIfBad();
  return camera;
}

Camera CameraFrom(const std::string& preset_or_file) {
  std::error_code ignored;  // a name that is no valid path is not a file
  if (std::filesystem::exists(preset_or_file, ignored)) return ReadCamera(preset_or_file);
  try {
    return CameraPreset(preset_or_file);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string(error.what()) + ", or a camera file that exists");
  }
}

}  // namespace vo
