#include "vo/filter/path_sampling.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>

namespace vo {

ParticleColumns ExactDraws(const ParticleColumns& offsets, const ParticleColumns& normals) {
  const Eigen::Index n = normals.cols();
  if (n <= normals.rows()) return normals;
  ParticleColumns draws = normals.colwise() - normals.rowwise().mean();
  if (n >= normals.rows() + offsets.rows() + 2) {
    // Linearly dependent rows of the offsets (particles that are all at one place) are left out by the rank.
    Eigen::MatrixXd centred = (offsets.colwise() - offsets.rowwise().mean()).transpose();
    const Eigen::RowVectorXd lengths = centred.colwise().norm();
    centred.array().rowwise() /= (lengths.array() > 0).select(lengths.array(), 1);  // no unit decides the rank
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(centred);
    const Eigen::MatrixXd basis = (qr.householderQ() * Eigen::MatrixXd::Identity(n, qr.rank())).eval();
    draws -= (draws * basis) * basis.transpose();
  }
  const Eigen::MatrixXd covariance = draws * draws.transpose() / static_cast<double>(n);
  return covariance.llt().matrixL().solve(draws);
}

std::vector<Pose> SamplePoses(const ParticleSet& particles, int slot, bool exact,
                              const std::function<RandomKey(std::size_t)>& key) {
  const int count = static_cast<int>(particles.size());
  ParticleColumns offsets(6, count), normals(6, count);
  for (int i = 0; i < count; ++i) {
    offsets.col(i) = Minus(particles[i].solution.path.mean[slot], particles[0].solution.path.mean[slot]);
    normals.col(i) = NormalVector<Vector6>(key(i));
  }
  if (exact) normals = ExactDraws(offsets, normals);
  std::vector<Pose> drawn;
  for (int i = 0; i < count; ++i) {
    const PathGaussian& path = particles[i].solution.path;
    drawn.push_back(PoseGaussian{path.mean[slot], path.covariance.topLeftCorner<6, 6>()}.Displaced(normals.col(i)));
  }
  return drawn;
}

void UpdateGivenPose(const VelocityFilter& step, const Window& window, const LandmarkTable& table, int slot,
                     std::vector<LandmarkGain>& gains, Particle& particle) {
  const Pose& s = particle.solution.path.mean[slot];
  const std::vector<Match>& matches = window.frames()[slot].matches;
  particle.velocity = VelocityGivenPose(step.Condition(PathState(particle.pose), particle.velocity), particle.pose, s,
                                        particle.solution.path.turns[slot].mean);
  if (gains.empty()) gains = GainsOf(matches, table, s, particle.anchors, particle.solution.modes, particle.landmarks);
  UpdateLandmarks(matches, gains, table, s, particle.anchors, particle.solution.modes, particle.landmarks);
  particle.pose = s;
}

}  // namespace vo
