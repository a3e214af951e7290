#include "vo/filter/path_sampling.h"

#include <Eigen/Cholesky>

#include "vo/filter/exact_draws.h"

namespace vo {

std::vector<Pose> SamplePoses(const std::vector<PathSolution>& solutions, int slot, bool exact,
                              const std::function<RandomKey(std::size_t)>& key) {
  const int count = static_cast<int>(solutions.size());
  ParticleColumns offsets(6, count), normals(6, count);
  for (int i = 0; i < count; ++i) {
    offsets.col(i) = Minus(solutions[i].path.mean[slot], solutions[0].path.mean[slot]);
    normals.col(i) = NormalVector<Vector6>(key(i));
  }
  if (exact && EnoughForExactDraws(count, 6)) normals = ExactDraws(offsets, normals);
  std::vector<Pose> drawn;
  for (int i = 0; i < count; ++i) {
    const PathGaussian& path = solutions[i].path;
    drawn.push_back(PoseGaussian{path.mean[slot], path.covariance.topLeftCorner<6, 6>()}.Displaced(normals.col(i)));
  }
  return drawn;
}

void ConditionOn(int slot, const Pose& s, PathGaussian& path) {
  const int rest = static_cast<int>(path.covariance.rows()) - 6;
  const Eigen::LLT<Matrix6> llt(path.covariance.topLeftCorner<6, 6>());
  const Vector6 d = llt.solve(Minus(s, path.mean[slot]));
  const Eigen::MatrixXd cross = path.covariance.bottomLeftCorner(rest, 6);
  for (int k = 0; k < rest / 6; ++k)
    path.mean[slot + 1 + k] = Plus(path.mean[slot + 1 + k], cross.middleRows<6>(kPoseSize * k) * d);
  path.mean[slot] = s;
  path.covariance = (path.covariance.bottomRightCorner(rest, rest) - cross * llt.solve(cross.transpose())).eval();
}

void UpdateLandmarks(std::span<const Match> matches, const LandmarkTable& table, const Pose& pose,
                     std::span<const Pose> anchors, std::span<const Eigen::Vector3d> modes,
                     std::vector<Landmark>& landmarks) {
  const std::vector<AnchorView> views = ViewsOf(anchors, pose);
  for (const Match& match : matches) {
    const AnchorView view = views[table.anchor_of(match.landmark)].ShiftedBy(match.centre_offset_W);
    Landmark& landmark = landmarks[match.landmark];
    landmark = UpdateLandmark(landmark, modes[match.landmark], view, match, 1).landmark;
  }
}

void UpdateGivenPose(const CameraVelocityFilter& step, std::span<const Match> matches, const LandmarkTable& table,
                     int slot, const PathSolution& solution, Particle& particle) {
  const Pose& s = solution.path.mean[slot];
  particle.velocity = VelocityGivenPose(step.Condition(PathState(particle.pose), particle.velocity), particle.pose, s,
                                        solution.path.turns[slot]);
  UpdateLandmarks(matches, table, s, particle.anchors, solution.modes, particle.landmarks);
  particle.pose = s;
}

}  // namespace vo
