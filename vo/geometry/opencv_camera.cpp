// Calibrations that cv::FileStorage writes. Without OpenCV's own reader (4.6), which crashes, or does not terminate, on
// slightly malformed files.
#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <map>
#include <utility>

#include "tools/base/text.h"
#include "vo/geometry/foreign_camera.h"

namespace vo {
namespace {

// Entries row by row, of a list or a matrix with its size; none after a problem, which the section keeps.
std::optional<std::vector<double>> OpenCvMatrix(settings::Section root, const std::string& key) {
  std::vector<double> values;
  if (!root.Has(key)) {
    root.Reject(key, "'" + key + "' must be a matrix: rows, cols and data");
    return std::nullopt;
  }
  return RequireNumbers(root, key, values) ? std::optional(values) : std::nullopt;
}

// The characters of names and numbers.
std::string Plain(std::string_view text) {
  std::string plain(text);
  std::erase_if(plain,
                [](unsigned char c) { return std::isalnum(c) == 0 && c != '_' && c != '.' && c != '+' && c != '-'; });
  return plain;
}

std::string LinesOf(std::string_view text) {
  return std::string(static_cast<std::size_t>(std::ranges::count(text, '\n')), '\n');
}

// A word, or a list of several.
std::string YamlOfWords(std::string text, bool is_list) {
  std::ranges::replace(text, '\n', ' ');
  std::string words;
  int count = 0;
  for (const base::Word& word : base::SplitWords(text)) {
    const std::string plain = Plain(word.text);
    if (!plain.empty()) words += (count++ > 0 ? ", " : "") + plain;
  }
  return is_list || count > 1 ? "[" + words + "]" : words;
}

// YAML with short values of one line in place of their aliases: yaml.dump of Python writes "&name value" once and
// "*name" wherever else the same list stands.
std::string WithoutAliases(std::string_view yaml) {
  constexpr std::size_t kLongest = 256;  // bound on the text that hostile aliases make
  std::map<std::string_view, std::string_view> values;
  std::string out;
  while (!yaml.empty()) {
    const std::size_t end = std::min(yaml.find('\n'), yaml.size() - 1) + 1;
    const std::string_view line = yaml.substr(0, yaml.find_last_not_of(" \r\n", end - 1) + 1);
    const std::vector<base::Word> words = base::SplitWords(line);
    const std::string_view mark = words.size() > 1 ? words[1].text : " ";
    const std::size_t at = words.size() > 1 ? static_cast<std::size_t>(words[1].column) - 1 : 0;
    const auto known = values.find(mark.substr(1));
    if (mark[0] == '*' && words.size() == 2 && known != values.end()) {
      out.append(line.substr(0, at)).append(known->second).append(yaml.substr(line.size(), end - line.size()));
    } else {
      out.append(yaml.substr(0, end));
    }
    if (mark[0] == '&' && words.size() > 2) {
      const std::string_view value = line.substr(static_cast<std::size_t>(words[2].column) - 1);
      if (value.size() <= kLongest && value.starts_with('[') == value.ends_with(']')) values[mark.substr(1)] = value;
    }
    yaml.remove_prefix(end);
  }
  return out;
}

}  // namespace

std::string YamlOfXml(std::string_view file_text, const std::filesystem::path& file) {
  const auto fail = [&](const char* what) { throw settings::Error({{file.string(), 0, 0, what}}); };
  if (file_text.find("<opencv_storage") == std::string_view::npos)
    fail("is XML, but not of cv::FileStorage: docs/conventions.md, \"Camera files\", has a list");
  std::string xml;  // without comments
  while (!file_text.empty()) {
    const std::size_t begin = std::min(file_text.find("<!--"), file_text.size());
    xml += file_text.substr(0, begin);
    if (begin == file_text.size()) break;
    const std::size_t end = file_text.find("-->", begin + 4);
    if (end == std::string_view::npos) fail("is cut off in a comment");
    xml += LinesOf(file_text.substr(begin, end - begin));
    file_text.remove_prefix(end + 3);
  }
  std::string yaml = "{";
  int depth = 0;         // 1: in <opencv_storage>
  bool is_open = false;  // an element with others in it, at depth 2
  const std::string_view all = xml;
  for (std::size_t at = all.find('<'), next = 0; at < all.size(); at = next) {
    const std::size_t end = all.find('>', at);
    if (end == std::string_view::npos) fail("is cut off in an element");
    next = std::min(all.find('<', end), all.size());
    const std::string_view tag = all.substr(at + 1, end - at - 1), text = all.substr(end + 1, next - end - 1);
    const bool begins = std::string_view("/?!").find(tag.substr(0, 1)) == std::string_view::npos && !tag.ends_with('/');
    if (begins && (++depth == 2 || (depth == 3 && is_open))) {
      const std::string name = Plain(tag.substr(0, tag.find_first_of(" \t\r\n")));
      const std::string value = YamlOfWords(std::string(text), name == "data");
      if (depth == 2) is_open = value.empty();
      if (depth == 2 || name != "_") yaml += name + ": " + (depth == 2 && is_open ? "{" : value + ",");  // _: of a list
    } else if (tag.starts_with('/') && --depth == 1 && std::exchange(is_open, false)) {
      yaml += "},";
    }
    yaml += LinesOf(all.substr(at, next - at));
  }
  if (depth != 0) fail("is cut off: its elements do not all end");
  return yaml + "}";
}

std::string PlainYaml(std::string_view text) {
  const std::string yaml = WithoutAliases(text);
  std::string out;
  bool is_key = true;
  for (std::size_t i = 0; i < yaml.size(); ++i) {
    const char c = yaml[i];
    out += c;
    if (is_key && c == ':' && i + 1 < yaml.size() && std::isspace(static_cast<unsigned char>(yaml[i + 1])) == 0)
      out += ' ';
    is_key = c == '\n' || (is_key && (c == ' ' || !Plain({&c, 1}).empty()));
  }
  return out;
}

void ReadOpenCv(settings::Section root, Camera& camera) {
  if (root.Has("xi")) {
    root.Reject("xi", "OpenCV's omnidirectional model ('xi') is not known here: calibrate with cv::fisheye::calibrate");
    return root.IgnoreRest();
  }
  // The key that is present, of the spellings of OpenCV's programs and their kin.
  const auto spelt = [&](const std::vector<std::string>& keys, const std::string& other = "") {
    const auto has = [&](const std::string& key) { return root.Has(key); };
    const auto at = std::ranges::find_if(keys, has);
    const auto second = at == keys.end() ? at : std::find_if(at + 1, keys.end(), has);
    const std::string again = second != keys.end() ? *second : at != keys.end() && has(other) ? other : "";
    if (!again.empty()) root.Reject(again, "'" + again + "' states what '" + *at + "' does: keep one");
    return at == keys.end() ? keys[0] : *at;
  };
  RequireSize(root, spelt({"image_width", "image_Width"}), spelt({"image_height", "image_Height"}), camera);
  int fisheye = 0;
  if (root.Read("fisheye_model", fisheye) && fisheye != 0) camera.lens = Lens::fisheye;
  for (const char* key : {"fisheye", "model", "lens", "camera_type", "camera_model", "distortion_model",
                          "distortion_type", "calibration_model", "lens_model", "lens_type", "projection_model"}) {
    std::string model;
    if (!root.Has(key) || !root.Read(key, model)) continue;
    const auto is_any_of = [&](std::initializer_list<std::string_view> names) {
      return std::ranges::find(names, model) != names.end();
    };
    const bool is_fisheye = is_any_of({"true", "1", "fisheye", "equidistant", "KANNALA_BRANDT"}),
               is_plain =
                   is_any_of({"false", "0", "none", "pinhole", "PINHOLE", "plumb_bob", "radtan", "radial_tangential"});
    if (is_fisheye) camera.lens = Lens::fisheye;
    const std::string_view k = key;
    const bool may_be_a_name = (k == "model" || k == "lens" || k == "camera_type") &&
                               !is_any_of({"omni", "mei", "MEI", "ds", "double_sphere", "eucm", "fov"});
    if (!is_fisheye && !is_plain && !may_be_a_name)
      root.Reject(
          key, std::string("'") + key + "' is '" + model + "': pinhole (plumb_bob) and fisheye (equidistant) are read");
  }
  const std::string matrix_key = spelt(kMatrixKeys, "K");
  if (const auto matrix = OpenCvMatrix(root, matrix_key)) {
    if (const std::string problem = SetMatrix(*matrix, camera); !problem.empty()) root.Reject(matrix_key, problem);
  }
  const std::string lens_key = spelt(
      {"distortion_coefficients", "Distortion_Coefficients", "distCoeffs", "dist_coeffs", "dist_coeff", "D1"}, "D");
  const auto coefficients = OpenCvMatrix(root, lens_key);
  if (coefficients && !(coefficients->empty() && camera.lens == Lens::radial_tangential)) {
    if (const std::string problem = SetLens(*coefficients, camera); !problem.empty())
      root.Reject(lens_key, "'" + lens_key + "' " + problem);
  }
  root.IgnoreRest();
}

}  // namespace vo
