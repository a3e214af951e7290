#include "vo/filter/mode_challenge.h"

#include "vo/filter/path_sampling.h"
#include "vo/geometry/so3.h"

namespace vo {
namespace {

constexpr int kTriangulations = 3;

}  // namespace

PathSolution PerturbTranslation(const Window& window, const LandmarkTable& table, const WindowInput& in,
                                const PathSolution& solution, std::uint32_t guess) {
  PathSolution other = solution;
  double rho = 0;
  for (const Track& track : window.tracks())
    rho += solution.modes[track.landmark].z() / static_cast<double>(window.tracks().size());
  const Eigen::Vector3d translation = in.start.q_WC.conjugate() * (solution.path.mean.back().p_WC - in.start.p_WC);
  const double length = translation.norm();
  const Eigen::Vector2d targets[kGuesses] = {{0, 0},      -translation.head<2>(), {length, 0},
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
  for (const Track& track : window.tracks()) other.modes[track.landmark] = in.landmarks[track.landmark].mean;
  other.modes = Triangulate(window, table, in, other);
  return other;
}

std::vector<Eigen::Vector3d> Triangulate(const Window& window, const LandmarkTable& table, const WindowInput& in,
                                         const PathSolution& solution) {
  std::vector<Pose> anchors(in.anchors.begin(), in.anchors.end());
  window.PlaceAnchors(solution.path, anchors);
  std::vector<Eigen::Vector3d> modes = solution.modes;
  for (int round = 0; round < kTriangulations; ++round) {
    std::vector<Landmark> landmarks(in.landmarks.begin(), in.landmarks.end());
    for (int k = 0; k < window.size(); ++k)
      UpdateLandmarks(window.frames()[k].matches, table, solution.path.mean[k], anchors, modes, landmarks);
    for (const Track& track : window.tracks()) modes[track.landmark] = landmarks[track.landmark].mean;
  }
  return modes;
}

}  // namespace vo
