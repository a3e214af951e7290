// Typical runs in time: errors after alignment, each component of the error with the filter's sigma bounds; features,
// map and time of each frame.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "tools/bench/report/figures.h"
#include "tools/bench/text.h"

namespace vobench::report {
namespace {

namespace ev = evaluation;

Axis FromZero(const std::string& label) { return {label, false, false, true}; }

Series SizeOfError(const ResultData& data, const RunData& run, std::size_t system, bool rotation) {
  const ev::Ate& ate = run.judged->metrics.errors.sim3;
  Numbers values = rotation ? ate.orientation_errors : ate.position_errors;
  for (double& value : values) value *= rotation ? kDegrees : kCentimetres;
  values.resize(run.judged->aligned.size(), std::numeric_limits<double>::quiet_NaN());
  return LineOf(run.entry.system, system, Times(data, run.judged->aligned), std::move(values));
}

// Three components of the error: its name, followed by x, y or z, and how it is shown.
struct ErrorKind {
  const char *name, *unit;
  double factor;
};
constexpr ErrorKind kErrorKinds[] = {{"position ", "cm", kCentimetres},
                                     {"orientation about camera ", "°", kDegrees},
                                     {"velocity ", "cm/s", kCentimetres},
                                     {"angular velocity about camera ", "°/s", kDegrees}};

// One component of the error, truth minus estimate, in a band of three sigma.
void AddErrorWithSigma(const ResultData& data, const std::string& system, std::size_t number, int component,
                       double factor, Figure& figure) {
  const RunData& run = data.Typical(system);
  if (!run.judged) return;
  Numbers t, error, low, high;
  for (const ev::FrameConsistency& frame : run.judged->consistency) {
    t.push_back(Seconds(data, frame.stamp_ns));
    error.push_back(factor * frame.error[component]);
    high.push_back(3 * factor * frame.sigma[component]);
    low.push_back(-high.back());
  }
  if (std::ranges::none_of(error, [](double value) { return std::isfinite(value); })) return;
  Series band = LineOf(system, number, t, low);
  band.draw = Draw::band;
  band.high = high;
  figure.series.push_back(band);
  figure.series.push_back(LineOf(system, number, t, error));
}

// Range of the errors, and of the bands as much as leaves the errors visible.
void SetReach(Figure& figure) {
  double largest_error = 0, largest_sigma = 0;
  for (const Series& series : figure.series) {
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!std::isfinite(series.y[i])) continue;
      double& largest = series.draw == Draw::line ? largest_error : largest_sigma;
      largest = std::max(largest, std::abs(series.y[i]));
    }
  }
  if (largest_sigma <= 6 * largest_error) return;  // all of it
  figure.y.high = 6 * largest_error;
  figure.y.low = -6 * largest_error;
}

// Of two of the kinds.
std::vector<Figure> ErrorFigures(const ResultData& data, int first_kind) {
  const std::vector<std::string> systems = data.Systems();
  std::vector<Figure> figures;
  for (int component = 3 * first_kind; component < 3 * first_kind + 6; ++component) {
    const ErrorKind& kind = kErrorKinds[component / 3];
    Figure figure =
        InTime(std::string("Error of ") + kind.name + "xyz"[component % 3],
               "Truth minus estimate in time, in a band of three standard deviations as the filter has them.",
               {std::string("error [") + kind.unit + "]"});
    for (std::size_t s = 0; s < systems.size(); ++s)
      AddErrorWithSigma(data, systems[s], s, component, kind.factor, figure);
    if (figure.series.empty()) continue;
    SetReach(figure);
    figures.push_back(figure);
  }
  return figures;
}

void AddFigures(const ResultData& data, std::size_t s, std::vector<Figure>& figures) {
  const std::string system = data.Systems()[s], name = DisplayName(system);
  const RunData& run = data.Typical(system);
  if (run.run.frames.empty()) return;
  const auto line = [&](Role role, const char* label, const auto& value, std::size_t colour) {
    Series series = LineAs(role, label, {}, {});
    series.system = colour;
    for (const ev::FrameRecord& frame : run.run.frames) {
      series.x.push_back(Seconds(data, frame.stamp_ns));
      series.y.push_back(std::invoke(value, frame));
    }
    return series;
  };
  using Frame = ev::FrameRecord;
  Figure features =
      InTime("Features of " + name, "Landmarks searched for and found in each frame.", FromZero("features"));
  features.series = {line(Role::context, "searched", &Frame::searched, s),
                     line(Role::system, "matched", &Frame::matched, s)};
  Series untracked = LineAs(Role::warning, "not tracked", {}, {});
  untracked.draw = Draw::dots;
  for (const Frame& frame : run.run.frames) {
    if (frame.tracked) continue;
    untracked.x.push_back(Seconds(data, frame.stamp_ns));
    untracked.y.push_back(frame.matched);
  }
  if (!untracked.x.empty()) features.series.push_back(untracked);
  Figure map = InTime("Map of " + name, "Landmarks in the map after each frame.", FromZero("landmarks"));
  map.series = {line(Role::context, "all", &Frame::landmarks, s),
                line(Role::system, "permanent", &Frame::permanent, s)};
  figures.push_back(features);
  figures.push_back(map);

  // A line for each part of the whole: by colour, of one system.
  Figure time =
      InTime("Time of " + name, "Milliseconds that each stage took, frame by frame.", FromZero("time per frame [ms]"));
  time.series = {line(Role::system, "features", &Frame::ms_features, 2),
                 line(Role::system, "matching", &Frame::ms_matching, 3),
                 line(Role::system, "filter", &Frame::ms_filter, 4)};
  const auto taken = [](const Frame& f) { return f.ms_features + f.ms_matching + f.ms_filter; };
  if (std::ranges::any_of(
          run.run.frames, [](double ms) { return ms > 0; }, taken))
    figures.push_back(time);
}

}  // namespace

std::vector<Figure> AlignedErrorFigures(const ResultData& data) {
  if (!AnyJudged(data)) return {};
  const std::vector<std::string> systems = data.Systems();
  std::vector<Figure> figures;
  for (const bool rotation : {false, true}) {
    Figure& figure = figures.emplace_back(
        InTime(rotation ? "Orientation error" : "Position error",
               "Distance between estimate and truth in time, after alignment by rotation, translation and scale.",
               FromZero(rotation ? "error [°]" : "error [cm]")));
    for (std::size_t s = 0; s < systems.size(); ++s) {
      for (const RunData* run : FaintRuns(data, systems[s])) {
        if (run->judged) figure.series.push_back(Faint(SizeOfError(data, *run, s, rotation)));
      }
    }
    for (std::size_t s = 0; s < systems.size(); ++s) {
      const RunData& typical = data.Typical(systems[s]);
      if (typical.judged) figure.series.push_back(SizeOfError(data, typical, s, rotation));
    }
  }
  std::erase_if(figures, [](const Figure& figure) {  // of an orientation that the alignment does not determine
    return std::ranges::all_of(figure.series, [](const Series& series) { return series.x.empty(); });
  });
  return figures;
}

std::vector<Figure> PoseErrorFigures(const ResultData& data) { return ErrorFigures(data, 0); }

std::vector<Figure> VelocityErrorFigures(const ResultData& data) { return ErrorFigures(data, 2); }

std::vector<Figure> FrameFigures(const ResultData& data) {
  std::vector<Figure> figures;
  for (std::size_t s = 0; s < data.Systems().size(); ++s) AddFigures(data, s, figures);
  return figures;
}

}  // namespace vobench::report
