// Values that a settings file gives as distributions.
#include <algorithm>
#include <cmath>

#include "tools/base/settings/state.h"

namespace settings {
namespace {

struct Drawing {
  const std::function<double(std::string_view)>& uniform;
  std::vector<Problem>& problems;
  std::vector<std::pair<std::string, std::string>>& drawn;

  void Walk(const std::string& path, Element& element) {
    if (element.kind == Element::Kind::map && element.entries.size() == 1 && Draw(path, element)) return;
    const std::string prefix = path.empty() ? "" : path + ".";
    for (Entry& entry : element.entries) Walk(prefix + entry.key, entry.value);
    for (std::size_t i = 0; i < element.items.size(); ++i) Walk(prefix + std::to_string(i), element.items[i]);
  }

  // Whether the element is a distribution; it is replaced by the drawn value.
  bool Draw(const std::string& path, Element& element) {
    const std::string name = element.entries[0].key;
    if (name != "uniform" && name != "log_uniform" && name != "one_of") return false;
    Element of = std::move(element.entries[0].value);
    const auto refuse = [&](const std::string& why) {
      problems.push_back(element.place.AsProblem("'" + path + "': " + name + ": " + why));
    };
    element = {Element::Kind::null, element.place, "", {}, {}};
    if (of.kind != Element::Kind::list || of.items.empty()) {
      refuse("expected a list, not " + Describe(of));
    } else if (name == "one_of") {
      const auto n = static_cast<double>(of.items.size());
      element = std::move(of.items[static_cast<std::size_t>(uniform(path) * n)]);
      Walk(path, element);
    } else if (double from = 0, to = 0; Bounds(of, from, to, element.text)) {
      const double u = uniform(path);
      if (name == "log_uniform" && !(from > 0)) return refuse("expected bounds above 0"), true;
      const double value = name == "uniform" ? from + u * (to - from) : from * std::pow(to / from, u);
      element.text = FormatNumber(std::clamp(value, from, to)) + element.text;
      element.kind = Element::Kind::scalar;
    } else {
      refuse("expected two numbers of one unit, the smaller first, not " + Flow(of));
    }
    drawn.emplace_back(path, element.kind == Element::Kind::scalar ? element.text : Flow(element));
    return true;
  }

  static bool Bounds(const Element& of, double& from, double& to, std::string& unit) {
    std::string other;
    return of.items.size() == 2 && SplitQuantity(of.items[0].text, from, unit) &&
           SplitQuantity(of.items[1].text, to, other) && unit == other && from <= to;
  }
};

}  // namespace

std::vector<std::pair<std::string, std::string>> Document::Draw(
    const std::function<double(std::string_view path)>& uniform) {
  std::vector<std::pair<std::string, std::string>> drawn;
  Drawing{uniform, state_->problems, drawn}.Walk("", state_->root);
  return drawn;
}

}  // namespace settings
