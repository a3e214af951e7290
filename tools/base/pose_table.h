// Tables of poses, one a line, in the order of columns that their header or their kind has.
// Source: the TUM RGB-D trajectory format; EuRoC's tables; what VINS, OpenVINS, ROS' exports, PlotJuggler and pandas
//         write.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/base/pose_header.h"
#include "tools/base/text.h"

namespace base {

class PoseTable {
 public:
  // is_euroc: whole stamps are nanoseconds and qw comes first, unless a header differs.
  explicit PoseTable(bool is_euroc = false) : is_euroc_(is_euroc) {}

  // The words `timestamp tx ty tz qx qy qz qw` of the next line, in this order; none of a line without a pose (empty, a
  // comment, a header). A row of another length is returned unchanged. problem: where the header, or the first row,
  // shows another kind of file or does not say which column is which, where a shorter row looks like a pose or one is
  // longer than the header, and where the second is more than 1000 s after the first.
  std::vector<Word> Row(std::string_view line, std::string& problem);
  // Of the last row's first word, in seconds.
  std::string Stamp(const Word& word) const;

 private:
  std::vector<Word> InOrder(std::vector<Word> words, std::string& problem);

  bool is_euroc_, is_first_ = true, w_is_first_ = false;
  std::optional<std::int64_t> first_ns_;  // before the second row
  std::string fraction_;                  // of the last row's stamp, where it has a column
  std::optional<PoseHeader> header_;
};

}  // namespace base
