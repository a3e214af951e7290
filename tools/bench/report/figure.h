// Figure of a report as values: axes with units, series of numbers; and as JSON, which tools/bench/report/web draws.
// Source: docs/report_data.md.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace vobench::report {

using Numbers = std::vector<double>;  // NaN: no answer, a gap in the line

struct Axis {
  std::string label;         // with the unit
  bool logarithmic = false;  // what is not positive is not drawn
  bool reversed = false;     // grows to the left, or downwards
  bool from_zero = false;    // zero belongs to it
  bool stress = false;       // marked at the doses of a campaign alone
  std::optional<double> low = {}, high = {};
};

enum class Draw {
  line,
  band,  // from y to high
  dots,
  bars,
  interval,  // from (x, y) to (high, y)
};

enum class Role {
  system,  // in the colour of its system
  truth,
  expected,  // expectation for a consistent filter
  context,   // grey
  warning,
};

struct Series {
  // In the legend; series of one name are shown and hidden together. Empty: always shown.
  std::string name;
  Draw draw = Draw::line;
  Role role = Role::system;
  std::size_t system = 0;  // of Role::system: 0, 1, ... as everywhere on the page
  bool faint = false;      // one of many runs
  Numbers x, y;
  Numbers high = {};                    // of bands and intervals
  Numbers z = {}, t = {};               // in space; seconds, shown with a point of a path
  std::vector<std::string> notes = {};  // shown with each point
};

// A system's line; a line in another role, with its name; the expectation for a consistent filter; one of many runs.
Series LineOf(const std::string& system, std::size_t number, Numbers x, Numbers y);
Series LineAs(Role role, const std::string& name, Numbers x, Numbers y);
Series Band(const std::string& name, Numbers x, Numbers low, Numbers high);
Series Faint(Series series);

struct Figure {
  enum class Kind {
    plane,
    space,  // x, y and z, to be turned
  };
  std::string title;
  std::string description;  // alternative text
  Kind kind = Kind::plane;
  Axis x, y;
  bool equal_scale = false;  // a metre is as long in both directions
  std::vector<Series> series;
  std::string up = "z";  // of Kind::space: "x", "-x", ... points up
};

// {"format", "systems", "figures", "columns", and `more`'s members}; figures are named f0, f1, ... on the page. Invalid
// UTF-8 is repaired; "<" is escaped, so that no text can end the element that contains the JSON.
std::string FiguresJson(const std::vector<std::string>& systems, const std::vector<Figure>& figures,
                        const nlohmann::ordered_json& more);

}  // namespace vobench::report
