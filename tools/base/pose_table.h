// Tables of poses, one a line, in the order of columns that their header or their kind has.
// Source: the TUM RGB-D trajectory format; EuRoC's tables; what VINS, OpenVINS, `rostopic echo -p` and pandas write.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/base/text.h"

namespace base {

class PoseTable {
 public:
  // is_euroc: whole stamps are nanoseconds and qw comes first, unless a header differs.
  explicit PoseTable(bool is_euroc = false) : is_euroc_(is_euroc) {}

  // The words `timestamp tx ty tz qx qy qz qw` of the next line, in this order; none of a line without a pose (empty, a
  // comment, a header). A row of another length is returned unchanged. problem: where the first row shows another kind
  // of file.
  std::vector<Word> Row(std::string_view line, std::string& problem);
  // Of a row's first word, in seconds.
  std::string Stamp(const Word& word) const;

 private:
  void ReadHeader(std::string_view line);

  bool is_euroc_, is_first_ = true;
  std::optional<std::array<std::size_t, 8>> columns_;  // of the row's words, by the header
  std::size_t column_count_ = 0;                       // that the header names
};

}  // namespace base
