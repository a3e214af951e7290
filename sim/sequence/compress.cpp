#include "sim/sequence/compress.h"

#include <isa-l/crc.h>
#include <isa-l/igzip_lib.h>

#include <algorithm>
#include <bit>
#include <new>
#include <stdexcept>
#include <string>

namespace sim {
namespace {

static_assert(std::is_trivially_destructible_v<isal_zstream>);

// A place for the stream on which what ISA-L writes does not depend. ISA-L keeps the last position of every four bytes
// in a table, at their CRC-32C. For the third position ISA-L 2.30 takes instead the CRC of a register in which its
// stream's address is left, without the last 16 bits (igzip_icf_body_h1_gr_bt.asm, .write_first_byte: `tmp2` is not
// loaded). Position 2 then stands in an entry that depends on where the stream lies: without effect, unless it is that
// of one of the first three positions. An entry of no position says 0, so a match with the first bytes would be missed.
class StreamPlace {
 public:
  explicit StreamPlace(std::span<const std::uint8_t> content) : memory_(kPlaces * kApart + sizeof(isal_zstream)) {
    void* at = memory_.data.get();
    std::size_t room = memory_.size;
    std::align(alignof(isal_zstream), sizeof(isal_zstream), at, room);
    auto* place = static_cast<std::uint8_t*>(at);
    for (std::size_t i = 0; i + 1 < kPlaces && Disturbs(place, content); ++i) place += kApart;
    stream_ = new (place) isal_zstream{};
  }
  isal_zstream& stream() { return *stream_; }

 private:
  static constexpr std::size_t kPlaces = 8, kApart = 1 << 16;  // address space, of which one place becomes memory

  static unsigned Entry(const std::uint8_t* four_bytes, std::size_t content) {
    const unsigned last = content < 4096 ? std::bit_ceil(static_cast<unsigned>(content) + 1) - 1 : 8191;
    return crc32_iscsi(const_cast<std::uint8_t*>(four_bytes), 4, 0) & last;
  }

  static bool Disturbs(const std::uint8_t* place, std::span<const std::uint8_t> content) {
    if (content.size() < 6) return false;
    const auto address = reinterpret_cast<std::uintptr_t>(place);
    std::uint8_t left[4];
    for (int byte = 0; byte < 4; ++byte) left[byte] = static_cast<std::uint8_t>(address >> (16 + 8 * byte));
    const unsigned entry = Entry(left, content.size());
    for (int position = 0; position < 3; ++position) {
      if (entry == Entry(&content[static_cast<std::size_t>(position)], content.size())) return true;
    }
    return false;
  }

  Buffer memory_;
  isal_zstream* stream_;
};

}  // namespace

// Above level 1 it is slower and no smaller; level 3 gives other bytes on other processors.
Buffer Compress(std::span<const std::uint8_t> content) {
  const Buffer work(ISAL_DEF_LVL1_DEFAULT);
  Buffer compressed(content.size() + content.size() / 8 + 1024);  // more than it takes if nothing can be compressed
  std::fill_n(work.data.get(), work.size, std::uint8_t{0});       // ISA-L looks at what was there before
  StreamPlace place(content);
  isal_zstream& stream = place.stream();
  isal_deflate_stateless_init(&stream);
  stream.level = 1;
  stream.level_buf = work.data.get();
  stream.level_buf_size = static_cast<std::uint32_t>(work.size);
  stream.gzip_flag = IGZIP_ZLIB;
  stream.end_of_stream = 1;
  stream.next_in = const_cast<std::uint8_t*>(content.data());
  stream.avail_in = static_cast<std::uint32_t>(content.size());
  stream.next_out = compressed.data.get();
  stream.avail_out = static_cast<std::uint32_t>(compressed.size);
  if (const int status = isal_deflate_stateless(&stream); status != COMP_OK) {
    throw std::logic_error("ISA-L cannot compress, status " + std::to_string(status));
  }
  compressed.size = stream.total_out;
  return compressed;
}

}  // namespace sim
