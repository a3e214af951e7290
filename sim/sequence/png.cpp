#include "sim/sequence/png.h"

#include <libdeflate.h>

#include <algorithm>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

#include "sim/sequence/png_filter.h"

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
Bytes Encode(int width, int height, int channels, int bytes_per_sample, std::size_t samples,
             const RowBytes& row_bytes) {
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
  AppendChunk(file, "IDAT", compressed.bytes());
  AppendChunk(file, "IEND", {});
  return file;
}

}  // namespace

Bytes EncodePng(int width, int height, int channels, std::span<const std::uint8_t> samples) {
  return Encode(width, height, channels, 1, samples.size(), [&](std::size_t y, Bytes& row) {
    std::copy_n(samples.begin() + static_cast<std::ptrdiff_t>(y * row.size()), row.size(), row.begin());
  });
}

Bytes EncodePng(int width, int height, int channels, std::span<const std::uint16_t> samples) {
  return Encode(width, height, channels, 2, samples.size(), [&](std::size_t y, Bytes& row) {
    MostSignificantFirst(samples.data() + y * (row.size() / 2), row.size() / 2, row.data());
  });
}

}  // namespace sim
