#include "tools/report/figures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "tools/evaluation/nis.h"
#include "tools/evaluation/so3.h"
#include "tools/report/plot.h"
#include "tools/report/text.h"

namespace report {
namespace {

namespace ev = evaluation;
using Series = std::vector<double>;

constexpr double kDegrees = 180 / M_PI;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kPanelWidth = 420, kPanelHeight = 240, kPathHeight = 400;

// The trajectory that stands for a run in a drawing: aligned where there is a truth.
const ev::Trajectory& Drawn(const RunData& run) { return run.judged ? run.judged->aligned : run.run.trajectory; }

const RunData* AnyJudged(const ResultData& data) {
  const auto found = std::find_if(data.runs.begin(), data.runs.end(), [](const RunData& run) { return run.judged; });
  return found == data.runs.end() ? nullptr : &*found;
}

// The path that the drawn runs belong to: the truth, or where there is none the first run's own.
const ev::Trajectory& Reference(const ResultData& data) {
  const RunData& shown = data.Typical(data.Systems().front());
  if (shown.judged) return shown.judged->truth;
  const RunData* judged = AnyJudged(data);
  return judged ? judged->judged->truth : data.runs.front().run.trajectory;
}

// Time zero of every diagram: the first pose of the first run.
double Seconds(const ResultData& data, std::int64_t stamp_ns) {
  return static_cast<double>(stamp_ns - data.runs.front().run.trajectory.front().stamp_ns) * 1e-9;
}

Series Times(const ResultData& data, const ev::Trajectory& trajectory) {
  Series times;
  for (const ev::StampedPose& pose : trajectory) times.push_back(Seconds(data, pose.stamp_ns));
  return times;
}

Range TimeRange(const ResultData& data) {
  std::vector<Series> times;
  for (const RunData& run : data.runs) times.push_back(Times(data, run.run.trajectory));
  return RangeOf(times, 0.01);
}

std::string Figure(const std::string& svg) { return "<figure>" + svg + "</figure>\n"; }

// A view along a world axis: which way is right and which is up on the page.
struct View {
  std::string title;
  Eigen::Vector3d right, up;
};

std::string AxisName(const Eigen::Vector3d& axis) {
  int largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return std::string(1, "xyz"[largest]);
}

Axis WorldAxis(const Eigen::Vector3d& axis) { return {AxisName(axis) + " [m]", false, axis.sum() < 0}; }

// Coordinate along the axis's own positive direction; a reversed axis does the turning.
Series Along(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& axis) {
  Series values;
  for (const Eigen::Vector3d& p : points) values.push_back(p.dot(axis.cwiseAbs()));
  return values;
}

std::vector<Eigen::Vector3d> Positions(const ev::Trajectory& trajectory) {
  std::vector<Eigen::Vector3d> positions;
  for (const ev::StampedPose& pose : trajectory) positions.push_back(pose.p_WC);
  return positions;
}

// Cameras are mostly held upright: up is the world axis that is nearest to the mean of the images' upward direction.
std::vector<View> Views(const ev::Trajectory& trajectory) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const ev::StampedPose& pose : trajectory) mean -= pose.q_WC * Eigen::Vector3d::UnitY();
  int axis = 0;
  mean.cwiseAbs().maxCoeff(&axis);
  const Eigen::Vector3d up = (mean[axis] < 0 ? -1 : 1) * Eigen::Vector3d::Unit(axis);
  const Eigen::Vector3d right = Eigen::Vector3d::Unit(axis == 0 ? 1 : 0);
  // right x forward = up, seen from above.
  return {{"From above", right, up.cross(right)}, {"From the side", right, up}};
}

void DrawPaths(const ResultData& data, const View& view, Plot& plot, std::vector<Series>& x, std::vector<Series>& y) {
  const auto line = [&](const ev::Trajectory& trajectory, const std::string& style, const std::string& label) {
    const auto points = Positions(trajectory);
    x.push_back(Along(points, view.right));
    y.push_back(Along(points, view.up));
    plot.Line(x.back(), y.back(), style, label);
  };
  const std::vector<std::string> systems = data.Systems();
  const bool together = data.SharedTruth();
  for (std::size_t s = 0; together && s < systems.size(); ++s) {
    const RunData& typical = data.Typical(systems[s]);
    for (const RunData& run : data.runs) {
      if (run.entry.system == systems[s] && &run != &typical) line(Drawn(run), StyleOf(s) + " faint", "");
    }
  }
  if (AnyJudged(data)) line(Reference(data), "truth", "truth");
  for (std::size_t s = 0; s < systems.size(); ++s) {
    line(Drawn(data.Typical(systems[s])), StyleOf(s), DisplayName(systems[s]));
  }
}

