#include "sim/world/image_file.h"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "tools/base/limits/picture.h"
#include "tools/base/text.h"

namespace sim {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a};

std::uint32_t BigEndian32(Bytes b) {
  return (std::uint32_t{b[0]} << 24) | (std::uint32_t{b[1]} << 16) | (std::uint32_t{b[2]} << 8) | b[3];
}

std::string_view AsChars(Bytes bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

struct PngChunk {
  std::size_t at;
  std::string_view type;
  Bytes whole, content;  // whole: length, type, content, checksum
};

// The whole chunks of a PNG, to its end chunk.
std::vector<PngChunk> PngChunks(Bytes png) {
  std::vector<PngChunk> chunks;
  for (std::size_t at = kPngSignature.size(); at + 12 <= png.size(); at += chunks.back().whole.size()) {
    const std::size_t length = BigEndian32(png.subspan(at));
    if (length > png.size() - at - 12) break;
    chunks.push_back({at, AsChars(png.subspan(at + 4, 4)), png.subspan(at, length + 12), png.subspan(at + 8, length)});
    if (chunks.back().type == "IEND") break;
  }
  return chunks;
}

void CheckSums(Bytes png) {
  for (const PngChunk& chunk : PngChunks(png)) {
    const Bytes summed = chunk.whole.subspan(4, chunk.content.size() + 4);
    if (libdeflate_crc32(0, summed.data(), summed.size()) != BigEndian32(chunk.whole.last(4)))
      throw std::runtime_error("damaged PNG: wrong checksum in the chunk at byte " + std::to_string(chunk.at));
  }
}

// Pixels of a TGA: grey, 15 to 32 bits of colour, or a palette of these; perhaps in run lengths, from any corner.
DecodedImage DecodeTga(Bytes file, bool with_alpha) {
  const auto word = [&](std::size_t at) { return static_cast<std::size_t>(file[at] | file[at + 1] << 8); };
  const int type = file[2] & ~8, width = static_cast<int>(word(12)), height = static_cast<int>(word(14));
  const bool runs = (file[2] & 8) != 0, palette = type == 1;
  const std::size_t bits = file[16], entry = (palette ? file[7] : bits) / 8 + (file[palette ? 7 : 16] == 15 ? 1u : 0u);
  const std::size_t size = palette ? 1 : entry, colors = 18 + file[0], first_color = word(3),
                    color_count = file[1] ? word(5) : 0;
  std::size_t at = colors + color_count * (file[1] != 0 ? (file[7] + 7u) / 8 : 0);
  const auto need = [&](std::size_t from, std::size_t count) {
    if (from > file.size() || count > file.size() - from) throw std::runtime_error("truncated TGA");
  };
  const std::size_t pixels = word(12) * word(14);
  need(at, runs ? (pixels + 127) / 128 * (1 + size) : pixels * size);  // a packet has 128 pixels at most
  DecodedImage image(cv::Mat(height, width, CV_8UC3));
  const bool has_alpha = with_alpha && entry == 4 && type != 3 && (palette || (file[17] & 15) != 0);
  if (has_alpha) image.alpha.resize(pixels);
  std::size_t left = 0, repeated = 0;  // of the packet
  for (std::size_t i = 0; i < pixels; ++i) {
    if (runs && left == 0) {
      need(at, 1);
      left = (file[at] & 127u) + 1;
      repeated = file[at++] >> 7;
    }
    need(at, size);
    std::size_t from = at;
    if (palette) {
      const std::size_t index = file[at];
      if (index < first_color || index - first_color >= color_count)
        throw std::runtime_error("damaged TGA: no such colour");
      from = colors + (index - first_color) * entry;
      need(from, entry);
    }
    const auto column = i % static_cast<std::size_t>(width), row = i / static_cast<std::size_t>(width);
    const std::size_t x = (file[17] & 16) != 0 ? static_cast<std::size_t>(width) - 1 - column : column;
    const std::size_t y = (file[17] & 32) != 0 ? row : static_cast<std::size_t>(height) - 1 - row;
    const std::size_t to = y * static_cast<std::size_t>(width) + x;
    std::uint8_t* const rgb = &image.rgb[3 * to];
    if (type == 3) {
      rgb[0] = rgb[1] = rgb[2] = file[from];
    } else if (entry == 2) {
      const std::size_t five = word(from);
      for (std::size_t c = 0; c < 3; ++c) rgb[c] = static_cast<std::uint8_t>(((five >> (10 - 5 * c)) & 31u) * 255 / 31);
    } else {
      for (std::size_t c = 0; c < 3; ++c) rgb[c] = file[from + 2 - c];
      if (has_alpha) image.alpha[to] = file[from + 3];
    }
    if (runs) --left;
    if (!runs || repeated == 0 || left == 0) at += size;
  }
  return image;
}

// Removes colour profiles, which are not applied: libpng warns of common ones on the terminal.
std::vector<std::uint8_t> WithoutProfile(Bytes png) {
  std::vector<std::uint8_t> out(kPngSignature.begin(), kPngSignature.end());
  for (const PngChunk& chunk : PngChunks(png))
    if (chunk.type != "iCCP") out.insert(out.end(), chunk.whole.begin(), chunk.whole.end());
  return out;
}

// The content of the first chunk of a type; empty: there is none.
Bytes ContentOf(const std::vector<PngChunk>& chunks, std::string_view type) {
  const auto found = std::ranges::find(chunks, type, &PngChunk::type);
  return found == chunks.end() ? Bytes() : found->content;
}

// Where a grey PNG names one grey as transparent, which OpenCV ignores, the alpha of its pixels.
cv::Mat AlphaOfGreyKey(Bytes png, const cv::Mat& grey) {
  if (grey.empty() || grey.channels() != 1) return {};
  const std::vector<PngChunk> chunks = PngChunks(png);
  const Bytes header = ContentOf(chunks, "IHDR"), key = ContentOf(chunks, "tRNS");
  if (header.size() < 13 || header[9] != 0 || key.size() < 2) return {};
  const int bits = header[8], value = key[0] << 8 | key[1];
  return grey != (bits < 8 ? value * 255 / ((1 << bits) - 1) : value);
}

// Product of the factors by which a Radiance picture's values were multiplied.
double ExposureOf(std::string_view file) {
  constexpr std::string_view kKey = "EXPOSURE=";
  double exposure = 1;
  for (std::size_t end = file.find('\n'); end != std::string_view::npos && end > 0; end = file.find('\n')) {
    const std::string_view line = file.substr(0, end);
    const std::vector<base::Word> words = base::SplitWords(line.starts_with(kKey) ? line.substr(kKey.size()) : "");
    const double factor = words.empty() ? 0 : base::ParseNumber(words[0].text).value_or(0);
    if (factor > 0) exposure *= factor;
    file.remove_prefix(end + 1);
  }
  return exposure;
}

}  // namespace

