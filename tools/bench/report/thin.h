// Thinning of figures to a number of points, extremes kept.
#pragma once

#include <cstddef>
#include <vector>

#include "tools/bench/report/figure.h"

namespace vobench::report {

// At most about `most` points. Of a line or band the lowest and the highest of each stretch stay, and the first gap; of
// a path (equal scale or in space) the point farthest from the straight line through each stretch; of anything else
// every n-th. All of it where there are no more than `most`.
Series Thin(const Series& series, bool is_path, std::size_t most);

// Numbers in the figures.
std::size_t Count(const std::vector<Figure>& figures);

// Uniform thinning, as little as needed for at most `numbers` numbers in all.
std::vector<Figure> ThinTo(const std::vector<Figure>& figures, std::size_t numbers);

}  // namespace vobench::report