// Landmarks in the world of the drawing, permanent ones only; at most 2000.
std::vector<Eigen::Vector3d> Map(const RunData& run) {
  std::vector<Eigen::Vector3d> points;
  for (const Landmark& landmark : run.landmarks) {
    if (!landmark.permanent) continue;
    const ev::StampedPose at{0, landmark.X_W, Eigen::Quaterniond::Identity()};
    points.push_back(run.judged ? ev::Apply(run.judged->metrics.errors.sim3.similarity, at).p_WC : at.p_WC);
  }
  const std::size_t every = (points.size() + 1999) / 2000;
  std::vector<Eigen::Vector3d> kept;
  for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(every, 1)) kept.push_back(points[i]);
  return kept;
}

// Without the outermost hundredth at either end: one landmark far away would shrink all the rest.
Series Core(Series values) {
  std::sort(values.begin(), values.end());
  const auto cut = static_cast<std::ptrdiff_t>(values.size() / 100);
  return {values.begin() + cut, values.end() - cut};
}

// Rotation vectors since the first pose, without jumps of a full turn [deg].
std::vector<Eigen::Vector3d> RotationsSince(const Eigen::Quaterniond& start, const ev::Trajectory& trajectory) {
  std::vector<Eigen::Vector3d> rotations;
  for (const ev::StampedPose& pose : trajectory) {
    Eigen::Vector3d phi = ev::Log(start.conjugate() * pose.q_WC);
    if (!rotations.empty() && phi.norm() > 0) {
      const Eigen::Vector3d& before = rotations.back();
      const Eigen::Vector3d other = phi - 2 * M_PI * phi.normalized();
      if ((other - before).norm() < (phi - before).norm()) phi = other;
    }
    rotations.push_back(phi);
  }
  for (Eigen::Vector3d& phi : rotations) phi *= kDegrees;
  return rotations;
}

Series Component(const std::vector<Eigen::Vector3d>& vectors, int k) {
  Series values;
  for (const Eigen::Vector3d& v : vectors) values.push_back(v[k]);
  return values;
}

// One error with its three sigma. The range is the errors' own, and the band's as far as that leaves them visible.
std::string ErrorWithSigma(const RunData& run, const std::string& style, int k, const char* name, const char* unit,
                           double factor) {
  Series t, error, low, high;
  for (const ev::FrameConsistency& frame : run.judged->consistency) {
    t.push_back(static_cast<double>(frame.stamp_ns - run.run.trajectory.front().stamp_ns) * 1e-9);
    error.push_back(factor * frame.error[k]);
    high.push_back(3 * factor * frame.sigma[k]);
    low.push_back(-high.back());
  }
  if (std::none_of(error.begin(), error.end(), [](double e) { return std::isfinite(e); })) return "";
  double largest_error = 0, largest_sigma = 0;
  for (std::size_t i = 0; i < error.size(); ++i) {
    if (std::isfinite(error[i])) largest_error = std::max(largest_error, std::abs(error[i]));
    largest_sigma = std::max(largest_sigma, high[i]);
  }
  const double reach = 1.08 * std::max({largest_error, std::min(largest_sigma, 6 * largest_error), 1e-12});
  const std::string title = std::string("Error of ") + name;
  Plot plot(title, "Truth minus estimate in time, with three standard deviations as the filter has them.", {"time [s]"},
            {std::string("error [") + unit + "]"});
  plot.Band(t, low, high, style, "±3σ");
  plot.Line(t, error, style + " solid", "error");
  plot.SetXRange(RangeOf({t}, 0.01));
  plot.SetYRange({-reach, reach});
  return Figure(plot.Svg(kPanelWidth, 190));
}

struct ErrorKind {
  int index;
  const char* name;
  const char* unit;
  double factor;
};

