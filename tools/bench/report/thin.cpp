#include "tools/bench/report/thin.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

namespace vobench::report {
namespace {

constexpr std::size_t kLeast = 16;  // points of a series, however many there are

Numbers Pick(const Numbers& all, const std::vector<std::size_t>& indices) {
  Numbers picked;
  if (all.empty()) return picked;
  for (const std::size_t i : indices) picked.push_back(all[i]);
  return picked;
}

// Adds of [begin, end): the extremes, and the first without an answer.
void AddExtremes(const Series& series, std::size_t begin, std::size_t end, std::vector<std::size_t>& indices) {
  const auto stretch = [&](const Numbers& numbers) { return std::span(numbers).subspan(begin, end - begin); };
  const auto add = [&](auto at, auto first) { indices.push_back(begin + static_cast<std::size_t>(at - first)); };
  const auto low = stretch(series.y), high = stretch(series.high.empty() ? series.y : series.high);
  const auto before = [](auto less) {  // NaN comes last
    return [less](double a, double b) { return std::isnan(b) ? !std::isnan(a) : less(a, b); };
  };
  add(std::ranges::min_element(low, before(std::less())), low.begin());
  add(std::ranges::min_element(high, before(std::greater())), high.begin());
  const auto gap = std::ranges::find_if(low, [](double y) { return std::isnan(y); });
  if (gap != low.end()) add(gap, low.begin());
}

// Of [begin, end): the point farthest from the line between its ends.
void AddCorner(const Series& series, std::size_t begin, std::size_t end, std::vector<std::size_t>& indices) {
  const auto at = [&](std::size_t i, const Numbers& numbers) { return numbers.empty() ? 0.0 : numbers[i]; };
  double farthest = -1;
  std::size_t corner = begin;
  for (std::size_t i = begin; i < end; ++i) {
    const double share = static_cast<double>(i - begin) / std::max<double>(1, static_cast<double>(end - 1 - begin));
    double square = 0;
    for (const Numbers* numbers : {&series.x, &series.y, &series.z}) {
      const double straight = at(begin, *numbers) + share * (at(end - 1, *numbers) - at(begin, *numbers));
      square += std::pow(at(i, *numbers) - straight, 2);
    }
    if (!(square > farthest)) continue;
    farthest = square;
    corner = i;
  }
  indices.push_back(corner);
}

std::size_t Columns(const Series& series) { return 2 + !series.high.empty() + !series.z.empty() + !series.t.empty(); }

}  // namespace

Series Thin(const Series& series, bool is_path, std::size_t most) {
  const std::size_t size = series.x.size();
  if (size <= most) return series;
  const bool extremes = !is_path && (series.draw == Draw::line || series.draw == Draw::band);
  const std::size_t stretches = std::max<std::size_t>(1, extremes ? most / 2 : most);
  std::vector<std::size_t> indices;
  for (std::size_t k = 0; k < stretches; ++k) {
    const std::size_t begin = k * size / stretches, end = (k + 1) * size / stretches;
    if (begin == end) continue;
    if (extremes) {
      AddExtremes(series, begin, end, indices);
    } else if (is_path && series.draw == Draw::line) {
      AddCorner(series, begin, end, indices);
    } else {
      indices.push_back(begin);
    }
  }
  indices.push_back(size - 1);
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  Series thin = series;
  for (Numbers Series::*column : {&Series::x, &Series::y, &Series::high, &Series::z, &Series::t}) {
    thin.*column = Pick(series.*column, indices);
  }
  thin.notes.clear();
  for (const std::size_t i : indices) {
    if (!series.notes.empty()) thin.notes.push_back(series.notes[i]);
  }
  return thin;
}

std::size_t Count(const std::vector<Figure>& figures) {
  std::size_t count = 0;
  for (const Figure& figure : figures) {
    for (const Series& series : figure.series) count += Columns(series) * series.x.size();
  }
  return count;
}

std::vector<Figure> ThinTo(const std::vector<Figure>& figures, std::size_t numbers) {
  const auto thinned = [&](std::size_t most) {
    std::vector<Figure> thin = figures;
    for (Figure& figure : thin) {
      const bool is_path = figure.equal_scale || figure.kind == Figure::Kind::space;
      for (Series& series : figure.series) series = Thin(series, is_path, most);
    }
    return thin;
  };
  std::size_t longest = kLeast;
  for (const Figure& figure : figures) {
    for (const Series& series : figure.series) longest = std::max(longest, series.x.size());
  }
  // By a quarter each time: a thinned line has a little more or less than `most` points.
  std::vector<Figure> thin = figures;
  for (std::size_t most = longest; Count(thin) > numbers && most > kLeast;) {
    most = std::max(kLeast, most * 3 / 4);
    thin = thinned(most);
  }
  return thin;
}

}  // namespace vobench::report
