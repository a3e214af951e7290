// Gaussian over a path of poses that are not sampled: its prior by the motion model, the velocity at its end, extension
// by a step, and conditioning on a pose.
// Source:  docs/algorithm.md, section 9. (6)-(9) are linear in the steps u_k = (p_k - p_k-1, LogNear(q_k-1^-1 q_k, its
//          prediction)), k = 1 ... m: u_k = F12 v_k-1 + noise, v_k = F22 v_k-1 + noise, the two noises correlated. The
//          velocity is linear in the steps, these in the poses, and the next step is linear in the velocity.
// Tangent: per pose (dp in W, dphi in C); slot 0 is the oldest pose that is not sampled.
#pragma once

#include <Eigen/Cholesky>
#include <optional>
#include <vector>

#include "vo/base/result.h"
#include "vo/filter/mixture.h"
#include "vo/filter/motion_model.h"
#include "vo/filter/pose_gaussian.h"

namespace vo {

constexpr Eigen::Index kPoseSize = 6;  // rows of a pose, or a step, in a vector of several

// Rotation of a step as predicted [rad in C].
struct StepTurn {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d input = Eigen::Vector3d::Zero();  // share of the mean: a measured turn less the motion model's
};

// Gaussian of the steps u with the velocities integrated out, and of the last velocity given the steps. The covariances
// do not depend on the path: all particles share them.
class PathPrior {
 public:
  // Steps in order of time; covariance of the velocity at the start of the first. `of_rates`: models of the steps for
  // the noise of the rates of rows; empty: without rates.
  PathPrior(const std::vector<MotionModel>& steps, const Matrix6& velocity_covariance,
            const std::vector<MotionModel>& of_rates);

  int size() const { return static_cast<int>(mean_of_step_.size()); }
  const Eigen::MatrixXd& precision() const { return precision_; }  // of u, 6m x 6m
  double log_det_precision() const { return log_det_precision_; }
  Vector6 MeanStep(int k, const Vector6& velocity) const { return mean_of_step_[k] * velocity; }
  // Shift of the steps' means by the inputs c_k: u_k given the earlier steps has the mean of the motion model plus
  // (0, c_k). With Cov(u) = L L' it is L s, s_k = L_kk^-1 (0, c_k). Empty where all inputs are 0.
  Eigen::VectorXd ShiftBy(const std::vector<StepTurn>& turns) const;

  // Last velocity given the steps: mean = LastMean(v_0) + gain (u - mean of u), covariance.
  Vector6 LastMean(const Vector6& velocity) const { return last_of_first_ * velocity; }
  const Eigen::Matrix<double, 6, Eigen::Dynamic>& gain() const { return gain_; }
  const Matrix6& last_covariance() const { return last_covariance_; }

  // Of the rates of rows, 3 (m + 1). A rate less that of the parabola through three poses is n_k - n_k+1, n of each
  // step with D / 12, D the noise of the turn rate in it: at the frame rate the motion is smooth. At the start's frame
  // and the last two, whose reference is the mean velocity of one step, D / 4 comes on top.
  const Eigen::MatrixXd& rate_precision() const { return rate_precision_; }

 private:
  void SetRates(const std::vector<MotionModel>& steps);

  std::vector<Matrix6> mean_of_step_;  // of the first velocity
  Matrix6 last_of_first_;
  Eigen::MatrixXd precision_;
  Eigen::LLT<Eigen::MatrixXd> llt_;  // of the covariance of u
  double log_det_precision_ = 0;
  Eigen::Matrix<double, 6, Eigen::Dynamic> gain_;
  Matrix6 last_covariance_;
  Eigen::MatrixXd rate_precision_;
};

struct PathGaussian {
  std::vector<Pose> mean;
  std::vector<StepTurn> turns;  // of the step to each pose
  // Turn rate of the rows of the start's frame and of each pose's, less that by which they are referred to the stamp
  // [rad/s in C].
  std::vector<Eigen::Vector3d> rates = {Eigen::Vector3d::Zero()};
  Eigen::MatrixXd covariance;  // 6m x 6m
  double objective = 0;        // -2 log density at its mode, up to a constant that all first guesses share
  // Laplace's approximation of log p(z in the window | sampled path); NaN: not positive definite
  double log_evidence = 0;
  NumericalEvents events;  // of the solution
};

// Poses not sampled yet and, of each landmark, (x, y, rho) by all images until now.
struct PathSolution {
  PathGaussian path;
  std::vector<Eigen::Vector3d> modes;
};

// u: of the rotation vectors that turn the pose before into the pose at `slot`, the one nearest to the prediction.
inline Vector6 StepTo(int slot, const PathGaussian& path, const Pose& start) {
  return MinusNear(path.mean[slot], slot == 0 ? start : path.mean[slot - 1], path.turns[slot].mean);
}

// Last pose and velocity of the path: a component of the answer's mixture, its weight left open. `start`, `velocity`:
// the last sampled pose and the mean velocity there.
BeliefComponent ComponentAtTheEnd(const PathPrior& prior, const Pose& start, const Vector6& velocity,
                                  const PathGaussian& path);

// One pose more, a step after the end; `prior` is that of the path before. Nothing is solved: a pose that no image has
// seen changes no other. `turn`: the rotation of the step, where it is measured.
void Extend(const PathPrior& prior, const MotionModel& step, const Pose& start, const Vector6& velocity,
            const std::optional<Eigen::Quaterniond>& turn, PathGaussian& path);
// All poses moved in W, T_WC -> motion T_WC.
void Move(const Pose& motion, PathGaussian& path);
// The last pose integrated out.
void DropLast(PathGaussian& path);

// The path given its scale: the covariance without the direction d = (p_k - start, 0) along which only the scale of all
// lengths differs, P - d d' / (d' P^-1 d), but for a hundredth of its standard deviation.
void ConditionOnScale(const Pose& start, PathGaussian& path);

// The rest of the path given its pose at `slot`: a conditional Gaussian. The covariance loses that pose, the mean keeps
// it.
void ConditionOn(int slot, const Pose& pose, PathGaussian& path);

}  // namespace vo
