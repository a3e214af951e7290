#include "tools/report/ticks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace report {
namespace {

std::string Text(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value == 0 ? 0.0 : value);
  // A true minus sign is as wide as the digits.
  return text[0] == '-' ? "−" + std::string(text + 1) : std::string(text);
}

}  // namespace

std::vector<Tick> LinearTicks(double low, double high, int wanted) {
  if (!(high > low) || wanted < 1) return {};
  // The widest round step that still gives half of the marks wanted, and three at the least.
  const double size = high - low, enough = std::max(3.0, 0.5 * wanted);
  double power = std::pow(10, std::floor(std::log10(size)));
  double step = power;
  const auto count = [&](double s) { return std::floor(high / s + 1e-9) - std::ceil(low / s - 1e-9) + 1; };
  for (bool found = false; !found; power /= 10) {
    for (const double factor : {5.0, 2.0, 1.0}) {
      step = factor * power;
      found = count(step) >= enough;
      if (found) break;
    }
  }
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  std::vector<Tick> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) {
    ticks.push_back({k * step, Text(k * step, decimals)});
  }
  return ticks;
}

std::vector<Tick> LogTicks(double low, double high, int wanted) {
  if (!(low > 0) || !(high > low) || wanted < 1) return {};
  const int first = static_cast<int>(std::floor(std::log10(low)));
  const int last = static_cast<int>(std::ceil(std::log10(high)));
  const bool few = std::log10(high / low) < 2;
  const int every = std::max(1, static_cast<int>(std::ceil(std::log10(high / low) / wanted)));
  std::vector<Tick> ticks;
  for (int exponent = first; exponent <= last; ++exponent) {
    if (exponent % every != 0) continue;
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double value = factor * std::pow(10, exponent);
      if ((factor > 1 && !few) || value < low * (1 - 1e-9) || value > high * (1 + 1e-9)) continue;
      std::string text;
      if (exponent >= 0 && exponent <= 4) {
        text = Text(value, 0);
      } else if (exponent < 0 && exponent >= -3) {
        text = Text(value, -exponent);
      } else {
        text = (factor > 1 ? Text(factor, 0) : "1") + "e" + std::to_string(exponent);
      }
      ticks.push_back({value, text});
    }
  }
  return ticks;
}

}  // namespace report
