// ParticleFilter until its first pose is sampled. The depths are not known yet, and a sideways motion looks nearly like a turn: several motions
// explain the images nearly as well (depth reversal is the best known of them), and no later image undoes a wrong choice. So the poses
// stay one window, and in every frame the solution is challenged by another.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "vo/filter/particle_filter.h"
#include "vo/geometry/so3.h"
#include "vo/geometry/symmetric.h"

namespace vo {
namespace {

constexpr std::uint32_t kGuesses = 6;
constexpr int kTriangulations = 3;
constexpr int kRounds = 4;        // of telling the rows
constexpr double kSettled = 0.1;  // change of -2 log p

}  // namespace

// By the density at the mode, not by evidence: that pays for depths that stay unknown, as if each had a prior of its own. Those of a wall
// are alike, and a wall seen face on lost to a deep scene with little parallax.
void ParticleFilter::LookForBetter() {
  for (std::uint32_t i = 0; i < Leaders().size(); ++i) {
    Particle& particle = particles_[i];
    Particle other = Sideways(particle, (i + frame_) % kGuesses);
    if (tells_rows()) TellRows(other, Rows::from_stamp);
    SolvePath(other, particle.path.objective);
    const bool better = other.path.objective < particle.path.objective;
    if (better || std::isnan(particle.path.objective)) particle = std::move(other);
    if (tells_rows()) TellRows(particle, Rows::from_stamp);
  }
  if (together()) FollowFirst();
}

// The particle's solution with another sideways motion: none, the opposite, or along an axis of the first camera; turned so that what lies at the
// mean depth stays where it is seen, and with the depths that landmarks have along this path.
Particle ParticleFilter::Sideways(const Particle& particle, std::uint32_t guess) const {
  Particle other = particle;
  double rho = 0;
  for (const Track& track : tracks_) rho += particle.modes[track.landmark].z() / static_cast<double>(tracks_.size());
  const Eigen::Vector3d way = particle.pose.q_WC.conjugate() * (particle.path.mean.back().p_WC - particle.pose.p_WC);
  const double length = way.norm();
  const Eigen::Vector2d targets[kGuesses] = {{0, 0},      -way.head<2>(), {length, 0},
                                             {0, length}, {-length, 0},   {0, -length}};
  const Eigen::Vector2d change = targets[guess] - way.head<2>();
  double duration = 0, time = 0;
  for (const Step& step : steps_) duration += step.dt;
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    time += steps_[k].dt;
    const Eigen::Vector2d c = time / duration * change;
    Pose& pose = other.path.mean[k];
    pose.p_WC += particle.pose.q_WC * Eigen::Vector3d(c.x(), c.y(), 0);
    pose.q_WC = (pose.q_WC * Exp({rho * c.y(), -rho * c.x(), 0})).normalized();
  }
  for (const Track& track : tracks_) other.modes[track.landmark] = particle.landmarks[track.landmark].mean;
  Triangulate(other);
  return other;
}

// Each landmark's mode given the path, by Gauss-Newton from the present one: all its views linearised together.
void ParticleFilter::Triangulate(Particle& particle) const {
  PlaceAnchors(particle);
  for (int round = 0; round < kTriangulations; ++round) {
    std::vector<Landmark> landmarks = particle.landmarks;
    for (std::size_t k = 0; k < steps_.size(); ++k) UpdateLandmarksAt(static_cast<int>(k), particle, landmarks);
    for (const Track& track : tracks_) particle.modes[track.landmark] = landmarks[track.landmark].mean;
  }
}

// At the particle's pose and at each of the path, by the parabola through three of them. Not given the prior, which would be believed too much
// in the first frame: a turn that it does not know of would shear the map for good.
std::vector<Vector6> ParticleFilter::VelocitiesAlong(const Particle& particle) const {
  std::vector<Vector6> steps;  // mean velocities
  for (std::size_t k = 0; k < steps_.size(); ++k)
    steps.push_back(StepTo(static_cast<int>(k), particle.path, particle.pose) / steps_[k].dt);
  if (steps.size() == 1) return {steps[0], steps[0]};
  std::vector<Vector6> velocities(steps.size() + 1);
  for (std::size_t k = 1; k < steps.size(); ++k) {
    const double before = steps_[k - 1].dt, after = steps_[k].dt;
    velocities[k] = (after * steps[k - 1] + before * steps[k]) / (before + after);
  }
  velocities.front() = 2 * steps.front() - velocities[1];
  velocities.back() = 2 * steps.back() - velocities[steps.size() - 1];
  return velocities;
}

