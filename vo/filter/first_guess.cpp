#include "vo/filter/first_guess.h"

#include "vo/geometry/relative_pose.h"
#include "vo/geometry/so3.h"

namespace vo {
namespace {

void TriangulateAnew(const Window& window, const LandmarkTable& table, const WindowInput& in, PathSolution& solution) {
  for (const Track& track : window.tracks()) solution.modes[track.landmark] = in.landmarks[track.landmark].mean;
  solution.modes = Triangulate(window, table, in, solution);
}

// Images of the landmarks observed in both frames.
std::vector<RayPair> PairsOf(const Window& window, const WindowInput& in, int first, int last) {
  std::vector<RayPair> pairs;
  for (const Track& track : window.tracks()) {
    if (track.views.back().slot != last) continue;
    const Eigen::Vector2d& z = track.views.back().z;
    if (track.anchor_slot == first) pairs.push_back({in.landmarks[track.landmark].mean.head<2>(), z});
    for (const Track::View& view : track.views)
      if (view.slot == first) pairs.push_back({view.z, z});
  }
  return pairs;
}

}  // namespace

PathSolution PerturbTranslation(const Window& window, const LandmarkTable& table, const WindowInput& in,
                                const PathSolution& solution, std::uint32_t guess) {
  PathSolution other = solution;
  double rho = 0;
  for (const Track& track : window.tracks())
    rho += solution.modes[track.landmark].z() / static_cast<double>(window.tracks().size());
  const Eigen::Vector3d translation = in.start.q_WC.conjugate() * (solution.path.mean.back().p_WC - in.start.p_WC);
  const double length = translation.norm();
  const Eigen::Vector2d targets[kPerturbations] = {{0, 0},      -translation.head<2>(), {length, 0},
                                                   {0, length}, {-length, 0},           {0, -length}};
  const Eigen::Vector2d change = targets[guess] - translation.head<2>();
  double duration = 0, time = 0;
  for (const Window::Frame& frame : window.frames()) duration += frame.dt;
  for (int k = 0; k < window.size(); ++k) {
    time += window.frames()[k].dt;
    const Eigen::Vector2d c = time / duration * change;
    Pose& pose = other.path.mean[k];
    pose.p_WC += in.start.q_WC * Eigen::Vector3d(c.x(), c.y(), 0);
    pose.q_WC = (pose.q_WC * Exp({rho * c.y(), -rho * c.x(), 0})).normalized();
  }
  TriangulateAnew(window, table, in, other);
  return other;
}

std::optional<PathSolution> EpipolarPath(const Window& window, const LandmarkTable& table, const WindowInput& in,
                                         const PathSolution& solution) {
  constexpr std::size_t kLeastPairs = 30;
  const int last = window.size() - 1;
  std::vector<RayPair> pairs;
  int first = -1;  // slot; -1: the start pose
  for (; first < last - 1; ++first) {
    pairs = PairsOf(window, in, first, last);
    if (pairs.size() >= kLeastPairs) break;
  }
  if (pairs.size() < kLeastPairs) return std::nullopt;
  const auto relative = FindRelativePose(pairs);
  if (!relative) return std::nullopt;
  PathSolution other = solution;
  const Pose from = first < 0 ? in.start : solution.path.mean[first];
  const Eigen::Vector3d translation =
      (solution.path.mean[last].p_WC - from.p_WC).norm() * (from.q_WC * relative->direction_A);
  double duration = 0, time = 0;
  for (int k = first + 1; k <= last; ++k) duration += window.frames()[k].dt;
  for (int k = first + 1; k <= last; ++k) {
    time += window.frames()[k].dt;
    const double share = time / duration;
    const Eigen::Quaterniond turn = Eigen::Quaterniond::Identity().slerp(share, relative->q_AB);
    other.path.mean[k] = {from.p_WC + share * translation, (from.q_WC * turn).normalized()};
  }
  TriangulateAnew(window, table, in, other);
  return other;
}

}  // namespace vo
