#include "tools/report/plot.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "tools/report/text.h"
#include "tools/report/ticks.h"

namespace report {
namespace {

constexpr double kLeft = 52, kRight = 10, kTop = 24, kAxis = 34, kLegend = 16;  // room about the frame

using Map = std::function<double(double)>;

Map MapTo(const Axis& axis, Range range, double from, double to) {
  const auto position = [logarithmic = axis.logarithmic](double value) {
    return logarithmic ? std::log10(value) : value;
  };
  const double low = position(range.low), high = position(range.high);
  if (axis.reversed) std::swap(from, to);
  return [=](double value) { return from + (position(value) - low) / (high - low) * (to - from); };
}

bool Drawable(const Axis& axis, double value) { return std::isfinite(value) && (!axis.logarithmic || value > 0); }

// Far outside is as good as just outside, and keeps numbers short. 0.1 units is below what a screen shows.
std::string Coordinate(double value) {
  std::string text = Fixed(std::clamp(value, -9999.0, 9999.0), 1);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

// Of a series in time: at most the lowest and the highest point of each two units across, in order.
std::vector<std::size_t> ThinSeries(const std::vector<double>& px, const std::vector<double>& py) {
  std::vector<std::size_t> kept;
  const auto column = [&](std::size_t i) { return std::floor(px[i] / 2); };
  for (std::size_t begin = 0, end = 0; begin < px.size(); begin = end) {
    std::size_t low = begin, high = begin;
    for (end = begin; end < px.size() && column(end) == column(begin); ++end) {
      if (py[end] < py[low]) low = end;
      if (py[end] > py[high]) high = end;
    }
    kept.push_back(std::min(low, high));
    if (low != high) kept.push_back(std::max(low, high));
  }
  return kept;
}

// Of a path: without what is within half a unit of the last point kept; the last point stays.
std::vector<std::size_t> ThinPath(const std::vector<double>& px, const std::vector<double>& py) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < px.size(); ++i) {
    if (!kept.empty() && i + 1 < px.size() && std::hypot(px[i] - px[kept.back()], py[i] - py[kept.back()]) < 0.5)
      continue;
    kept.push_back(i);
  }
  return kept;
}

// Of 11 units' height, about.
double TextWidth(const std::string& text) {
  return 5.6 * static_cast<double>(std::count_if(text.begin(), text.end(), [](char letter) {
           return (static_cast<unsigned char>(letter) & 0xC0) != 0x80;
         }));
}

// By height, a line of text from each other, the lowest not below `bottom` (as long as there is room).
template <class Texts>
Texts Apart(Texts labels, double bottom) {
  constexpr double kLine = 12;
  std::stable_sort(labels.begin(), labels.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
  for (std::size_t i = 1; i < labels.size(); ++i) labels[i].y = std::max(labels[i].y, labels[i - 1].y + kLine);
  for (std::size_t i = labels.size(); i-- > 0;) {
    labels[i].y = std::min(labels[i].y, bottom - kLine * static_cast<double>(labels.size() - 1 - i));
  }
  return labels;
}

std::string PathData(const std::vector<double>& px, const std::vector<double>& py, bool series) {
  const std::vector<std::size_t> kept = series ? ThinSeries(px, py) : ThinPath(px, py);
  std::string data;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    data += i == 0 ? "M" : i == 1 ? "L" : " ";
    data += Coordinate(px[kept[i]]) + " " + Coordinate(py[kept[i]]);
  }
  return data;
}

}  // namespace

Plot::Plot(std::string title, std::string description, Axis x, Axis y, bool equal_scale)
    : title_(std::move(title)),
      description_(std::move(description)),
      x_axis_(std::move(x)),
      y_axis_(std::move(y)),
      equal_scale_(equal_scale) {}

void Plot::Line(const std::vector<double>& x, const std::vector<double>& y, const std::string& style,
                const std::string& label) {
  items_.push_back({Kind::line, x, y, {}, 0, style, label});
}

