// Errors in time: their size after alignment, and each component beside what the filter claims.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/bench/report/drawn_runs.h"
#include "tools/bench/report/figures.h"
#include "tools/bench/text.h"

namespace vobench::report {
namespace {

namespace ev = evaluation;

Series SizeOfError(const ResultData& data, const RunData& run, std::size_t system, bool rotation) {
  const ev::Ate& ate = run.judged->metrics.errors.sim3;
  Numbers values = rotation ? ate.orientation_errors : ate.position_errors;
  for (double& value : values) value *= rotation ? kDegrees : kCentimetres;
  values.resize(run.judged->aligned.size(), std::numeric_limits<double>::quiet_NaN());
  return LineOf(run.entry.system, system, Times(data, run.judged->aligned), std::move(values));
}

struct ErrorKind {
  int index;
  const char* name;
  const char* unit;
  double factor;
};

// One component of the error, truth minus estimate, in a band of three sigma.
void AddErrorWithSigma(const ResultData& data, const RunData& run, std::size_t system, const ErrorKind& kind,
                       Figure& figure) {
  if (!run.judged) return;
  Series error = LineOf(run.entry.system, system, {}, {});
  Numbers high, low;
  bool any = false;
  for (const ev::FrameConsistency& frame : run.judged->consistency) {
    error.x.push_back(Seconds(data, frame.stamp_ns));
    error.y.push_back(kind.factor * frame.error[kind.index]);
    high.push_back(3 * kind.factor * frame.sigma[kind.index]);
    low.push_back(-high.back());
    any |= std::isfinite(error.y.back());
  }
  if (!any) return;
  Series band = error;
  band.draw = Draw::band;
  band.y = low;
  band.high = high;
  figure.series.push_back(band);
  figure.series.push_back(error);
}

// The errors' own range, and of the bands as much as leaves the errors visible.
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

std::vector<Figure> ErrorFigures(const ResultData& data, const std::vector<ErrorKind>& kinds) {
  const std::vector<std::string> systems = data.Systems();
  std::vector<Figure> figures;
  for (const ErrorKind& kind : kinds) {
    Figure figure;
    figure.title = std::string("Error of ") + kind.name;
    figure.description = "Truth minus estimate in time, in a band of three standard deviations as the filter has them.";
    figure.x.label = "time [s]";
    figure.y.label = std::string("error [") + kind.unit + "]";
    for (std::size_t s = 0; s < systems.size(); ++s) {
      AddErrorWithSigma(data, data.Typical(systems[s]), s, kind, figure);
    }
    if (figure.series.empty()) continue;
    SetReach(figure);
    figures.push_back(figure);
  }
  return figures;
}

}  // namespace

std::vector<Figure> AlignedErrorFigures(const ResultData& data) {
  if (!AnyJudged(data)) return {};
  const std::vector<std::string> systems = data.Systems();
  std::vector<Figure> figures;
  for (const bool rotation : {false, true}) {
    Figure& figure = figures.emplace_back();
    figure.title = rotation ? "Orientation error" : "Position error";
    figure.description =
        "Distance between estimate and truth in time, after alignment by rotation, translation and scale.";
    figure.x.label = "time [s]";
    figure.y = {rotation ? "error [°]" : "error [cm]", false, false, true};
    for (std::size_t s = 0; s < systems.size(); ++s) {
      for (const RunData* run : FaintRuns(data, systems[s])) {
        if (!run->judged) continue;
        figure.series.push_back(SizeOfError(data, *run, s, rotation));
        figure.series.back().faint = true;
      }
    }
    for (std::size_t s = 0; s < systems.size(); ++s) {
      const RunData& typical = data.Typical(systems[s]);
      if (typical.judged) figure.series.push_back(SizeOfError(data, typical, s, rotation));
    }
  }
  return figures;
}

std::vector<Figure> PoseErrorFigures(const ResultData& data) {
  return ErrorFigures(data, {{0, "position x", "cm", kCentimetres},
                             {1, "position y", "cm", kCentimetres},
                             {2, "position z", "cm", kCentimetres},
                             {3, "orientation about camera x", "°", kDegrees},
                             {4, "orientation about camera y", "°", kDegrees},
                             {5, "orientation about camera z", "°", kDegrees}});
}

std::vector<Figure> VelocityErrorFigures(const ResultData& data) {
  return ErrorFigures(data, {{6, "velocity x", "cm/s", kCentimetres},
                             {7, "velocity y", "cm/s", kCentimetres},
                             {8, "velocity z", "cm/s", kCentimetres},
                             {9, "angular velocity about camera x", "°/s", kDegrees},
                             {10, "angular velocity about camera y", "°/s", kDegrees},
                             {11, "angular velocity about camera z", "°/s", kDegrees}});
}

}  // namespace vobench::report
