#include "vo/geometry/camera_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "tools/base/files.h"
#include "tools/base/limits/structured_text.h"
#include "tools/base/settings/settings.h"
#include "tools/base/text.h"
#include "vo/geometry/foreign_camera.h"

namespace vo {
namespace {

// Camera matrix K, 3 x 3, row by row. Returns its problems.
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
  enum class Distortion { radtan, none, equidistant } distortion = Distortion::radtan;
  section.RequireChoice("distortion_model", distortion,
                        {{"radtan", Distortion::radtan},
                         {"radial-tangential", Distortion::radtan},
                         {"plumb_bob", Distortion::radtan},
                         {"none", Distortion::none},
                         {"equidistant", Distortion::equidistant}});
  if (distortion == Distortion::equidistant) camera.lens = Lens::fisheye;
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
  if (distortion != Distortion::none) RequireLens(section, coefficients, coefficients, camera);
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
  double readout_s = 0;
  if (root.Read("rolling_shutter", readout_s, settings::Unit::time, settings::Range{-1, 1}))
    camera.readout_s = readout_s;
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

// Entries of a matrix of OpenCV's XML, row by row; empty where it is none. Without cv::Mat's reader, which allocates as
// many rows and columns as the file states.
std::vector<double> Numbers(const cv::FileNode& matrix) {
  if (!matrix.isMap()) return {};
  const cv::FileNode rows = matrix["rows"], columns = matrix["cols"], data = matrix["data"];
  if (!rows.isInt() || !columns.isInt() || !data.isSeq()) return {};
  const std::int64_t count = static_cast<std::int64_t>(static_cast<int>(rows)) * static_cast<int>(columns);
  if (count < 1 || static_cast<std::size_t>(count) != data.size()) return {};
  std::vector<double> values;
  for (const cv::FileNode& value : data) {
    if (!value.isInt() && !value.isReal()) return {};
    values.push_back(static_cast<double>(value));
  }
  return values;
}

cv::FileStorage OpenXml(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text;
  for (std::array<char, 4096> block; stream && text.size() <= limits::kMostStorageBytes;) {
    stream.read(block.data(), block.size());
    text.append(block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (const std::string problem = limits::OpenCvStorageProblem(text); !problem.empty())
    throw settings::Error({{file.string(), 0, 0, "OpenCV cannot read it: it is " + problem}});
  cv::FileStorage storage(file.string(), cv::FileStorage::READ);
  if (!storage.isOpened()) throw settings::Error({{file.string(), 0, 0, "OpenCV cannot read it"}});
  return storage;
}

// OpenCV's XML (cv::FileStorage). Problems have no lines.
Camera ReadOpenCvXml(const std::filesystem::path& file) try {
  const cv::FileStorage storage = OpenXml(file);
  std::vector<settings::Problem> problems;
  const auto complain = [&](const std::string& message) { problems.push_back({file.string(), 0, 0, message}); };
  // The key that is present, of the two spellings.
  const auto find = [&](const char* name, const char* other) {
    const cv::FileNode node = storage[name];
    return node.empty() ? storage[other] : node;
  };
  const auto size = [&](const char* name, const char* other) {
    const cv::FileNode node = find(name, other);
    const int value = node.isInt() ? static_cast<int>(node) : 0;
    if (value <= 0) complain(std::string("'") + name + "' must be there, a positive whole number");
    return value;
  };
  const auto matrix = [&](const char* name, const char* other) {
    std::vector<double> values = Numbers(find(name, other));
    if (values.empty()) complain(std::string("'") + name + "' must be there, a matrix of numbers");
    if (std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); })) return values;
    complain(std::string("'") + name + "' has a number that is none");
    return std::vector<double>();
  };
  Camera camera;
  camera.readout_s = std::nullopt;
  camera.width = size("image_width", "image_Width");
  camera.height = size("image_height", "image_Height");
  if (const std::vector<double> values = matrix("camera_matrix", "Camera_Matrix"); !values.empty())
    for (const std::string& problem : SetMatrix(values, camera)) complain(problem);
  const cv::FileNode fisheye = storage["fisheye_model"];
  if (fisheye.isInt() && static_cast<int>(fisheye) != 0) camera.lens = Lens::fisheye;
  if (const std::vector<double> values = matrix("distortion_coefficients", "Distortion_Coefficients"); !values.empty())
    if (const std::string problem = SetLens(values, camera); !problem.empty())
      complain("'distortion_coefficients' " + problem);
  if (!problems.empty()) throw settings::Error(problems);
  return camera;
} catch (const settings::Error&) {
  throw;
} catch (const cv::Exception& error) {
  throw settings::Error({{file.string(), 0, 0, "OpenCV cannot read it: " + error.err}});
} catch (const std::exception& error) {  // the parser passes on those of the standard library
  throw settings::Error({{file.string(), 0, 0, std::string("OpenCV cannot read it: ") + error.what()}});
}

// What begins the first line that is no comment.
std::string_view FirstData(std::string_view text) {
  while (text.starts_with('#') || text.starts_with('\n') || text.starts_with('\r')) {
    const std::size_t end = text.find('\n');
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return text;
}

bool HasLine(std::string_view text, std::string_view begin) {
  return text.starts_with(begin) || text.find("\n" + std::string(begin)) != std::string_view::npos;
}

}  // namespace

std::string SetLens(std::span<const double> coefficients, Camera& camera) {
  const std::size_t most = camera.lens == Lens::fisheye ? 4 : 5;
  if (coefficients.size() < 4)
    return "must be k1, k2, p1, p2 and perhaps k3, or k1 ... k4 of an equidistant lens; there are " +
           std::to_string(coefficients.size()) + " numbers";
  for (std::size_t i = most; i < coefficients.size(); ++i) {
    if (coefficients[i] != 0)
      return "has more than " + std::to_string(most) + " coefficients that are not zero: that lens is not known here";
  }
  camera.k1 = coefficients[0];
  camera.k2 = coefficients[1];
  const bool fisheye = camera.lens == Lens::fisheye;
  (fisheye ? camera.k3 : camera.p1) = coefficients[2];
  (fisheye ? camera.k4 : camera.p2) = coefficients[3];
  if (!fisheye && coefficients.size() > 4) camera.k3 = coefficients[4];
  return "";
}

Camera ReadCamera(const std::filesystem::path& file) {
  const std::string content = base::ReadFile(file).value_or("");
  const std::string_view text = base::WithoutMark(content);
  if (text.starts_with("<?xml")) return ReadOpenCvXml(file);
  if (std::optional<Camera> camera = ReadTextCamera(FirstData(text), file)) return *camera;
  Camera camera;
  camera.readout_s = std::nullopt;
  // Ours knows no tags, and is one document.
  settings::Document document =
      settings::Document::FromFile(file, HasLine(text, "fx:") ? settings::Dialect::ours : settings::Dialect::opencv);
  settings::Section root = document.root();
  if (root.Has("cam0")) {
    ReadEuroc(root.Child("cam0"), "distortion_coeffs", camera);
    root.IgnoreRest();  // other cameras
  } else if (root.Has("intrinsics")) {
    ReadEuroc(root, "distortion_coefficients", camera);
  } else if (root.Has("camera_matrix") && root.Has("distortion_model")) {
    ReadRos(root, camera);
  } else if (ReadSlamCamera(root, camera)) {
    // has read it
  } else if (root.Has("camera_matrix") || root.Has("Camera_Matrix") || root.Has("image_width")) {
    ReadOpenCvYaml(root, camera);
  } else {
    constexpr const char* kOwn[] = {"width", "height", "fx", "fy", "cx", "cy", "distortion", "rolling_shutter"};
    if (std::ranges::none_of(kOwn, [&](const char* key) { return root.Has(key); })) {
      root.IgnoreRest();
      document.ThrowIfBad();
      throw settings::Error({{file.string(), 0, 0,
                              "is no calibration of a kind that is known here: docs/conventions.md, "
                              "\"Camera files\", has a list"}});
    }
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
