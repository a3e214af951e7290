#include "sim/sequence/encode.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>

#include <bit>
#include <cstring>
#include <stdexcept>

namespace sim {
namespace {

static_assert(std::endian::native == std::endian::little, "EncodeFlo writes numbers as the machine has them");

// OpenEXR's stream into memory.
class Memory final : public Imf::OStream {
 public:
  Memory() : OStream("memory") {}
  void write(const char text[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (at_ + size > bytes.size()) bytes.resize(at_ + size);
    std::memcpy(bytes.data() + at_, text, size);
    at_ += size;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t at) override { at_ = at; }

  std::vector<std::uint8_t> bytes;

 private:
  std::size_t at_ = 0;
};

template <class T>
void Append(std::vector<std::uint8_t>& bytes, const T* from, std::size_t count) {
  const std::size_t size = bytes.size();
  bytes.resize(size + count * sizeof(T));
  std::memcpy(bytes.data() + size, from, count * sizeof(T));
}

}  // namespace

std::vector<std::uint8_t> EncodeExr(std::span<const float> pixels, int width, int height, int channels, bool packed) {
  static constexpr const char* kNames[2][3] = {{"Y"}, {"R", "G", "B"}};
  Imf::Header header(width, height);
  header.compression() = packed ? Imf::RLE_COMPRESSION : Imf::NO_COMPRESSION;
  Imf::FrameBuffer buffer;
  const auto n = static_cast<std::size_t>(channels);
  for (std::size_t c = 0; c < n; ++c) {
    const char* name = kNames[n == 3][c];
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    // OpenEXR's frame buffer takes a pointer to what it will only read.
    char* base = const_cast<char*>(reinterpret_cast<const char*>(pixels.data() + c));
    buffer.insert(name,
                  Imf::Slice(Imf::FLOAT, base, n * sizeof(float), n * sizeof(float) * static_cast<std::size_t>(width)));
  }
  Memory memory;
  {
    Imf::OutputFile file(memory, header, 0);  // in this thread
    file.setFrameBuffer(buffer);
    file.writePixels(height);
  }
  return std::move(memory.bytes);
}

std::vector<std::uint8_t> EncodeFlo(std::span<const float> uv, int width, int height) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(12 + uv.size_bytes());
  const std::int32_t size[2] = {width, height};
  Append(bytes, "PIEH", 4);
  Append(bytes, size, 2);
  Append(bytes, uv.data(), uv.size());
  return bytes;
}

}  // namespace sim
