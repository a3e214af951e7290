#include "tools/base/limits/exr.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "tools/base/limits/picture.h"

namespace limits {
namespace {

// Reads on from a place; nothing where the file ends before.
class Cursor {
 public:
  Cursor(std::span<const std::uint8_t> file, std::size_t at) : file_(file), at_(std::min(at, file.size())) {}

  std::optional<std::int32_t> Number() {
    if (left() < 4) return std::nullopt;
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8 | file_[at_ + i];
    at_ += 4;
    return static_cast<std::int32_t>(value);
  }
  std::optional<std::string> Text() {
    const auto rest = file_.subspan(at_);
    const auto end = std::find(rest.begin(), rest.end(), std::uint8_t{0});
    if (end == rest.end()) return std::nullopt;
    std::string text(rest.begin(), end);
    at_ += text.size() + 1;
    return text;
  }
  void Skip(std::size_t bytes) { at_ += bytes; }
  std::size_t left() const { return file_.size() - at_; }

 private:
  std::span<const std::uint8_t> file_;
  std::size_t at_;
};

// "xMin yMin xMax yMax"
std::string WindowProblem(Cursor window, std::size_t bytes) {
  std::int64_t corner[4] = {};
  for (std::int64_t& value : corner) value = window.Number().value_or(0);
  return PictureSizeProblem(corner[2] - corner[0] + 1, corner[3] - corner[1] + 1, bytes);
}

// The library takes an attribute of a type that it knows as long as the type is, whatever the header says, and reads on
// from there.
constexpr std::pair<std::string_view, std::int32_t> kLengths[] = {{"box2f", 16},
                                                                  {"box2i", 16},
                                                                  {"chromaticities", 32},
                                                                  {"compression", 1},
                                                                  {"deepImageState", 1},
                                                                  {"double", 8},
                                                                  {"envmap", 1},
                                                                  {"float", 4},
                                                                  {"int", 4},
                                                                  {"keycode", 28},
                                                                  {"lineOrder", 1},
                                                                  {"m33d", 72},
                                                                  {"m33f", 36},
                                                                  {"m44d", 128},
                                                                  {"m44f", 64},
                                                                  {"rational", 8},
                                                                  {"tiledesc", 9},
                                                                  {"timecode", 8},
                                                                  {"v2d", 16},
                                                                  {"v2f", 8},
                                                                  {"v2i", 8},
                                                                  {"v3d", 24},
                                                                  {"v3f", 12},
                                                                  {"v3i", 12}};

bool IsAsLongAsItsType(const std::string& type, Cursor value, std::int32_t size) {
  for (const auto& [name, length] : kLengths) {
    if (type == name) return size == length;
  }
  if (type == "preview") {
    const std::int64_t width = value.Number().value_or(0), height = value.Number().value_or(0);
    return width >= 0 && height >= 0 && width < kLongestSide && height < kLongestSide && size == 8 + 4 * width * height;
  }
  if (type == "chlist") {  // names, each with 16 bytes; an empty one ends them
    const std::size_t end = value.left() - static_cast<std::size_t>(size);
    while (value.left() > end) {
      const std::string name = value.Text().value_or("");
      if (name.empty()) return value.left() == end;
      if (value.left() < 16) return false;
      value.Skip(16);
    }
    return false;
  }
  return true;
}

}  // namespace

std::string ExrProblem(std::span<const std::uint8_t> file) {
  constexpr std::uint8_t kManyParts = 0x10;  // in the second byte of the version
  const bool many_parts = file.size() > 5 && (file[5] & kManyParts) != 0;
  Cursor at(file, 8);
  for (bool between_parts = false;
       ;) {  // an empty name ends a part; where there are many, a second one ends the last of them
    const std::optional<std::string> name = at.Text();
    if (!name) return "its header breaks off";
    if (name->empty()) {
      if (!many_parts || between_parts) return "";
      between_parts = true;
      continue;
    }
    between_parts = false;
    const std::optional<std::string> type = at.Text();
    const std::optional<std::int32_t> size = at.Number();
    if (!type || !size || *size < 0 || static_cast<std::size_t>(*size) > at.left())
      return "its attribute '" + name->substr(0, 40) + "' goes beyond the file's end";
    if (*type == "stringvector" || *type == "idmanifest")
      return "its attribute '" + name->substr(0, 40) + "' is of a type that is not used here";
    if (!IsAsLongAsItsType(*type, at, *size))
      return "its attribute '" + name->substr(0, 40) + "' is not as long as its type";
    if (*name == "dataWindow" || *name == "displayWindow") {
      if (std::string problem = WindowProblem(at, file.size()); !problem.empty()) return problem;
    }
    if (*name == "tiles") {
      Cursor tile = at;
      const std::int64_t width = tile.Number().value_or(0), height = tile.Number().value_or(0);
      if (const std::string problem = PictureSizeProblem(width, height, file.size()); !problem.empty())
        return "tiles: " + problem;
    }
    at.Skip(static_cast<std::size_t>(*size));
  }
}

}  // namespace limits
