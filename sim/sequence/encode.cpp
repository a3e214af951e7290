#include "sim/sequence/encode.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>

#include "sim/random/avx2_too.h"

namespace sim {
namespace {

using Bytes = std::vector<std::uint8_t>;

void PutBigEndian(std::uint32_t number, std::uint8_t* at) {
  for (int byte = 0; byte < 4; ++byte) at[byte] = static_cast<std::uint8_t>(number >> (24 - 8 * byte));
}

// Length, name, content, and the CRC of the latter two.
void AppendChunk(Bytes& file, std::string_view name, std::span<const std::uint8_t> content) {
  const std::size_t start = file.size();
  file.resize(start + 8);
  PutBigEndian(static_cast<std::uint32_t>(content.size()), &file[start]);
  std::copy(name.begin(), name.end(), &file[start + 4]);
  file.insert(file.end(), content.begin(), content.end());
  const std::uint32_t crc = libdeflate_crc32(0, &file[start + 4], 4 + content.size());
  file.resize(file.size() + 4);
  PutBigEndian(crc, &file[file.size() - 4]);
}

// Memory that is about to be written: not zeroed first.
struct Buffer {
  explicit Buffer(std::size_t bytes) : data(std::make_unique_for_overwrite<std::uint8_t[]>(bytes)), size(bytes) {}
  std::span<const std::uint8_t> bytes() const { return {data.get(), size}; }

