#include "tools/bench/campaign/curve_spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace vobench::campaign {
namespace {

using settings::Range;
using settings::Section;
using settings::Unit;

constexpr Unit kUnits[] = {Unit::none,
                           Unit::time,
                           Unit::length,
                           Unit::angle,
                           Unit::speed,
                           Unit::frequency,
                           Unit::angular_rate,
                           Unit::rate,
                           Unit::pixel,
                           Unit::electrons,
                           Unit::electron_rate,
                           Unit::acceleration_density,
                           Unit::angular_acceleration_density};

bool Contains(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

// All levels as numbers of one kind, in SI; nothing where they are none.
std::vector<double> NumbersOf(const Factor& factor) {
  for (const Unit unit : kUnits) {
    std::vector<double> numbers;
    for (const Level& level : factor.levels) {
      std::string problem;
      double value = 0;
      if (settings::ParseQuantity(level.name, unit, {}, value, problem)) numbers.push_back(value);
    }
    if (numbers.size() == factor.levels.size()) return numbers;
  }
  return {};
}

bool InOrder(const std::vector<double>& doses) {
  const auto rises = [](double a, double b) { return a >= b; };
  const auto falls = [](double a, double b) { return a <= b; };
  return std::adjacent_find(doses.begin(), doses.end(), rises) == doses.end() ||
         std::adjacent_find(doses.begin(), doses.end(), falls) == doses.end();
}

// The unit in which the last level (the first may be 0) is written.
void ReadUnit(const Factor& factor, CurveSpec& curve) {
  const std::string& text = factor.levels.back().name;
  const std::size_t space = text.find(' ');
  double number = 0;
  std::string problem;
  if (space == std::string::npos || !settings::ParseQuantity(text.substr(0, space), Unit::none, {}, number, problem) ||
      number == 0) {
    return;
  }
  curve.unit = text.substr(space + 1);
  curve.unit_in_si = curve.doses.back() / number;
}

void ReadDoses(Section& section, const Campaign& campaign, CurveSpec& curve) {
  const auto factor = std::find_if(campaign.factors.begin(), campaign.factors.end(),
                                   [&](const Factor& f) { return f.name == curve.along; });
  if (factor == campaign.factors.end()) {
    std::vector<std::string> names;
    for (const Factor& f : campaign.factors) names.push_back(f.name);
    section.Reject("along", fmt::format("'along': nothing that is varied is called '{}'; there are: {}", curve.along,
                                        fmt::join(names, ", ")));
    return;
  }
  curve.doses = NumbersOf(*factor);
  if (curve.doses.size() < 2) {
    section.Reject("along",
                   fmt::format("'along': the values of '{}' are not two or more numbers of one kind", curve.along));
  } else if (!InOrder(curve.doses)) {
    section.Reject("along", fmt::format("'along': the values of '{}' neither rise nor fall: they are in the order of "
                                        "stress, the mildest first",
                                        curve.along));
  } else {
    ReadUnit(*factor, curve);
  }
}

}  // namespace

std::vector<CurveSpec> ReadCurves(Section root, const Campaign& campaign, const std::vector<std::string>& metrics) {
  std::vector<CurveSpec> curves;
  for (Section& section : root.List("curves")) {
    CurveSpec& curve = curves.emplace_back();
    if (section.Require("along", curve.along)) ReadDoses(section, campaign, curve);
    section.Require("of", curve.metrics);
    if (section.Has("of") && curve.metrics.empty()) section.Reject("of", "'of': at least one metric is needed");
    std::set<std::string> used;
    for (const std::string& metric : curve.metrics) {
      if (!Contains(metrics, metric)) {
        section.Reject("of", fmt::format("there is no metric '{}'; there are {}", metric, fmt::join(metrics, ", ")));
      }
      if (!used.insert(metric).second) section.Reject("of", fmt::format("'of': '{}' is there twice", metric));
    }
    std::vector<std::string> others = {"scenario"};
    for (const Factor& factor : campaign.factors) {
      if (factor.name != curve.along) others.push_back(factor.name);
    }
    curve.by = others;
    section.Read("by", curve.by);
    for (const std::string& name : curve.by) {
      if (!Contains(others, name)) {
        section.Reject("by", fmt::format("'by': there is no '{}'; there are {}", name, fmt::join(others, ", ")));
      }
      if (!used.insert(name).second) section.Reject("by", fmt::format("'by': '{}' is there twice", name));
    }
    section.Child("break_at").Read("error", curve.break_error_m, Unit::length, Range::AtLeast(0));
  }
  return curves;
}

}  // namespace vobench::campaign