std::string StandInProblem(Bytes bytes) {
  const std::string_view text = AsChars(bytes.first(std::min<std::size_t>(bytes.size(), 200)));
  if (text.starts_with("version https://git-lfs"))
    return "is a pointer of Git LFS, not the file itself: fetch it with 'git lfs pull'";
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first != std::string_view::npos && (text.substr(first).starts_with("<!") || text.substr(first).starts_with("<h")))
    return "is a web page (HTML), not the file itself: download it again";
  return "";
}

cv::Mat DecodeMatrix(Bytes bytes, int flags) {
  cv::Mat picture;
  try {
    const cv::Mat data(1, static_cast<int>(bytes.size()), CV_8U, const_cast<std::uint8_t*>(bytes.data()));
    if (!bytes.empty()) picture = cv::imdecode(data, flags);
  } catch (const cv::Exception& error) {
    throw std::runtime_error("cannot be decoded: " + error.err);
  }
  if (picture.empty()) throw std::runtime_error("not a picture that can be decoded");
  if (picture.depth() == CV_32F && AsChars(bytes).starts_with("#?")) picture /= ExposureOf(AsChars(bytes));
  return picture;
}

namespace {

// A Radiance picture, whose values are linear, in codes of sRGB.
cv::Mat CodedHdr(Bytes bytes) {
  cv::Mat picture = DecodeMatrix(bytes, cv::IMREAD_COLOR | cv::IMREAD_ANYDEPTH), coded;
  picture.forEach<cv::Vec3f>([](cv::Vec3f& color, const int*) {
    for (float& c : color.val) c = 255 * (c > 0.0031308f ? 1.055f * std::pow(c, 1 / 2.4f) - 0.055f : 12.92f * c);
  });
  picture.convertTo(coded, CV_8U);
  return coded;
}

DecodedImage DecodeByOpenCv(Bytes bytes, bool with_alpha) {
  const bool is_jpeg = AsChars(bytes).starts_with("\xff\xd8");  // which has no alpha
  const cv::Mat bgr = AsChars(bytes).starts_with("#?")
                          ? CodedHdr(bytes)
                          : DecodeMatrix(bytes, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION),
                all = with_alpha && !is_jpeg ? DecodeMatrix(bytes, cv::IMREAD_UNCHANGED) : cv::Mat();
  DecodedImage image(bgr);
  if (all.channels() == 4 && all.size() == bgr.size() && (all.depth() == CV_8U || all.depth() == CV_16U)) {
    cv::Mat alpha;
    cv::extractChannel(all, alpha, 3);
    alpha.convertTo(alpha, CV_8U, all.depth() == CV_16U ? 1.0 / 257.0 : 1.0);
    image.alpha.assign(alpha.begin<std::uint8_t>(), alpha.end<std::uint8_t>());
  }
  if (const cv::Mat alpha = AlphaOfGreyKey(bytes, all); alpha.size() == bgr.size())
    image.alpha.assign(alpha.begin<std::uint8_t>(), alpha.end<std::uint8_t>());
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) std::swap(image.rgb[i], image.rgb[i + 2]);
  return image;
}

}  // namespace