std::string ErrorFigures(const RunData& run, std::size_t system, const std::vector<ErrorKind>& kinds) {
  if (!run.judged || run.judged->consistency.empty()) return "";
  std::string html;
  for (const ErrorKind& kind : kinds) {
    html += ErrorWithSigma(run, StyleOf(system), kind.index, kind.name, kind.unit, kind.factor);
  }
  return html;
}

std::string NeesFigure(const ResultData& data, const std::string& title, double ev::FrameConsistency::*member,
                       int dof) {
  Plot plot(title,
            "Normalised estimation error squared in time, averaged over runs; an honest filter stays inside the band "
            "around 1 "
            "in 95 of 100 frames.",
            {"time [s]"}, {"NEES / " + std::to_string(dof), true});
  std::vector<Series> all;
  std::vector<std::function<void()>> lines;  // bands below lines below averages
  const std::vector<std::string> systems = data.Systems();
  std::map<int, bool> banded;
  for (std::size_t s = 0; s < systems.size(); ++s) {
    std::vector<std::vector<std::int64_t>> stamps;
    std::vector<Series> values;
    for (const RunData& run : data.runs) {
      if (run.entry.system != systems[s] || !run.judged || run.judged->consistency.empty()) continue;
      stamps.emplace_back();
      values.emplace_back();
      for (const ev::FrameConsistency& frame : run.judged->consistency) {
        stamps.back().push_back(frame.stamp_ns);
        values.back().push_back(frame.*member);
      }
    }
    const auto points = ev::Anees(stamps, values, dof);
    if (points.empty()) continue;
    Series t, anees, low, high;
    for (const ev::AneesPoint& point : points) {
      t.push_back(Seconds(data, point.stamp_ns));
      anees.push_back(point.anees / dof);
      low.push_back(point.band.low / dof);
      high.push_back(point.band.high / dof);
    }
    all.insert(all.end(), {anees, low, high});
    const int runs = static_cast<int>(values.size());
    if (!banded[runs])
      plot.Band(t, low, high, "limit", runs > 1 ? "95 % of " + std::to_string(runs) + " honest runs" : "95 %");
    banded[runs] = true;
    if (runs > 1) {
      for (std::size_t m = 0; m < values.size(); ++m) {
        Series own_t;
        for (const std::int64_t stamp : stamps[m]) own_t.push_back(Seconds(data, stamp));
        for (double& value : values[m]) value /= dof;
        all.push_back(values[m]);
        plot.Line(own_t, values[m], StyleOf(s) + " faint");
      }
    }
    lines.push_back([&plot, t, anees, s, name = systems[s]] { plot.Line(t, anees, StyleOf(s), DisplayName(name)); });
  }
  if (lines.empty()) return "";
  for (const auto& draw : lines) draw();
  plot.SetXRange(TimeRange(data));
  plot.SetYRange(RangeOf(all, 0.05, true));
  return Figure(plot.Svg(kPanelWidth, kPanelHeight));
}

}  // namespace

std::string StyleOf(std::size_t system) { return "s" + std::to_string(system % 5); }

std::string PathFigures(const ResultData& data) {
  const RunData* judged = AnyJudged(data);
  const std::vector<View> views = Views(Reference(data));
  const std::string described = judged ? "Truth and the estimates, aligned to it by rotation, translation and scale."
                                       : "The estimates, each in its own scale; there is no truth.";
  std::string html;
  for (const View& view : views) {
    Plot plot(view.title, described, WorldAxis(view.right), WorldAxis(view.up), true);
    std::vector<Series> x, y;
    DrawPaths(data, view, plot, x, y);
    plot.SetXRange(RangeOf(x, 0.08));
    plot.SetYRange(RangeOf(y, 0.08));
    html += Figure(plot.Svg(kPanelWidth, kPathHeight));
  }

  const View& above = views[0];
  Plot plot("From above, with permanent landmarks", described + " Dots are the landmarks of the final maps.",
            WorldAxis(above.right), WorldAxis(above.up), true);
  std::vector<Series> x, y;
  const std::vector<std::string> systems = data.Systems();
  bool any = false;
  for (std::size_t s = 0; s < systems.size(); ++s) {
    const auto points = Map(data.Typical(systems[s]));
    if (points.empty()) continue;
    any = true;
    const Series right = Along(points, above.right), up = Along(points, above.up);
    plot.Dots(right, up, 1.1, StyleOf(s), DisplayName(systems[s]) + ": " + std::to_string(points.size()));
    x.push_back(Core(right));
    y.push_back(Core(up));
  }
  if (any) {
    const auto path = Positions(Reference(data));
    x.push_back(Along(path, above.right));
    y.push_back(Along(path, above.up));
    plot.Line(x.back(), y.back(), "truth", judged ? "truth" : "path");
    plot.SetXRange(RangeOf(x));
    plot.SetYRange(RangeOf(y));
    html += Figure(plot.Svg(kPanelWidth, kPathHeight));
  }
  return html;
}

