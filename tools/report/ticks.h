// Purpose: where an axis is marked, and with what text.
#pragma once

#include <string>
#include <vector>

namespace report {

struct Tick {
  double value = 0;
  std::string text;
};

// About `wanted` round values (1, 2 or 5 times a power of ten apart) inside [low, high].
std::vector<Tick> LinearTicks(double low, double high, int wanted);

// Powers of ten inside [low, high], both > 0; thinned to about `wanted`, with 2 and 5 between where there are few.
std::vector<Tick> LogTicks(double low, double high, int wanted);

}  // namespace report
