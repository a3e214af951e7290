#include "tools/base/limits/picture.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "tools/base/limits/jpeg.h"

namespace limits {
namespace {

using Bytes = std::span<const std::uint8_t>;

struct Size {
  std::int64_t width = 0, height = 0;
  bool is_log_luv = false;  // a TIFF that is coded so: decoders take its codes for colours
};

std::int64_t Number(Bytes file, std::size_t at, std::size_t count, bool little) {
  std::uint64_t value = 0;
  if (at > file.size() || count > file.size() - at) return 0;  // no size: rejected
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | file[at + (little ? count - 1 - i : i)];
  return static_cast<std::int64_t>(value);
}

bool Begins(Bytes file, std::string_view magic, std::size_t at = 0) {
  return file.size() >= at + magic.size() &&
         std::equal(magic.begin(), magic.end(), file.begin() + static_cast<std::ptrdiff_t>(at),
                    [](char c, std::uint8_t byte) { return static_cast<std::uint8_t>(c) == byte; });
}

Size OfPng(Bytes file) { return {Number(file, 16, 4, false), Number(file, 20, 4, false)}; }

// The first frame's header: a marker 0xffc0 to 0xffcf that is neither of a Huffman table, an extension nor of
// arithmetic coding.
Size OfJpeg(Bytes file) {
  for (std::size_t at = 2; at + 9 < file.size();) {
    if (file[at] != 0xff) return {};
    const std::uint8_t marker = file[at + 1];
    if (marker == 0xff) {  // a fill byte
      ++at;
      continue;
    }
    if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc)
      return {Number(file, at + 7, 2, false), Number(file, at + 5, 2, false)};
    at += 2 + static_cast<std::size_t>(Number(file, at + 2, 2, false));
  }
  return {};
}

Size OfBmp(Bytes file) {
  if (Number(file, 14, 4, true) == 12) return {Number(file, 18, 2, true), Number(file, 20, 2, true)};
  const auto height = static_cast<std::int32_t>(Number(file, 22, 4, true));  // negative: from the top
  return {Number(file, 18, 4, true), height < 0 ? -std::int64_t{height} : height};
}

// The largest of the first directory's picture and tile: a decoder makes room for either.
Size OfTiff(Bytes file, bool little) {
  const auto directory = static_cast<std::size_t>(Number(file, 4, 4, little));
  const std::int64_t entries = Number(file, directory, 2, little);
  Size picture, tile;
  for (std::int64_t i = 0; i < entries; ++i) {
    const std::size_t at = directory + 2 + 12 * static_cast<std::size_t>(i);
    constexpr std::int64_t kShort = 3;
    const std::int64_t value = Number(file, at + 8, Number(file, at + 2, 2, little) == kShort ? 2 : 4, little);
    const std::int64_t tag = Number(file, at, 2, little);
    if (tag == 256) picture.width = value;
    if (tag == 257) picture.height = value;
    if (tag == 322) tile.width = value;
    if (tag == 323) tile.height = value;
    if (tag == 259) picture.is_log_luv = value == 34676 || value == 34677;
  }
  if (picture.width < 1 || picture.height < 1) return {};
  return {std::max(picture.width, tile.width), std::max(picture.height, tile.height), picture.is_log_luv};
}

Size OfWebp(Bytes file) {
  if (file.size() < 30) return {};
  if (Begins(file, "VP8X", 12)) return {1 + Number(file, 24, 3, true), 1 + Number(file, 27, 3, true)};
  if (Begins(file, "VP8L", 12)) {
    const std::int64_t bits = Number(file, 21, 4, true);
    return {1 + (bits & 0x3fff), 1 + ((bits >> 14) & 0x3fff)};
  }
  if (Begins(file, "VP8 ", 12)) return {Number(file, 26, 2, true) & 0x3fff, Number(file, 28, 2, true) & 0x3fff};
  return {};
}

bool IsPnm(Bytes file) { return file.size() > 2 && file[0] == 'P' && file[1] >= '1' && file[1] <= '6'; }

// Digits at `at`, which is moved behind them; nothing where there are none, or too many.
std::optional<std::int64_t> Digits(Bytes file, std::size_t& at) {
  std::int64_t value = 0;
  const std::size_t begin = at;
  for (; at < file.size() && std::isdigit(file[at]); ++at) {
    if (at - begin > 9) return std::nullopt;
    value = 10 * value + (file[at] - '0');
  }
  return at > begin ? std::optional(value) : std::nullopt;
}

struct PnmHeader : Size {
  std::int64_t largest = 255;  // value of a pixel
};

PnmHeader OfPnm(Bytes file) {
  std::size_t at = 2;
  const auto next = [&] {
    while (at < file.size() && (std::isspace(file[at]) || file[at] == '#')) {
      if (file[at] == '#') {
        while (at < file.size() && file[at] != '\n') ++at;
      } else {
        ++at;
      }
    }
    return Digits(file, at).value_or(0);
  };
  const std::int64_t width = next(), height = next();
  const bool of_bits = file[1] == '1' || file[1] == '4';
  return {{width, height}, of_bits ? 255 : next()};
}

// "-Y height +X width" after an empty line.
Size OfHdr(Bytes file) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), std::min<std::size_t>(file.size(), 4096));
  const std::size_t line = text.find("\n-Y ");
  if (line == std::string_view::npos) return {};
  std::size_t at = line + 4;
  const std::int64_t height = Digits(file, at).value_or(0);
  if (!Begins(file, " +X ", at)) return {};
  at += 4;
  return {Digits(file, at).value_or(0), height};
}

