// Purpose: one diagram as inline SVG: axes with units and marks, lines, bands and dots, clipped to the frame. Colours
// come from
//          the page's style sheet by class, so that one drawing serves light and dark.
#pragma once

#include <string>
#include <vector>

#include "tools/report/ticks.h"

namespace report {

struct Range {
  double low = 0, high = 1;
};

struct Axis {
  std::string label;  // with the unit
  bool logarithmic = false;
  // Marks count downwards: the value at the bottom (or left) is Range::high.
  bool reversed = false;
  std::vector<Tick> marks = {};  // none: round values
};

class Plot {
 public:
  // `title` stands above; `description` is what someone hears who does not see the diagram. Equal scale makes a metre
  // as long in both directions (the ranges are widened).
  Plot(std::string title, std::string description, Axis x, Axis y, bool equal_scale = false);

  // Style classes are those of the page: "truth", "s0" ... "s4", "faint", "band", "limit". NaN interrupts a line; on a
  // logarithmic axis so does a value that is not positive. Points that a screen could not tell apart are left out: of a
  // series the lowest and the highest stay in each two units across, of a path (equal scale) one in half a unit. Lines,
  // bands and dots that have a label appear in the legend.
  void Line(const std::vector<double>& x, const std::vector<double>& y, const std::string& style,
            const std::string& label = "");
  void Band(const std::vector<double>& x, const std::vector<double>& low, const std::vector<double>& high,
            const std::string& style, const std::string& label = "");
  void Dots(const std::vector<double>& x, const std::vector<double>& y, double radius, const std::string& style,
            const std::string& label = "");

  // A word in the middle above a point.
  void Word(double x, double y, const std::string& style, const std::string& text);
  // The name of a line right of the frame, at this height; names that would overlap are moved apart.
  void EndLabel(double y, const std::string& style, const std::string& text);

  void SetXRange(Range range) { x_range_ = range; }
  void SetYRange(Range range) { y_range_ = range; }

  // The ranges must have been set. Width and height in units of the drawing; text is 11 units high.
  std::string Svg(double width, double height) const;

 private:
  enum class Kind { line, band, dots };
  struct Item {
    Kind kind;
    std::vector<double> x, y, high;
    double radius = 0;
    std::string style, label;
  };

  struct Text {
    double x, y;
    std::string style, text;
  };

  std::string title_, description_;
  Axis x_axis_, y_axis_;
  bool equal_scale_;
  Range x_range_, y_range_;
  std::vector<Item> items_;
  std::vector<Text> words_, end_labels_;
};

// Smallest range that holds all finite values, widened by `margin` of its size; {0, 1} when there are none. `positive`
// leaves out what a logarithmic axis cannot show and widens by that share of the decades.
Range RangeOf(const std::vector<std::vector<double>>& values, double margin = 0.05, bool positive = false);

}  // namespace report
