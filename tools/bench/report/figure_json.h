// Figures of a page as JSON, compact and safe inside HTML.
// Source: docs/report_data.md.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/bench/report/figure.h"

namespace vobench::report {

// Columns of numbers, each once: little-endian floats of 32 bits in base64. A NaN is a NaN.
class Columns {
 public:
  // The number of the column in the JSON's "columns".
  std::size_t Add(const Numbers& numbers);
  const std::vector<std::string>& coded() const { return coded_; }

 private:
  std::vector<std::string> coded_;
};

// {"format", "systems", "figures", "columns", and `more`'s members}; figures are named f0, f1, ... on the page. Text
// that is no UTF-8 is repaired; no "<" is left, so that no text can end the element that the JSON stands in.
std::string FiguresJson(const std::vector<std::string>& systems, const std::vector<Figure>& figures,
                        const nlohmann::ordered_json& more);

}  // namespace vobench::report
