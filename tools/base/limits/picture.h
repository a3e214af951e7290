// Limits of untrusted picture files: whether one may be given to a decoder, by its kind and the size in its header,
// before anything is allocated for it.
// Source: ISO 15948 (PNG), ITU T.81 (JPEG), TIFF 6.0, RFC 9649 (WebP), openexr.com/en/latest/OpenEXRFileLayout.html;
// docs/reliability.md, "Hostile input".
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace limits {

constexpr std::int64_t kLongestSide = 1 << 15;      // [px]
constexpr std::int64_t kMostPixels = 1 << 27;       // of any picture
constexpr std::int64_t kPixelsOfAnyFile = 1 << 24;  // a small file may unpack to so many,
constexpr std::int64_t kPixelsPerByte = 128;        // and to so many more for each of its bytes

// Problem of a picture's size in a file of `bytes` bytes; empty: none.
std::string PictureSizeProblem(std::int64_t width, std::int64_t height, std::size_t bytes);

// The same of a whole file. PNG, JPEG, BMP, TIFF, TGA, WebP, PNM and Radiance HDR are accepted; all other kinds are
// rejected, to keep files from decoders that are not needed.
std::string PictureProblem(std::span<const std::uint8_t> file);

// Whether it is a TGA, which has no magic number: by its header's fields.
// Source: Truevision, "TGA File Format Specification", version 2.0.
bool IsTga(std::span<const std::uint8_t> file);

// Part missing at the end of a PNG or JPEG file, or damaged within a JPEG, which decoders complete with grey; empty:
// nothing, and for other kinds. Bytes after the end are ignored: cameras pad their files.
std::string PictureEndProblem(std::span<const std::uint8_t> file);

// Problem of a whole OpenEXR file, by its header; empty: none. The library (3.1) allocates any attribute size that the
// header states, and tables for any height.
std::string ExrProblem(std::span<const std::uint8_t> file);

}  // namespace limits
