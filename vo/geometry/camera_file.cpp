#include "vo/geometry/camera_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/base/files.h"
#include "tools/base/settings/settings.h"
#include "tools/base/text.h"
#include "vo/geometry/foreign_camera.h"

namespace vo {
namespace {

void RequireLens(settings::Section& section, const std::string& key, const std::string& name, Camera& camera) {
  std::vector<double> coefficients;
  if (!section.Require(key, coefficients) || coefficients.empty()) return;
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
  if (!section.Has("rows") && !section.Has("data")) {
    section.Reject("data", "'" + name + "' must be a matrix: rows, cols and data");
    return {};
  }
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

// Without cv::FileStorage, which crashes, or does not terminate, on slightly malformed files (OpenCV 4.6).
void ReadOpenCv(settings::Section root, Camera& camera) {
  // The key that is present, of the two spellings of OpenCV's programs.
  const auto either = [&](const char* name, const char* other) {
    return std::string(root.Has(name) || !root.Has(other) ? name : other);
  };
  RequireSize(root, either("image_width", "image_Width"), either("image_height", "image_Height"), camera);
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

// The characters of names and numbers.
std::string Plain(std::string_view text) {
  std::string plain(text);
  std::erase_if(plain,
                [](unsigned char c) { return std::isalnum(c) == 0 && c != '_' && c != '.' && c != '+' && c != '-'; });
  return plain;
}

// OpenCV's XML (cv::FileStorage) as YAML, line for line: elements of words, and those in them, as matrices have.
// Without OpenCV's own reader (4.6), which ends the program on slightly malformed files.
std::string YamlOfXml(std::string_view xml, const std::filesystem::path& file) {
  const auto fail = [&](const char* what) { throw settings::Error({{file.string(), 0, 0, what}}); };
  if (xml.find("<opencv_storage") == std::string_view::npos)
    fail("is XML, but not of cv::FileStorage: docs/conventions.md, \"Camera files\", has a list");
  std::string yaml = "{";
  int depth = 0;         // 1: in <opencv_storage>
  bool is_open = false;  // an element with others in it, at depth 2
  for (std::size_t at = xml.find('<'), next = 0; at < xml.size(); at = next) {
    const std::size_t end = xml.find(xml.substr(at).starts_with("<!--") ? "-->" : ">", at);
    if (end == std::string_view::npos) fail("is cut off in an element");
    next = std::min(xml.find('<', end), xml.size());
    const std::string_view tag = xml.substr(at + 1, end - at - 1), text = xml.substr(end + 1, next - end - 1);
    const bool begins = std::string_view("/?!").find(tag.substr(0, 1)) == std::string_view::npos && !tag.ends_with('/');
    if (begins && (++depth == 2 || (depth == 3 && is_open))) {
      std::string words;
      for (const base::Word& word : base::SplitWords(text)) words += (words.empty() ? "" : ", ") + Plain(word.text);
      const std::string name = Plain(tag.substr(0, tag.find_first_of(" \t\r\n")));
      if (depth == 2) is_open = words.empty();
      yaml += name + ": " + (depth == 2 && is_open ? "{" : name == "data" ? "[" + words + "]," : words + ",");
    } else if (tag.starts_with('/') && --depth == 1 && std::exchange(is_open, false)) {
      yaml += "},";
    }
    yaml.append(static_cast<std::size_t>(std::ranges::count(xml.substr(at, next - at), '\n')), '\n');
  }
  if (depth != 0) fail("is cut off: its elements do not all end");
  return yaml + "}";
}

// A blank behind the colon of a key, which cv::FileStorage does not need.
std::string WithBlanks(std::string_view yaml) {
  std::string out;
  bool is_key = true;
  for (std::size_t i = 0; i < yaml.size(); ++i) {
    const char c = yaml[i];
    out += c;
    if (is_key && c == ':' && i + 1 < yaml.size() && std::isspace(static_cast<unsigned char>(yaml[i + 1])) == 0)
      out += ' ';
    is_key = c == '\n' || (is_key && (c == ' ' || Plain({&c, 1}) != ""));
  }
  return out;
}

// First data of the first line that is not a comment.
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
  const std::optional<std::string> content = base::ReadFile(file);
  if (!content) settings::Document::FromFile(file);  // throws with the reason
  const std::string_view text = base::WithoutMark(*content);
  const auto refuse = [&](const std::string& what) { throw settings::Error({{file.string(), 0, 0, what}}); };
  const std::string unknown =
      "is no calibration of a kind that is known here: docs/conventions.md, \"Camera files\", has a list";
  if (const std::string problem = base::TextProblem(content->substr(0, 1024)); !problem.empty()) refuse(problem);
  if (std::optional<Camera> camera = ReadTextCamera(FirstData(text), file)) return *camera;
  const bool is_xml = FirstData(text).starts_with('<'), is_ours = !is_xml && HasLine(text, "fx:");
  const std::string extension = file.extension().string();
  std::optional<settings::Document> read;
  try {
    // Our dialect has no tags and a single document.
    read = settings::Document::FromText(is_xml    ? YamlOfXml(text, file)
                                        : is_ours ? std::string(text)
                                                  : WithBlanks(text),
                                        file.string(), is_ours ? settings::Dialect::ours : settings::Dialect::opencv);
  } catch (const settings::Error&) {
    if (extension == ".txt" || extension == ".cfg" || extension == ".m" || extension == ".csv") refuse(unknown);
    throw;
  }
  settings::Document& document = *read;
  Camera camera;
  camera.readout_s = std::nullopt;
  settings::Section root = document.root();
  const auto count = [&](std::initializer_list<const char*> keys) {
    return std::ranges::count_if(keys, [&](const char* key) { return root.Has(key); });
  };
  if (root.Has("cam0")) {
    ReadEuroc(root.Child("cam0"), "distortion_coeffs", camera);
    root.IgnoreRest();  // other cameras
  } else if (root.Has("intrinsics")) {
    ReadEuroc(root, "distortion_coefficients", camera);
  } else if (ReadSlamCamera(root, camera)) {
    // has read it
  } else if (count({"camera_matrix", "Camera_Matrix", "image_width"}) > 0) {
    ReadOpenCv(root, camera);
  } else if (count({"width", "height", "fx", "fy"}) > 1) {
    ReadOwn(root, camera);
  } else {
    root.IgnoreRest();
    document.ThrowIfBad();
    refuse(unknown);
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