std::string PoseFigures(const ResultData& data) {
  const std::vector<std::string> systems = data.Systems();
  const Eigen::Quaterniond start = Reference(data).front().q_WC;
  std::string html;
  for (const bool rotation : {false, true}) {
    const auto values = [&](const ev::Trajectory& trajectory) {
      return rotation ? RotationsSince(start, trajectory) : Positions(trajectory);
    };
    for (int k = 0; k < 3; ++k) {
      const std::string name(1, "xyz"[k]);
      Plot plot(rotation ? "Rotation about camera " + name + " since the start" : "Position " + name,
                "Truth and the typical run of each system, aligned, in time.", {"time [s]"},
                {rotation ? "rotation [°]" : name + " [m]"});
      std::vector<Series> all;
      const auto line = [&](const ev::Trajectory& trajectory, const std::string& style, const std::string& label) {
        all.push_back(Component(values(trajectory), k));
        plot.Line(Times(data, trajectory), all.back(), style, label);
      };
      if (AnyJudged(data)) line(Reference(data), "truth", "truth");
      for (std::size_t s = 0; s < systems.size(); ++s) {
        line(Drawn(data.Typical(systems[s])), StyleOf(s), DisplayName(systems[s]));
      }
      plot.SetXRange(TimeRange(data));
      plot.SetYRange(RangeOf(all));
      html += Figure(plot.Svg(kPanelWidth, kPanelHeight));
    }
  }
  return html;
}

std::string AlignedErrorFigures(const ResultData& data) {
  if (!AnyJudged(data)) return "";
  const std::vector<std::string> systems = data.Systems();
  std::string html;
  for (const bool rotation : {false, true}) {
    Plot plot(rotation ? "Orientation error" : "Position error",
              "Distance between estimate and truth in time, after alignment by rotation, translation and scale.",
              {"time [s]"}, {rotation ? "error [°]" : "error [cm]"});
    std::vector<Series> all;
    const auto line = [&](const RunData& run, const std::string& style, const std::string& label) {
      const ev::Ate& ate = run.judged->metrics.errors.sim3;
      Series values = rotation ? ate.orientation_errors : ate.position_errors;
      for (double& value : values) value *= rotation ? kDegrees : 100;
      values.resize(run.judged->aligned.size(), kNaN);
      all.push_back(values);
      plot.Line(Times(data, run.judged->aligned), values, style, label);
    };
    for (std::size_t s = 0; s < systems.size(); ++s) {
      const RunData& typical = data.Typical(systems[s]);
      for (const RunData& run : data.runs) {
        if (run.judged && run.entry.system == systems[s] && &run != &typical) line(run, StyleOf(s) + " faint", "");
      }
    }
    for (std::size_t s = 0; s < systems.size(); ++s) {
      const RunData& typical = data.Typical(systems[s]);
      if (typical.judged) line(typical, StyleOf(s), DisplayName(systems[s]));
    }
    plot.SetXRange(TimeRange(data));
    plot.SetYRange({0, RangeOf(all).high});
    html += Figure(plot.Svg(kPanelWidth, kPanelHeight));
  }
  return html;
}

std::string PoseErrorFigures(const RunData& run, std::size_t system) {
  return ErrorFigures(run, system,
                      {{0, "position x", "cm", 100},
                       {1, "position y", "cm", 100},
                       {2, "position z", "cm", 100},
                       {3, "orientation about camera x", "°", kDegrees},
                       {4, "orientation about camera y", "°", kDegrees},
                       {5, "orientation about camera z", "°", kDegrees}});
}

