// Calibrations as lines of words and numbers: COLMAP, DSO, LSD-SLAM.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "tools/base/text.h"
#include "vo/geometry/foreign_camera.h"

namespace vo {
namespace {

// Parameters of a model: focal lengths (one or two), the principal point, and lens coefficients.
struct Model {
  std::size_t focal_lengths;
  std::size_t coefficients;  // all of them in the order of SetLens, but for one or two: k1, k2
  Lens lens;
};
using Models = std::map<std::string, Model, std::less<>>;
constexpr Lens kPlain = Lens::radial_tangential, kFisheye = Lens::fisheye;

const Models& ColmapModels() {
  static const Models models = {{"SIMPLE_PINHOLE", {1, 0, kPlain}},   {"PINHOLE", {2, 0, kPlain}},
                                {"SIMPLE_RADIAL", {1, 1, kPlain}},    {"RADIAL", {1, 2, kPlain}},
                                {"OPENCV", {2, 4, kPlain}},           {"FULL_OPENCV", {2, 8, kPlain}},
                                {"OPENCV_FISHEYE", {2, 4, kFisheye}}, {"SIMPLE_RADIAL_FISHEYE", {1, 1, kFisheye}},
                                {"RADIAL_FISHEYE", {1, 2, kFisheye}}};
  return models;
}

// In small letters. The fifth parameter of a pinhole is 0.
const Models& DsoModels() {
  static const Models models = {{"pinhole", {2, 1, kPlain}},
                                {"radtan", {2, 4, kPlain}},
                                {"equidistant", {2, 4, kFisheye}},
                                {"kannalabrandt", {2, 4, kFisheye}}};
  return models;
}

using Words = std::span<const base::Word>;
struct Line {
  int number;
  std::vector<base::Word> words;
};

// The first lines that hold data, without comments.
std::vector<Line> DataLines(std::string_view text) {
  std::vector<Line> lines;
  for (int number = 1; !text.empty() && lines.size() < 8; ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    std::vector<base::Word> words = base::SplitWords(line.substr(0, line.find('#')));
    if (!words.empty()) lines.push_back({number, std::move(words)});
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::optional<double> Number(std::string_view text) { return base::ParseNumber(base::WithoutPlus(text)); }

bool IsNumber(const base::Word& word) { return Number(word.text).has_value(); }

[[noreturn]] void Refuse(const std::filesystem::path& file, const Line& line, const std::string& what) {
  throw settings::Error({{file.string(), line.number, line.words[0].column, what}});
}

// Returns the problem of the parameters; empty: none.
std::string SetParameters(const Model& model, Words words, Camera& camera) {
  std::vector<double> p;
  for (const base::Word& word : words) {
    const std::optional<double> number = Number(word.text);
    if (!number || !std::isfinite(*number))
      return "'" + std::string(word.text) + (number ? "' is not a finite number" : "' is not a number");
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
bool SetSize(Words words, Camera& camera) {
  const auto width = base::ParseWhole(words[0].text), height = base::ParseWhole(words[1].text);
  if (!width || !height || *width < 1 || *height < 1 || *width > 1 << 20 || *height > 1 << 20) return false;
  camera.width = static_cast<int>(*width);
  camera.height = static_cast<int>(*height);
  return true;
}

bool ReadColmap(const std::vector<Line>& lines, const std::filesystem::path& file, Camera& camera) {
  const Line& first = lines[0];
  const Words words = first.words;
  if (words.size() < 5 || IsNumber(words[1])) return false;
  const auto model = ColmapModels().find(words[1].text);
  const bool is_known = model != ColmapModels().end();
  if (!SetSize(words.subspan(2, 2), camera)) {
    if (is_known) Refuse(file, first, "COLMAP's width and height must be whole numbers above 0");
    return false;
  }
  if (!is_known)
    Refuse(file, first,
           "COLMAP's model " + std::string(words[1].text) +
               " is not known here: refine OPENCV or OPENCV_FISHEYE, or undistort the images");
  if (lines.size() > 1) Refuse(file, lines[1], "holds more than one camera: keep the line of one");
  const std::string problem = SetParameters(model->second, words.subspan(4), camera);
  if (!problem.empty()) Refuse(file, first, problem);
  camera.cx -= 0.5;  // COLMAP's first pixel has its corner at 0
  camera.cy -= 0.5;
  return true;
}

// DSO, LSD-SLAM: parameters, perhaps after a name, then the size. A field-of-view lens without its angle is a pinhole.
bool ReadDso(const std::vector<Line>& lines, const std::filesystem::path& file, Camera& camera) {
  const Line& first = lines[0];
  const bool has_name = !IsNumber(first.words[0]);
  const Words numbers = Words(first.words).subspan(has_name ? 1 : 0);
  const bool has_size = lines.size() > 1 && lines[1].words.size() == 2 && SetSize(lines[1].words, camera);
  std::string name = has_name ? std::string(first.words[0].text) : numbers.size() == 8 ? "radtan" : "";
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (!has_name && numbers.size() == 5) name = "fov";
  if (name == "fov" && !numbers.empty() && Number(numbers.back().text) == 0.0) name = "pinhole";
  const auto model = DsoModels().find(name);
  const bool is_known = name == "fov" || model != DsoModels().end();
  if (!has_size && has_name && is_known)
    Refuse(file, lines[lines.size() > 1 ? 1 : 0],
           "the line after the model's must be the width and height of the images, two whole numbers");
  if (!has_size || numbers.size() < 4 || (!is_known && !std::ranges::all_of(numbers, IsNumber))) return false;
  if (!is_known && has_name)
    Refuse(file, first,
           "the model '" + std::string(first.words[0].text) +
               "' is not known here; known in DSO's format: Pinhole, RadTan, EquiDistant, KannalaBrandt");
  if (!is_known)
    Refuse(file, first,
           "parameters in DSO's format are fx, fy, cx, cy, and 0 of a pinhole or k1, k2, p1, p2; there are " +
               std::to_string(numbers.size()) + " numbers");
  if (name == "fov")
    Refuse(file, first,
           "the field-of-view lens of TUM's monocular dataset and DSO is not known here: calibrate a "
           "radial-tangential or equidistant one, or rectify the images");
  const std::string problem = SetParameters(model->second, numbers, camera);
  if (!problem.empty()) Refuse(file, first, problem);
  if (name == "pinhole" && camera.k1 != 0)
    Refuse(file, first, "the fifth number of DSO's Pinhole must be 0: a lens with distortion is RadTan");
  if (camera.cx < 1 && camera.cy < 1) {  // in parts of the image, from its corner
    camera.fx *= camera.width, camera.fy *= camera.height;
    camera.cx = camera.cx * camera.width - 0.5, camera.cy = camera.cy * camera.height - 0.5;
  }
  return true;
}

}  // namespace

std::optional<Camera> ReadTextCamera(std::string_view text, const std::filesystem::path& file) {
  const std::vector<Line> lines = DataLines(text);
  Camera camera;
  camera.readout_s = std::nullopt;
  if (!lines.empty() && (ReadColmap(lines, file, camera) || ReadDso(lines, file, camera))) return camera;
  return std::nullopt;
}

}  // namespace vo
