// Header of a table of poses: which column holds which of timestamp tx ty tz qx qy qz qw, and the unit of its stamps.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/base/text.h"

namespace base {

// Cells of a line: what commas or semicolons outside of double quotes separate where it has seven and more, without
// blanks and quotes about them (some may be empty, the last is not); else its words.
std::vector<Word> Cells(std::string_view line);

// Whether a comment says that a quaternion begins with w.
bool StatesRealPartFirst(std::string_view comment);

// Whether it says that poses map the world to the camera.
bool StatesInverse(std::string_view comment);

struct PoseHeader {
  static constexpr std::size_t kPose = 8;
  std::array<std::size_t, kPose> columns{};
  std::size_t count = 0;                     // of named columns
  bool is_prose = false;                     // words, of which the eight follow each other: those of a row of eight
  int exponent = 0;                          // of a stamp's unit, in powers of ten: -9 for nanoseconds
  std::optional<std::size_t> fraction = {};  // column of a stamp's part below a second, where it has its own
  std::size_t fraction_digits = 9;           // of its unit: nano-, micro- or milliseconds
};

// None for a comment. problem: a header that names some columns of a pose, and not all, or two poses.
std::optional<PoseHeader> ReadPoseHeader(std::string_view line, std::string& problem);

}  // namespace base
