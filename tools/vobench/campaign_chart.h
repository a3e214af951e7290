// Purpose: curves.svg: a row for each curve, with a diagram for each metric and one for the share of runs broken. A
// file
//          of its own, readable in light and dark.
#pragma once

#include <string>
#include <vector>

#include "tools/campaign/curves.h"

namespace vobench {

// The dose grows harder to the right, logarithmic where doses are geometric; metrics are logarithmic where they span a
// factor of ten. Bands are the bootstrap intervals (up to the frame where they have no end), small dots the runs, "×2"
// two lost ones; on the right, the dose that breaks half of the runs is a large dot with its interval as a bar.
std::string CurvesSvg(const std::vector<campaign::Curve>& curves);

}  // namespace vobench