DecodedImage::DecodedImage(const cv::Mat& of)
    : width(of.cols), height(of.rows), pixels(std::make_shared<cv::Mat>(of)), rgb(pixels->data, 3 * pixels->total()) {}

DecodedImage DecodeImage(Bytes bytes, bool with_alpha) {
  if (bytes.empty()) throw std::runtime_error("the file is empty");
  for (const std::string& problem :
       {StandInProblem(bytes), limits::PictureProblem(bytes), limits::PictureEndProblem(bytes)}) {
    if (!problem.empty()) throw std::runtime_error(problem);
  }
  if (bytes.size() >= kPngSignature.size() && std::equal(kPngSignature.begin(), kPngSignature.end(), bytes.begin())) {
    CheckSums(bytes);
    if (AsChars(bytes).find("iCCP") != std::string_view::npos) {
      const std::vector<std::uint8_t> plain = WithoutProfile(bytes);
      return DecodeByOpenCv(plain, with_alpha);
    }
  }
  return limits::IsTga(bytes) ? DecodeTga(bytes, with_alpha) : DecodeByOpenCv(bytes, with_alpha);
}

void SetAlpha(const DecodedImage& mask, DecodedImage& image) {
  cv::Mat alpha;
  if (std::ranges::all_of(mask.alpha, [](std::uint8_t a) { return a == 255; })) {
    cv::cvtColor(*mask.pixels, alpha, cv::COLOR_RGB2GRAY);
  } else {
    alpha = cv::Mat(mask.height, mask.width, CV_8UC1, const_cast<std::uint8_t*>(mask.alpha.data()));
  }
  cv::Mat fitting;
  cv::resize(alpha, fitting, cv::Size(image.width, image.height), 0, 0, cv::INTER_LINEAR);
  image.alpha.assign(fitting.begin<std::uint8_t>(), fitting.end<std::uint8_t>());
}

}  // namespace sim