std::string VelocityErrorFigures(const RunData& run, std::size_t system) {
  return ErrorFigures(run, system,
                      {{6, "velocity x", "cm/s", 100},
                       {7, "velocity y", "cm/s", 100},
                       {8, "velocity z", "cm/s", 100},
                       {9, "angular velocity about camera x", "°/s", kDegrees},
                       {10, "angular velocity about camera y", "°/s", kDegrees},
                       {11, "angular velocity about camera z", "°/s", kDegrees}});
}

std::string NeesFigures(const ResultData& data) {
  return NeesFigure(data, "NEES of the pose", &ev::FrameConsistency::nees_pose, 6) +
         NeesFigure(data, "NEES of the pose, blind to scale", &ev::FrameConsistency::nees_pose_scale_free, 5) +
         NeesFigure(data, "NEES of the velocity", &ev::FrameConsistency::nees_velocity, 6);
}

std::string NisFigures(const ResultData& data) {
  std::string html;
  const std::vector<std::string> systems = data.Systems();
  for (std::size_t s = 0; s < systems.size(); ++s) {
    const RunData& run = data.Typical(systems[s]);
    Series t, nis, low, high;
    std::map<int, ev::Band> bands;
    for (const ev::FrameRecord& frame : run.run.frames) {
      t.push_back(Seconds(data, frame.stamp_ns));
      if (frame.nis_dof <= 0) {
        for (Series* series : {&nis, &low, &high}) series->push_back(kNaN);
        continue;
      }
      if (!bands.contains(frame.nis_dof)) bands[frame.nis_dof] = ev::Chi2MeanBand(frame.nis_dof, 1);
      nis.push_back(frame.nis / frame.nis_dof);
      low.push_back(bands[frame.nis_dof].low / frame.nis_dof);
      high.push_back(bands[frame.nis_dof].high / frame.nis_dof);
    }
    if (bands.empty()) continue;
    Plot plot("NIS of " + DisplayName(systems[s]),
              "Normalised innovation squared in time, with the band that 95 of 100 honest frames fall in.",
              {"time [s]"}, {"NIS / dof"});
    plot.Band(t, low, high, "limit", "95 %");
    plot.Line(t, nis, StyleOf(s) + " solid", DisplayName(systems[s]));
    plot.SetXRange(TimeRange(data));
    plot.SetYRange({0, std::max(RangeOf({nis, high}).high, 1.5)});
    html += Figure(plot.Svg(kPanelWidth, kPanelHeight));
  }
  return html;
}

std::string FeatureFigures(const ResultData& data) {
  std::string html;
  const std::vector<std::string> systems = data.Systems();
  for (std::size_t s = 0; s < systems.size(); ++s) {
    const RunData& run = data.Typical(systems[s]);
    if (run.run.frames.empty()) continue;
    Series t, searched, matched, landmarks, permanent, coasted;
    for (const ev::FrameRecord& frame : run.run.frames) {
      t.push_back(Seconds(data, frame.stamp_ns));
      searched.push_back(frame.searched);
      matched.push_back(frame.matched);
      landmarks.push_back(frame.landmarks);
      permanent.push_back(frame.permanent);
      coasted.push_back(frame.tracked ? kNaN : 0);
    }
    const std::string name = DisplayName(systems[s]);
    Plot features("Features of " + name, "Landmarks searched for and found in each frame.", {"time [s]"}, {"features"});
    features.Line(t, searched, "grey", "searched");
    features.Line(t, matched, StyleOf(s) + " solid", "matched");
    if (std::any_of(coasted.begin(), coasted.end(), [](double v) { return v == 0; })) {
      features.Dots(t, coasted, 2.5, "warn", "coasted");
    }
    Plot map("Map of " + name, "Landmarks in the map after each frame.", {"time [s]"}, {"landmarks"});
    map.Line(t, landmarks, "grey", "all");
    map.Line(t, permanent, StyleOf(s) + " solid", "permanent");
    for (const auto& [plot, series] : {std::pair{&features, &searched}, std::pair{&map, &landmarks}}) {
      plot->SetXRange(TimeRange(data));
      const double high = std::max(RangeOf({*series, matched}).high, 1.0);
      plot->SetYRange({-0.03 * high, high});
      html += Figure(plot->Svg(kPanelWidth, kPanelHeight));
    }
  }
  return html;
}

}  // namespace report