Size OfTga(Bytes file) { return {Number(file, 12, 2, true), Number(file, 14, 2, true)}; }

// Name of another kind of picture that occurs in scenes.
std::string_view KnownKind(Bytes file) {
  if (Begins(file, "DDS ")) return "DDS";
  if (Begins(file, "\x01\xda")) return "SGI (.rgb)";
  if (Begins(file, "\xabKTX")) return "KTX (Basis)";
  if (Begins(file, "sB")) return "Basis";
  if (Begins(file, "GIF8")) return "GIF";
  if (Begins(file, "8BPS")) return "Photoshop";
  if (Begins(file, "ftypavif", 4)) return "AVIF";
  if (Begins(file, std::string_view("\0\0\0\x0cjP", 6))) return "JPEG 2000";
  return "";
}

std::optional<Size> SizeOf(Bytes file) {
  if (Begins(file, "\x89PNG\r\n\x1a\n")) return OfPng(file);
  if (Begins(file, "\xff\xd8")) return OfJpeg(file);
  if (Begins(file, "BM")) return OfBmp(file);
  if (Begins(file, std::string_view("II*\0", 4))) return OfTiff(file, true);
  if (Begins(file, std::string_view("MM\0*", 4))) return OfTiff(file, false);
  if (Begins(file, "RIFF") && Begins(file, "WEBP", 8)) return OfWebp(file);
  if (IsPnm(file)) return OfPnm(file);
  if (Begins(file, "#?RGBE") || Begins(file, "#?RADIANCE")) return OfHdr(file);
  if (IsTga(file)) return OfTga(file);
  return std::nullopt;
}

// Sequential reader; none where the file ends early.
class Cursor {
 public:
  Cursor(Bytes file, std::size_t at) : file_(file), at_(std::min(at, file.size())) {}