// What the rows of a rolling shutter have seen, and the landmarks' first views, as the velocities along this solution have it: in the first
// frames a turn is taken for a sideways motion, and what is told by that shears the map, and turns it. From the stamp as long as the window is
// open: a way is so many metres, which would hold the scale that the first frames guessed, and say that it is known.
void ParticleFilter::TellRows(Particle& particle, Rows rows) {
  const std::vector<Vector6> velocities = VelocitiesAlong(particle);
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const std::vector<AnchorView> views = ViewsOf(particle.anchors, particle.path.mean[k]);
    for (Match& match : steps_[k].matches) {
      if (match.row.time == 0) continue;
      const auto [z, moved] = match.row.AsTurned(velocities[k + 1]);
      match.z = z;
      match.moved = moved;
      if (rows == Rows::from_beside) continue;
      match = AtStamp(match, views[anchor_of_[match.landmark]], particle.modes[match.landmark]);
    }
  }
  for (std::size_t n = 0; n < first_views_.size(); ++n) {
    FirstView& view = first_views_[n];
    if (view.row.time == 0) continue;
    const int anchor = anchor_of_[n];
    const FirstView anew = FirstSeen(view.row, particle.anchors[anchor], velocities[anchor_slot_[anchor] + 1]);
    view.ray = anew.ray;
    view.by_inverse_depth = anew.by_inverse_depth;
    if (rows == Rows::from_stamp) {
      view.ray += particle.modes[n].z() * anew.by_inverse_depth;
      view.by_inverse_depth.setZero();
    }
    particle.landmarks[n] = NewLandmark(view, landmark_params_);
  }
  BuildTracks();
}

// The path tells the rows, and these the path, until both agree: told once a frame they were still off by up to fifteen standard deviations after
// thirty frames, told until both agree by what the noise explains.
void ParticleFilter::SettleRows() {
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    TellRows(particles_[0], Rows::from_stamp);
    SolvePath(particles_[0]);  // LookForBetter lets the others follow
    if (std::abs(particles_[0].path.objective - before) < kSettled) break;
    before = particles_[0].path.objective;
  }
}

// How many times as long as it was answered the path is now that it is found anew, as far as that is a matter of its scale. With d* and d, its
// places now and as answered, seen from the start: the factor of least squares, d'd* / d'd, to the power of the share of the path's variance
// that lies along d, (d'Pd / d'd) / tr P. It is 1 where nothing but the scale is uncertain, and nearly 0 where every pose is: then a length
// that was answered wrong must not set the scale of all to come.
double ParticleFilter::Lengthened() const {
  const Particle& first = particles_[0];
  const auto count = static_cast<Eigen::Index>(answered_.size());
  Eigen::VectorXd was = Eigen::VectorXd::Zero(kPoseSize * count), is = was;  // positions, seen from the start
  double variance = 0;
  for (Eigen::Index k = 0; k < count; ++k) {
    was.segment<3>(kPoseSize * k) = answered_[static_cast<std::size_t>(k)].p_WC - first.pose.p_WC;
    is.segment<3>(kPoseSize * k) = first.path.mean[static_cast<std::size_t>(k)].p_WC - first.pose.p_WC;
    variance += first.path.covariance.block<3, 3>(kPoseSize * k, kPoseSize * k).trace();
  }
  const double square = was.squaredNorm(), product = was.dot(is);
  if (!(product > 0)) return 1;  // nothing answered yet, or it leads elsewhere
  const auto P = first.path.covariance.topLeftCorner(kPoseSize * count, kPoseSize * count);
  const double share = was.dot(P * was) / (square * variance);
  if (!(share >= 0 && share <= 1)) return 1;  // the guard of indefinite covariances has counted it
  return std::pow(product / square, share);
}

// The first particle's solution from where the others start.
void ParticleFilter::FollowFirst() {
  const Particle& first = particles_[0];
  for (std::size_t i = 1; i < particles_.size(); ++i) {
    Particle& particle = particles_[i];
    const Eigen::Quaterniond turn = particle.pose.q_WC * first.pose.q_WC.conjugate();
    particle.path = first.path;
    particle.landmarks = first.landmarks;
    for (Pose& pose : particle.path.mean)
      pose = {particle.pose.p_WC + turn * (pose.p_WC - first.pose.p_WC), (turn * pose.q_WC).normalized()};
    const Eigen::Matrix3d R = turn.toRotationMatrix();
    for (Eigen::Index k = 0; k < particle.path.covariance.rows(); k += kPoseSize) {  // of each pose, dp is in W
      particle.path.covariance.middleRows<3>(k) = (R * particle.path.covariance.middleRows<3>(k)).eval();
      particle.path.covariance.middleCols<3>(k) = (particle.path.covariance.middleCols<3>(k) * R.transpose()).eval();
    }
    Symmetrise(particle.path.covariance);
    particle.modes = first.modes;
    PlaceAnchors(particle);
  }
}

// The start is over: each particle has a solution of its own, to be drawn from, and a weight.
void ParticleFilter::Decide() {
  const bool alike = together();
  const double log_evidence = particles_[0].path.log_evidence;
  if (tells_rows()) {
    TellRows(particles_[0], Rows::from_beside);
    SolvePath(particles_[0]);
    FollowFirst();
  }
  first_views_.clear();
  undecided_ = false;
  if (!alike) return;
  for (Particle& particle : particles_) {
    particle.log_weight -= log_evidence;
    SolvePath(particle);
    guards_ += particle.path.guards;
    particle.log_weight += particle.path.log_evidence;
  }
  WeighPaths();
}

}  // namespace vo
