// Paths in space.
#include <algorithm>
#include <cmath>

#include "tools/bench/report/figures.h"
#include "tools/bench/text.h"

namespace vobench::report {
namespace {

namespace ev = evaluation;
using Points = std::vector<Eigen::Vector3d>;

constexpr std::size_t kLandmarks = 2000;

Points Positions(const ev::Trajectory& trajectory) {
  Points positions;
  for (const ev::StampedPose& pose : trajectory) positions.push_back(pose.p_WC);
  return positions;
}

Numbers Component(const Points& points, int k) {
  Numbers values;
  for (const Eigen::Vector3d& p : points) values.push_back(p[k]);
  return values;
}

int AxisOf(const Eigen::Vector3d& direction) {
  int largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  return largest;
}

// Cameras are mostly held upright: up is the world axis that is nearest to the mean of the images' upward direction.
Eigen::Vector3d UpOf(const ev::Trajectory& trajectory) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const ev::StampedPose& pose : trajectory) mean -= pose.q_WC * Eigen::Vector3d::UnitY();
  const int axis = AxisOf(mean);
  return (mean[axis] < 0 ? -1 : 1) * Eigen::Vector3d::Unit(axis);
}

std::string NameOf(const Eigen::Vector3d& direction) {
  return (direction.sum() < 0 ? "-" : "") + std::string(1, "xyz"[AxisOf(direction)]);
}

Axis WorldAxis(const Eigen::Vector3d& direction) {
  return {std::string(1, "xyz"[AxisOf(direction)]) + " [m]", false, direction.sum() < 0};
}

// Landmarks in the world of the drawing, permanent ones only.
Points Map(const RunData& run) {
  Points points;
  for (const Landmark& landmark : run.landmarks) {
    if (!landmark.permanent) continue;
    const ev::StampedPose at{0, landmark.X_W, Eigen::Quaterniond::Identity()};
    points.push_back(run.judged ? ev::Apply(run.judged->metrics.errors.sim3.similarity, at).p_WC : at.p_WC);
  }
  const std::size_t every = (points.size() + kLandmarks - 1) / kLandmarks;
  Points kept;
  for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(every, 1)) kept.push_back(points[i]);
  return kept;
}

void SetPoints(const Points& points, Series& series) {
  series.x = Component(points, 0);
  series.y = Component(points, 1);
  series.z = Component(points, 2);
}

Series InSpace(const ResultData& data, const ev::Trajectory& trajectory, Series series) {
  SetPoints(Positions(trajectory), series);
  series.t = Times(data, trajectory);
  return series;
}

// Figure that the page can rotate; `up`: its initial vertical.
Figure SpaceFigure(const ResultData& data, const std::string& described) {
  Figure figure;
  figure.kind = Figure::Kind::space;
  figure.title = "In space";
  figure.description = described + " Dots are the permanent landmarks of the final maps.";
  figure.up = NameOf(UpOf(Reference(data)));
  const std::vector<std::string> systems = data.Systems();
  for (std::size_t s = 0; s < systems.size(); ++s) {
    const RunData& typical = data.Typical(systems[s]);
    if (const Points map = Map(typical); !map.empty()) {
      Series dots = Faint(LineOf(systems[s], s, {}, {}));
      dots.draw = Draw::dots;
      SetPoints(map, dots);
      figure.series.push_back(dots);
    }
    if (!data.SharedTruth()) continue;
    for (const RunData* run : FaintRuns(data, systems[s])) {
      figure.series.push_back(InSpace(data, Drawn(*run), Faint(LineOf(systems[s], s, {}, {}))));
    }
  }
  if (AnyJudged(data)) figure.series.push_back(InSpace(data, Reference(data), LineAs(Role::truth, "truth", {}, {})));
  for (std::size_t s = 0; s < systems.size(); ++s) {
    figure.series.push_back(InSpace(data, Drawn(data.Typical(systems[s])), LineOf(systems[s], s, {}, {})));
  }
  return figure;
}

// The paths of the figure in space, seen along a world axis.
Figure Projected(const Figure& space, const std::string& title, const std::string& described,
                 const Eigen::Vector3d& right, const Eigen::Vector3d& up) {
  Figure figure;
  figure.title = title;
  figure.description = described;
  figure.x = WorldAxis(right);
  figure.y = WorldAxis(up);
  figure.equal_scale = true;
  const auto along = [](const Series& series, const Eigen::Vector3d& direction) {
    const Numbers* columns[] = {&series.x, &series.y, &series.z};
    return *columns[AxisOf(direction)];
  };
  for (const Series& series : space.series) {
    if (series.draw != Draw::line) continue;
    Series flat = series;
    flat.x = along(series, right);
    flat.y = along(series, up);
    flat.z.clear();
    figure.series.push_back(flat);
  }
  return figure;
}

}  // namespace

std::vector<Figure> PathFigures(const ResultData& data) {
  const std::string described = AnyJudged(data)
                                    ? "Truth and the estimates, aligned to it by rotation, translation and scale."
                                    : "The estimates, each in its own scale; there is no truth.";
  const Eigen::Vector3d up = UpOf(Reference(data));
  const Eigen::Vector3d right = Eigen::Vector3d::Unit(AxisOf(up) == 0 ? 1 : 0);
  const Figure space = SpaceFigure(data, described);
  // right x forward = up, seen from above.
  return {space, Projected(space, "From above", described, right, up.cross(right)),
          Projected(space, "From the side", described, right, up)};
}

}  // namespace vobench::report