  std::unique_ptr<std::uint8_t[]> data;
  std::size_t size;
};

// A zlib stream (RFC 1950).
Buffer Compress(std::span<const std::uint8_t> content) {
  constexpr int kLevel = 1;
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  Buffer stream(libdeflate_zlib_compress_bound(compressor.get(), content.size()));
  stream.size =
      libdeflate_zlib_compress(compressor.get(), content.data(), content.size(), stream.data.get(), stream.size);
  return stream;
}

// `row_bytes(y, out)` gives row y as PNG has it: most significant byte first.
template <class RowBytes>
Bytes Encode(int width, int height, int channels, int bytes_per_sample, std::size_t samples, const RowBytes& row_bytes,
             const std::string& comment = "") {
  if (width < 1 || height < 1 || (channels != 1 && channels != 3) ||
      static_cast<double>(samples) != static_cast<double>(width) * height * channels) {
    throw std::invalid_argument("PNG: " + std::to_string(width) + " x " + std::to_string(height) + " pixels of " +
                                std::to_string(channels) + " channels are not " + std::to_string(samples) + " samples");
  }
  if (static_cast<double>(samples) * bytes_per_sample + height > 0x70000000) {
    throw std::invalid_argument("PNG: the picture is larger than a PNG file can be");
  }
  const std::size_t pixel = static_cast<std::size_t>(channels * bytes_per_sample);
  const std::size_t stride = static_cast<std::size_t>(width) * pixel;
  constexpr std::uint8_t kPaeth = 4;
  const Buffer filtered((stride + 1) * static_cast<std::size_t>(height));
  Bytes row(stride), above(stride, 0);
  for (int y = 0; y < height; ++y) {
    std::uint8_t* out = &filtered.data[static_cast<std::size_t>(y) * (stride + 1)];
    *out = kPaeth;
    row_bytes(static_cast<std::size_t>(y), row);
    PaethFilter(row.data(), above.data(), stride, pixel, out + 1);
    std::swap(row, above);
  }
  const Buffer compressed = Compress(filtered.bytes());

  Bytes header(13, 0);  // the last three: deflate, adaptive filters, not interlaced
  PutBigEndian(static_cast<std::uint32_t>(width), &header[0]);
  PutBigEndian(static_cast<std::uint32_t>(height), &header[4]);
  header[8] = static_cast<std::uint8_t>(8 * bytes_per_sample);
  header[9] = channels == 3 ? 2 : 0;
  Bytes file{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  file.reserve(compressed.size + 64);
  AppendChunk(file, "IHDR", header);
  const std::string text = std::string("Comment") + '\0' + comment;
  if (!comment.empty()) AppendChunk(file, "tEXt", {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  AppendChunk(file, "IDAT", compressed.bytes());
  AppendChunk(file, "IEND", {});
  return file;
}

inline std::int16_t Size(std::int16_t x) { return std::max(x, static_cast<std::int16_t>(-x)); }

}  // namespace

// Neighbours left of the first pixel are zeros: the one above is then nearest.
VOBENCH_FOR_AVX2_TOO
void PaethFilter(const std::uint8_t* row, const std::uint8_t* above, std::size_t size, std::size_t pixel,
                 std::uint8_t* __restrict filtered) {
  for (std::size_t i = 0; i < std::min(pixel, size); ++i) filtered[i] = static_cast<std::uint8_t>(row[i] - above[i]);
  // Sixteen bits and no branches, for vectorisation.
  for (std::size_t i = pixel; i < size; ++i) {
    const std::int16_t a = row[i - pixel], b = above[i], c = above[i - pixel];
    const std::int16_t to_a = static_cast<std::int16_t>(b - c), to_b = static_cast<std::int16_t>(a - c);
    const std::int16_t from_a = Size(to_a), from_b = Size(to_b), from_c = Size(static_cast<std::int16_t>(to_a + to_b));
    const std::int16_t nearest_of_b_c = from_b <= from_c ? b : c;
    const std::int16_t nearest = from_a <= std::min(from_b, from_c) ? a : nearest_of_b_c;
    filtered[i] = static_cast<std::uint8_t>(row[i] - nearest);
  }
}

VOBENCH_FOR_AVX2_TOO
void MostSignificantFirst(const std::uint16_t* samples, std::size_t count, std::uint8_t* __restrict bytes) {
  for (std::size_t i = 0; i < count; ++i) {
    bytes[2 * i] = static_cast<std::uint8_t>(samples[i] >> 8);
    bytes[2 * i + 1] = static_cast<std::uint8_t>(samples[i]);
  }
}

Bytes EncodePng(int width, int height, int channels, std::span<const std::uint8_t> samples) {
  return Encode(width, height, channels, 1, samples.size(), [&](std::size_t y, Bytes& row) {
    std::copy_n(samples.begin() + static_cast<std::ptrdiff_t>(y * row.size()), row.size(), row.begin());
  });
}

Bytes EncodePng(int width, int height, int channels, std::span<const std::uint16_t> samples,
                const std::string& comment) {
  const auto row_bytes = [&](std::size_t y, Bytes& row) {
    MostSignificantFirst(samples.data() + y * (row.size() / 2), row.size() / 2, row.data());
  };
  return Encode(width, height, channels, 2, samples.size(), row_bytes, comment);
}

Bytes EncodePng(const Image& image) {
  if (image.bits == 8) return EncodePng(image.width, image.height, image.channels, image.data);
  std::vector<std::uint16_t> highest_bits(image.wide.size());  // of 16, so that white is white in every viewer
  for (std::size_t i = 0; i < image.wide.size(); ++i) {
    highest_bits[i] = static_cast<std::uint16_t>(image.wide[i] << (16 - image.bits));
  }
  return EncodePng(image.width, image.height, image.channels, highest_bits);
}

Bytes EncodeDepthPng(std::span<const float> depth_m, int width, int height) {
  std::vector<std::uint16_t> fifths_of_millimetres(depth_m.size());
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    const float value = 5000.0f * depth_m[i];
    const float kept = value < 65535.5f ? value : 0.0f;  // NaN: 0, too
    const int below = static_cast<int>(std::max(kept, 0.0f));
    const int rounded = below + static_cast<int>(kept - static_cast<float>(below) >= 0.5f);
    fifths_of_millimetres[i] = static_cast<std::uint16_t>(rounded);
  }
  const auto beyond = std::ranges::count_if(depth_m, [](float Z) { return 5000.0f * Z >= 65535.5f; });
  return EncodePng(
      width, height, 1, fifths_of_millimetres,
      beyond == 0 ? ""
                  : "value / 5000 m; 0: nothing, or one of " + std::to_string(beyond) + " pixels beyond 13.1071 m");
}

Bytes EncodeExr(std::span<const float> pixels, int width, int height, int channels, bool packed) {
  static constexpr const char* kNames[2][3] = {{"Y"}, {"R", "G", "B"}};
  Imf::Header header(width, height);
  header.compression() = packed ? Imf::RLE_COMPRESSION : Imf::NO_COMPRESSION;
  Imf::FrameBuffer buffer;
  const auto n = static_cast<std::size_t>(channels);
  for (std::size_t c = 0; c < n; ++c) {
    const char* name = kNames[n == 3][c];
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    // OpenEXR's frame buffer takes a non-const pointer, which it only reads.
    char* base = const_cast<char*>(reinterpret_cast<const char*>(pixels.data() + c));
    buffer.insert(name,
                  Imf::Slice(Imf::FLOAT, base, n * sizeof(float), n * sizeof(float) * static_cast<std::size_t>(width)));
  }
  Imf::StdOSStream memory;
  {
    Imf::OutputFile file(memory, header, 0);  // in this thread
    file.setFrameBuffer(buffer);
    file.writePixels(height);
  }
  const std::string bytes = memory.str();
  return {bytes.begin(), bytes.end()};
}

Bytes EncodeFlo(std::span<const float> uv, int width, int height) {
  static_assert(std::endian::native == std::endian::little, "numbers are written as the machine has them");
  const std::int32_t size[2] = {width, height};
  Bytes bytes(12 + uv.size_bytes());
  std::memcpy(bytes.data(), "PIEH", 4);
  std::memcpy(&bytes[4], size, 8);
  std::copy_n(reinterpret_cast<const std::uint8_t*>(uv.data()), uv.size_bytes(), bytes.data() + 12);
  return bytes;
}

}  // namespace sim
