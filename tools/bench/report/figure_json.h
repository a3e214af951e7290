// Figures of a page as JSON, compact and safe inside HTML.
// Source: docs/report_data.md.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/bench/report/figure.h"

namespace vobench::report {

// {"format", "systems", "figures", "columns", and `more`'s members}; figures are named f0, f1, ... on the page. Text
// that is no UTF-8 is repaired; no "<" is left, so that no text can end the element that the JSON stands in.
std::string FiguresJson(const std::vector<std::string>& systems, const std::vector<Figure>& figures,
                        const nlohmann::ordered_json& more);

}  // namespace vobench::report
