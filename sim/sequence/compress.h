// zlib streams (RFC 1950), as PNG files hold them. By ISA-L.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace sim {

// Memory that is about to be written: not zeroed first, as that costs a tenth of a picture's encoding.
struct Buffer {
  explicit Buffer(std::size_t bytes) : data(std::make_unique_for_overwrite<std::uint8_t[]>(bytes)), size(bytes) {}
  std::span<const std::uint8_t> bytes() const { return {data.get(), size}; }

  std::unique_ptr<std::uint8_t[]> data;
  std::size_t size;
};

// The same bytes for the same content, in every process and thread, on every x86-64 processor with SSE4.2.
// Throws std::logic_error where ISA-L refuses.
Buffer Compress(std::span<const std::uint8_t> content);

}  // namespace sim