void Plot::Band(const std::vector<double>& x, const std::vector<double>& low, const std::vector<double>& high,
                const std::string& style, const std::string& label) {
  items_.push_back({Kind::band, x, low, high, 0, style, label});
}

void Plot::Dots(const std::vector<double>& x, const std::vector<double>& y, double radius, const std::string& style,
                const std::string& label) {
  items_.push_back({Kind::dots, x, y, {}, radius, style, label});
}

void Plot::Word(double x, double y, const std::string& style, const std::string& text) {
  words_.push_back({x, y, style, text});
}

void Plot::EndLabel(double y, const std::string& style, const std::string& text) {
  end_labels_.push_back({0, y, style, text});
}

std::string Plot::Svg(double width, double height) const {
  const bool legend = std::any_of(items_.begin(), items_.end(), [](const Item& item) { return !item.label.empty(); });
  double label_width = 0;
  for (const Text& label : end_labels_) label_width = std::max(label_width, 4 + 1.25 * TextWidth(label.text));  // bold
  const double left = kLeft, right = width - kRight - label_width;
  const double top = kTop + (legend ? kLegend : 0), bottom = height - kAxis;
  Range x_range = x_range_, y_range = y_range_;
  if (equal_scale_) {
    const double per_unit =
        std::min((right - left) / (x_range.high - x_range.low), (bottom - top) / (y_range.high - y_range.low));
    const auto widen = [&](Range& range, double room) {
      const double more = (room / per_unit - (range.high - range.low)) / 2;
      range = {range.low - more, range.high + more};
    };
    widen(x_range, right - left);
    widen(y_range, bottom - top);
  }
  const Map x = MapTo(x_axis_, x_range, left, right), y = MapTo(y_axis_, y_range, bottom, top);
  const auto c = [](double value) { return Coordinate(value); };

  std::string svg = "<svg viewBox=\"0 0 " + c(width) + " " + c(height) + "\" role=\"img\" aria-label=\"" +
                    Escape(title_ + ". " + description_) + "\"><text class=\"title\" x=\"" + c(left) + "\" y=\"14\">" +
                    Escape(title_) + "</text>";
  const auto text = [&](const char* style, double at_x, double at_y, const std::string& what) {
    svg += "<text class=\"" + std::string(style) + "\" x=\"" + c(at_x) + "\" y=\"" + c(at_y) + "\">" + Escape(what) +
           "</text>";
  };
  const auto marks = [&](const Axis& axis, Range range, double room) {
    const int wanted = std::max(2, static_cast<int>(room));
    if (!axis.marks.empty()) return axis.marks;
    return axis.logarithmic ? LogTicks(range.low, range.high, wanted) : LinearTicks(range.low, range.high, wanted);
  };
  svg += "<g class=\"grid\">";
  const auto x_marks = marks(x_axis_, x_range, (right - left) / 60),
             y_marks = marks(y_axis_, y_range, (bottom - top) / 32);
  std::string grid;
  for (const Tick& tick : x_marks) grid += "M" + c(x(tick.value)) + " " + c(top) + "V" + c(bottom);
  for (const Tick& tick : y_marks) grid += "M" + c(left) + " " + c(y(tick.value)) + "H" + c(right);
  svg += "<path d=\"" + grid + "\"/></g>";
  for (const Tick& tick : x_marks) text("tick mid", x(tick.value), bottom + 13, tick.text);
  for (const Tick& tick : y_marks) text("tick end", left - 4, y(tick.value) + 3.5, tick.text);
  text("label mid", (left + right) / 2, height - 5, x_axis_.label);
  svg += "<text class=\"label mid\" transform=\"translate(11 " + c((top + bottom) / 2) + ") rotate(-90)\">" +
         Escape(y_axis_.label) + "</text>";

  // A nested svg clips what leaves the frame, without names that would have to be unique on the page.
  svg += "<svg x=\"" + c(left) + "\" y=\"" + c(top) + "\" width=\"" + c(right - left) + "\" height=\"" +
         c(bottom - top) + "\" viewBox=\"" + c(left) + " " + c(top) + " " + c(right - left) + " " + c(bottom - top) +
         "\">";
  for (const Item& item : items_) {
    std::vector<double> px, py, ph;
    const auto flush = [&] {
      if (px.empty()) return;
      if (item.kind == Kind::line) {
        svg += "<path class=\"line " + item.style + "\" d=\"" + PathData(px, py, !equal_scale_) + "\"/>";
      } else {
        std::string data = PathData(px, py, !equal_scale_);
        std::vector<double> rx(px.rbegin(), px.rend()), rh(ph.rbegin(), ph.rend());
        std::string back = PathData(rx, rh, !equal_scale_);
        back[0] = 'L';
        svg += "<path class=\"area " + item.style + "\" d=\"" + data + back + "Z\"/>";
      }
      px.clear(), py.clear(), ph.clear();
    };
    if (item.kind == Kind::dots) {
      // One path of zero-length strokes with round ends: a dot costs a dozen bytes.
      std::string data;
      for (std::size_t i = 0; i < item.x.size(); ++i) {
        if (!Drawable(x_axis_, item.x[i]) || !Drawable(y_axis_, item.y[i])) continue;
        data += "M" + c(x(item.x[i])) + " " + c(y(item.y[i])) + "h0";
      }
      svg += "<path class=\"dots " + item.style + "\" stroke-width=\"" + c(2 * item.radius) + "\" d=\"" + data + "\"/>";
      continue;
    }
    for (std::size_t i = 0; i < item.x.size(); ++i) {
      const bool drawable = Drawable(x_axis_, item.x[i]) && Drawable(y_axis_, item.y[i]) &&
                            (item.kind == Kind::line || Drawable(y_axis_, item.high[i]));
      if (!drawable) {
        flush();
        continue;
      }
      px.push_back(x(item.x[i]));
      py.push_back(y(item.y[i]));
      if (item.kind == Kind::band) ph.push_back(y(item.high[i]));
    }
    flush();
  }
  svg += "</svg><path class=\"frame\" d=\"M" + c(left) + " " + c(top) + "V" + c(bottom) + "H" + c(right) + "\"/>";

  for (const Text& word : words_) text(("mid " + word.style).c_str(), x(word.x), y(word.y) - 2, word.text);
  std::vector<Text> labels = end_labels_;
  for (Text& label : labels) label.y = std::clamp(y(label.y), top, bottom);
  for (const Text& label : Apart(labels, bottom)) text(label.style.c_str(), right + 5, label.y + 3.5, label.text);

  double at = left;
  for (const Item& item : items_) {
    if (item.label.empty()) continue;
    const double row = kTop + 4;
    if (item.kind == Kind::line) {
      svg += "<path class=\"line " + item.style + "\" d=\"M" + c(at) + " " + c(row) + "h18\"/>";
    } else if (item.kind == Kind::band) {
      svg += "<path class=\"area " + item.style + "\" d=\"M" + c(at) + " " + c(row - 5) + "h18v10h-18Z\"/>";
    } else {
      svg += "<path class=\"dots " + item.style + "\" stroke-width=\"" + c(std::max(4.0, 2 * item.radius)) +
             "\" d=\"M" + c(at + 9) + " " + c(row) + "h0\"/>";
    }
    text("legend", at + 22, row + 3.5, item.label);
    at += 38 + TextWidth(item.label);
  }
  return svg + "</svg>";
}

Range RangeOf(const std::vector<std::vector<double>>& values, double margin, bool positive) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& series : values) {
    for (const double value : series) {
      if (!std::isfinite(value) || (positive && value <= 0)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (low > high) return positive ? Range{0.1, 10} : Range{0, 1};
  if (positive) {
    const double more = std::pow(10, margin * std::max(0.5, std::log10(high / low)));
    return {low / more, high * more};
  }
  const double size = high > low ? high - low : std::max(std::abs(high), 1.0);
  return {low - margin * size, high + margin * size};
}

}  // namespace report
