#include "vo/geometry/camera_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <sstream>
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

// sensor.yaml of EuRoC, and a camera of Kalibr's camchain.yaml, which differ in the key of the coefficients.
void ReadEuroc(settings::Section section, const std::string& lens_key, Camera& camera) {
  section.IgnoreRest();
  const std::string remedy =
      " is not known here: calibrate a pinhole with a radtan or equidistant lens (Kalibr: pinhole-radtan, "
      "pinhole-equi)";
  std::string model, distortion;
  if (section.Require("camera_model", model) && model != "pinhole")
    return section.Reject("camera_model", "the camera model '" + model + "'" + remedy);
  const bool has_distortion = section.Require("distortion_model", distortion);
  const bool none = distortion == "none";
  if (distortion == "equidistant") {
    camera.lens = Lens::fisheye;
  } else if (has_distortion && !none && distortion != "radtan" && distortion != "radial-tangential" &&
             distortion != "plumb_bob") {
    return section.Reject("distortion_model", "the distortion model '" + distortion + "'" + remedy);
  }
  std::array<double, 2> size{};
  std::array<double, 4> intrinsics{};
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
  double line_delay_s = 0;  // from row to row, of Kalibr's calibration of rolling shutters
  if (section.Read("line_delay", line_delay_s, settings::Unit::none, settings::Range{-1e-3, 1e-3}))
    camera.readout_s = line_delay_s * (camera.height - 1);
  std::vector<double> coefficients;
  if (!(none ? section.Read(lens_key, coefficients) : section.Require(lens_key, coefficients))) return;
  if (none && std::ranges::any_of(coefficients, [](double k) { return k != 0; }))
    return section.Reject(lens_key, "'" + lens_key + "' must be 0 where 'distortion_model' is none");
  if (none || (coefficients.empty() && camera.lens != Lens::fisheye)) return;
  if (const std::string problem = SetLens(coefficients, camera); !problem.empty())
    section.Reject(lens_key, "'" + lens_key + "' " + problem);
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

// Rejects keys that state a part of the camera otherwise than what was read.
void RejectOtherValues(settings::Section root, const Camera& camera) {
  const Camera& c = camera;
  const bool fisheye = c.lens == Lens::fisheye;
  const double width = c.width, height = c.height;
  const std::vector<double> lens = fisheye ? std::vector{c.k1, c.k2, c.k3, c.k4} : std::vector{c.k1, c.k2, c.p1, c.p2};
  const std::vector<std::pair<const char*, std::vector<double>>> all = {{"fx", {c.fx}},
                                                                        {"fy", {c.fy}},
                                                                        {"cx", {c.cx}},
                                                                        {"cy", {c.cy}},
                                                                        {"k1", {c.k1}},
                                                                        {"k2", {c.k2}},
                                                                        {"k3", {c.k3}},
                                                                        {"k4", {fisheye ? c.k4 : 0}},
                                                                        {"p1", {c.p1}},
                                                                        {"p2", {c.p2}},
                                                                        {"skew", {0}},
                                                                        {"width", {width}},
                                                                        {"height", {height}},
                                                                        {"image_width", {width}},
                                                                        {"image_height", {height}},
                                                                        {"image_size", {width, height}},
                                                                        {"resolution", {width, height}},
                                                                        {"intrinsics", {c.fx, c.fy, c.cx, c.cy}},
                                                                        {"distortion_coeffs", lens},
                                                                        {"distortion_coefficients", lens}};
  for (const auto& [key, ours] : all) {
    std::vector<settings::RawYaml> texts;
    if (!root.Has(key) || !root.ReadRaw(key, texts)) continue;
    std::vector<double> theirs;
    for (const settings::RawYaml& each : texts)
      if (const auto number = base::ParseNumber(base::WithoutPlus(each.text))) theirs.push_back(*number);
    if (theirs.size() != ours.size()) continue;
    const auto differs = [](double a, double b) { return !(std::abs(a - b) <= 1e-6 * std::abs(b) + 1e-12); };
    for (std::size_t i = 0; i < ours.size(); ++i) {
      if (!differs(theirs[i], ours[i])) continue;
      root.Reject(key, std::string("'") + key + "' has " + base::Significant(theirs[i], 9) + " where the rest has " +
                           base::Significant(ours[i], 9) + ": keep what is right");
      break;
    }
  }
}

// JSON with its lines of comments, which cv::FileStorage writes, made empty.
std::string WithoutComments(std::string_view json) {
  std::string out;
  for (std::size_t begin = 0, end = 0; begin < json.size(); begin = end) {
    end = std::min(json.find('\n', begin), json.size() - 1) + 1;
    const std::string_view line = json.substr(begin, end - begin);
    out += line.substr(std::min(line.find_first_not_of(" \t"), line.size())).starts_with("//") ? "\n" : line;
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

// Readout time that a calibration in another program's format states: in the words of camera.yaml, which that format's
// reader skips, or in those of VINS (rolling_shutter: 0 or 1; rolling_shutter_tr in seconds).
std::optional<double> ForeignReadout(std::string_view text, const std::filesystem::path& file) {
  const std::string key = "rolling_shutter";
  std::istringstream lines{std::string(text)};
  std::string yaml;
  int number = 0;
  for (std::string line; std::getline(lines, line); yaml += '\n') {
    ++number;
    const bool is_misplaced = line.substr(std::min(line.find_first_not_of(" \t<{\"'"), line.size())).starts_with(key);
    if (line.starts_with(key))
      yaml += line;
    else if (is_misplaced)
      throw settings::Error(
          {{file.string(), number, static_cast<int>(line.find(key)) + 1,
            "'" + key + "' is not read here: state it on a line of its own without an indent, as in '" + key +
                ": 26 ms'"}});
  }
  settings::Document document = settings::Document::FromText(yaml, file.string());
  settings::Section root = document.root();
  double readout_s = 0, rolls = 1;
  const bool of_vins = root.Read("rolling_shutter_tr", readout_s, settings::Unit::time, settings::Range{-1, 1});
  const bool is_stated = of_vins ? root.Require(key, rolls, settings::Range{0, 1})
                                 : root.Read(key, readout_s, settings::Unit::time, settings::Range{-1, 1});
  document.ThrowIfBad();
  return is_stated ? std::optional(rolls * readout_s) : std::nullopt;
}

// A calibration of another program that is not read, by a word in it; else empty.
std::string UnreadKind(std::string_view text) {
  for (const auto& [word, kind] : {std::pair{"\"camera_angle_x\"", "NeRF's transforms.json"},
                                   {"\"fl_x\"", "nerfstudio's transforms.json, whose first pixel has its corner at 0"},
                                   {"\"intrinsic_matrix\"", "Open3D's, whose matrix is written column by column"},
                                   {"\"ppx\"", "RealSense's"},
                                   {"[image]", "the ini file of ROS, which has a YAML file beside it"},
                                   {"P0:", "KITTI's, of several cameras and without the size of the images"},
                                   {"K_00:", "KITTI's, of several cameras"},
                                   {"P_rect_00:", "KITTI's, of several cameras"}})
    if (text.find(word) != std::string_view::npos) return kind;
  return "";
}

Camera CameraOfText(std::string_view text, const std::filesystem::path& file) {
  const auto refuse = [&] {
    const std::string kind = UnreadKind(text);
    throw settings::Error({{file.string(), 0, 0,
                            "is no calibration of a kind that is known here: docs/conventions.md, \"Camera files\", "
                            "has a list" +
                                (kind.empty() ? "" : "; it is " + kind + ": write its numbers as a camera.yaml")}});
  };
  if (std::optional<Camera> camera = ReadTextCamera(text, file)) return *camera;
  const std::string_view data = FirstData(text);
  const bool is_xml = data.starts_with('<'), is_tagged = text.find("!!opencv") != std::string_view::npos,
             is_ours = !is_xml && !is_tagged && HasLine(text, "fx:");
  const bool is_json = data.starts_with('{') && data.substr(1, data.find_first_not_of(" \t\r\n", 1)).ends_with('"');
  const std::string extension = file.extension().string();
  std::optional<settings::Document> read;
  try {
    // Our dialect has no tags and a single document.
    read = settings::Document::FromText(is_xml    ? YamlOfXml(text, file)
                                        : is_ours ? std::string(text)
                                        : is_json ? PlainYaml(WithoutComments(text))
                                                  : PlainYaml(text),
                                        file.string(), is_ours ? settings::Dialect::ours : settings::Dialect::opencv);
  } catch (const settings::Error&) {
    if (std::ranges::count(std::array{".txt", ".cfg", ".ini", ".m", ".csv"}, extension) > 0) refuse();
    throw;
  }
  settings::Document& document = *read;
  Camera camera;
  camera.readout_s = std::nullopt;
  settings::Section root = document.root();
  const auto count = [&](const std::vector<std::string>& keys) {
    return std::ranges::count_if(keys, [&](const std::string& key) { return root.Has(key); });
  };
  constexpr std::array kOfAChain = {"cam0", "cam1", "cam2", "cam3", "cam4", "cam5", "cam6", "cam7"};
  const auto first = std::ranges::find_if(kOfAChain, [&](const char* key) { return root.Has(key); });
  if (first != kOfAChain.end()) {
    ReadEuroc(root.Child(*first), "distortion_coeffs", camera);
    root.IgnoreRest();  // other cameras
  } else if (ReadSlamCamera(root, camera)) {
    // has read it
  } else if (root.Has("intrinsics") && count({"camera_model", "distortion_model", "resolution"}) > 0) {
    ReadEuroc(root, root.Has("distortion_coeffs") ? "distortion_coeffs" : "distortion_coefficients", camera);
  } else if (count(kMatrixKeys) + count({"image_width"}) > 0) {
    ReadOpenCv(root, camera);
  } else if (count({"width", "height", "fx", "fy", "cx", "cy"}) > (is_json ? 5 : 1)) {  // JSON may be any program's
    ReadOwn(root, camera);
  } else {
    root.IgnoreRest();
    document.ThrowIfBad();
    refuse();
  }
  document.ThrowIfBad();
  RejectOtherValues(first != kOfAChain.end() ? root.Child(*first) : root, camera);
  document.ThrowIfBad();
  return camera;
}

// Returns what no camera has, as of numbers in other units than pixels; empty: nothing.
std::string ImplausiblePart(const Camera& camera) {
  const auto text = [](double value) { return base::Significant(value, 6) + " px"; };
  for (const double f : {camera.fx, camera.fy}) {
    if (!(f >= 0.1 * camera.width && f <= 100.0 * camera.width))
      return "a focal length of " + text(f) + " does not fit images " + std::to_string(camera.width) +
             " px wide: expected " + text(0.1 * camera.width) + " to " + text(100.0 * camera.width);
  }
  for (const auto& [c, size] : {std::pair(camera.cx, camera.width), std::pair(camera.cy, camera.height)}) {
    if (!(c >= -size && c <= 2.0 * size))
      return "a principal point at " + text(c) + " does not fit images of " + std::to_string(size) + " px: expected " +
             text(-size) + " to " + text(2.0 * size);
  }
  return "";
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
  const auto refuse = [&](const std::string& what) { throw settings::Error({{file.string(), 0, 0, what}}); };
  std::error_code ignored;  // a name that is no valid path is not a file
  if (std::filesystem::is_directory(file, ignored)) refuse("is a folder: give the calibration file in it");
  const std::optional<std::string> content = base::ReadFile(file);
  if (!content) settings::Document::FromFile(file);  // throws with the reason
  if (const std::string problem = base::TextProblem(content->substr(0, 1024)); !problem.empty()) refuse(problem);
  const std::string_view text = base::WithoutMark(*content);
  Camera camera = CameraOfText(text, file);
  if (!camera.readout_s) camera.readout_s = ForeignReadout(text, file);
  if (const std::string problem = ImplausiblePart(camera); !problem.empty()) refuse(problem);
  return camera;
}

Camera CameraFrom(const std::string& preset_or_file) {
  std::error_code ignored;  // a name that is no valid path is not a file
  const bool is_folder = std::filesystem::is_directory(preset_or_file, ignored);
  if (!is_folder && std::filesystem::exists(preset_or_file, ignored)) return ReadCamera(preset_or_file);
  try {
    return CameraPreset(preset_or_file);
  } catch (const std::invalid_argument& error) {
    if (is_folder) return ReadCamera(preset_or_file);  // throws: it is one
    if (preset_or_file.find_first_of("./") != std::string::npos)
      throw std::invalid_argument("there is no file '" + preset_or_file + "'");
    throw std::invalid_argument(std::string(error.what()) + ", or a camera file that exists");
  }
}

}  // namespace vo