  std::optional<std::int32_t> Number() {
    if (left() < 4) return std::nullopt;
    return static_cast<std::int32_t>(limits::Number(file_, std::exchange(at_, at_ + 4), 4, true));
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
  Bytes file_;
  std::size_t at_;
};

// "xMin yMin xMax yMax"
std::string WindowProblem(Cursor window, std::size_t bytes) {
  std::int64_t corner[4] = {};
  for (std::int64_t& value : corner) value = window.Number().value_or(0);
  return PictureSizeProblem(corner[2] - corner[0] + 1, corner[3] - corner[1] + 1, bytes);
}

// Attribute types of fixed length: the library ignores the header's size for them and continues after the fixed length.
const std::map<std::int32_t, std::set<std::string_view>>& TypesByLength() {
  static const std::map<std::int32_t, std::set<std::string_view>> types = {
      {1, {"compression", "deepImageState", "envmap", "lineOrder"}},
      {4, {"float", "int"}},
      {8, {"double", "rational", "timecode", "v2f", "v2i"}},
      {9, {"tiledesc"}},
      {12, {"v3f", "v3i"}},
      {16, {"box2f", "box2i", "v2d"}},
      {24, {"v3d"}},
      {28, {"keycode"}},
      {32, {"chromaticities"}},
      {36, {"m33f"}},
      {64, {"m44f"}},
      {72, {"m33d"}},
      {128, {"m44d"}}};
  return types;
}

bool IsAsLongAsItsType(const std::string& type, Cursor value, std::int32_t size) {
  for (const auto& [length, types] : TypesByLength()) {
    if (types.contains(type)) return size == length;
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

std::string PngEndProblem(Bytes file) {
  for (std::size_t at = 8;;) {  // length, type, data, checksum
    if (at + 12 > file.size()) return "truncated PNG: the end chunk is missing";
    const auto length = static_cast<std::size_t>(Number(file, at, 4, false));
    if (length > file.size() - at - 12) return "truncated PNG: a chunk is cut off";
    if (Begins(file, "IEND", at + 4)) return "";
    at += length + 12;
  }
}

std::string JpegEndProblem(Bytes file) {
  constexpr std::uint8_t kStartOfScan = 0xda, kEndOfImage = 0xd9;
  const char* const truncated = "truncated JPEG: the end marker is missing";
  bool in_scan = false;
  for (std::size_t at = 2;;) {
    if (in_scan) {  // entropy-coded data goes on until a marker that is neither a stuffed zero nor a restart
      while (at + 1 < file.size() &&
             (file[at] != 0xff || file[at + 1] == 0x00 || (file[at + 1] >= 0xd0 && file[at + 1] <= 0xd7))) {
        ++at;
      }
    }
    while (at + 1 < file.size() && file[at] == 0xff && file[at + 1] == 0xff) ++at;  // fill bytes
    if (at + 2 > file.size()) return truncated;
    if (file[at] != 0xff) return "damaged JPEG: no marker at byte " + std::to_string(at);
    const std::uint8_t marker = file[at + 1];
    if (marker == kEndOfImage) return "";
    if (at + 4 > file.size()) return truncated;
    at += 2 + static_cast<std::size_t>(Number(file, at + 2, 2, false));
    in_scan = marker == kStartOfScan;
  }
}

}  // namespace

std::string PictureSizeProblem(std::int64_t width, std::int64_t height, std::size_t bytes) {
  const std::string size = std::to_string(width) + " x " + std::to_string(height) + " pixels";
  if (width < 1 || height < 1) return "its header has no size";
  if (width > kLongestSide || height > kLongestSide)
    return size + ": a side may have " + std::to_string(kLongestSide) + " at most";
  if (width * height > kMostPixels) return size + ": a picture may have " + std::to_string(kMostPixels) + " at most";
  if (width * height - kPixelsOfAnyFile >
      kPixelsPerByte * static_cast<std::int64_t>(std::min<std::size_t>(bytes, 1u << 30))) {
    return size + " in " + std::to_string(bytes) + " bytes: beyond " + std::to_string(kPixelsOfAnyFile) +
           ", a byte may stand for " + std::to_string(kPixelsPerByte) + " at most";
  }
  return "";
}

std::string PictureProblem(Bytes file) {
  if (file.size() > std::size_t{1} << 30) return "larger than 1 GiB";
  const std::optional<Size> size = SizeOf(file);
  if (const std::string_view kind = KnownKind(file); !kind.empty())
    return "a picture of the kind " + std::string(kind) + ", which is not read: convert it to PNG";
  if (!size) return "not a picture that is read here (PNG, JPEG, BMP, TIFF, TGA, WebP, PNM, HDR): convert it to PNG";
  if (std::string problem = PictureSizeProblem(size->width, size->height, file.size()); !problem.empty())
    return problem;
  if (size->is_log_luv) return "a TIFF coded as LogLuv (SGI), which is not read: convert it to HDR or PNG";
  if (const std::int64_t largest = IsPnm(file) ? OfPnm(file).largest : 255; largest != 255 && largest != 65535)
    return "a PNM picture whose largest value is " + std::to_string(largest) + ", not 255 or 65535: convert it to PNG";
  return "";
}

bool IsTga(Bytes file) {
  if (file.size() < 18 || file[1] > 1) return false;
  const int type = file[2] & ~8, bits = file[16];  // 8: run lengths
  const bool grey = type == 3 && (bits == 8 || bits == 16),
             color = type == 2 && (bits == 15 || bits == 16 || bits == 24 || bits == 32);
  const bool indexed = type == 1 && file[1] == 1 && bits == 8 && file[7] >= 15 && file[7] <= 32;
  return (file[2] & ~11) == 0 && (grey || color || indexed);
}

std::string PictureEndProblem(Bytes file) {
  if (Begins(file, "\x89PNG\r\n\x1a\n")) return PngEndProblem(file);
  if (!Begins(file, "\xff\xd8")) return "";
  const std::string problem = JpegEndProblem(file);
  return problem.empty() ? JpegDataProblem(file) : problem;
}

std::string ExrProblem(Bytes file) {
  constexpr std::uint8_t kManyParts = 0x10;  // in the second byte of the version
  const bool many_parts = file.size() > 5 && (file[5] & kManyParts) != 0;
  Cursor at(file, 8);
  // An empty name ends a part; where there are many, a second one ends the last of them.
  for (bool between_parts = false;;) {
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
