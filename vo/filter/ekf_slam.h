// EKF-SLAM: one Gaussian over pose, velocity and all landmarks.
// Source:  Davison et al., "MonoSLAM" (2007); Civera et al., "Inverse depth parametrization" (2008). Motion is the
//          family's own (6)-(9).
// State:   the camera pose, its velocity, and for every frame in which a landmark was first seen a copy of the pose
//          (its anchor), kept as long as a landmark uses it; each landmark is (x, y, rho) in its anchor's camera. The
//          relation between anchor, camera and landmark is then exact: it does not depend on the origin of the world,
//          and an error common to all poses (drift) cancels in it however large it is. A landmark transformed to W at
//          its first view would keep the linearisation of rho (p_A - p) there, an error of pixels when both depth and
//          pose are uncertain.
// Cost:    n^2 m for n states and m matches.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "vo/base/params.h"
#include "vo/filter/filter.h"
#include "vo/filter/joint_state.h"

namespace vo {

class EkfSlam final : public Filter {
 public:
  // Of the filter's parameters only joint_iterations is used.
  EkfSlam(const MotionParams& motion, const FilterParams& filter, const LandmarkParams& landmark,
          const FilterPrior& prior);

  void Predict(double dt, const MotionInput& input = {}) override;
  void PredictAgain(const MotionInput& input) override;  // input.turn is left out
  // One linearisation at the prediction: the textbook EKF. With joint_iterations above 1 at most that many steps of
  // Gauss-Newton to the joint mode of poses and landmarks: landmarks are then linearised where this frame's noise has
  // moved them, and noise is mistaken for motion (docs/odometry.md). Covariance by Joseph's form.
  const FilterAnswer& Update(std::span<const Match> matches) override;
  void AddLandmarks(std::span<const FirstView> views) override;
  void KeepLandmarks(const std::vector<bool>& keep) override;
  int landmark_count() const override { return static_cast<int>(state_.landmarks.size()); }
  const FilterAnswer& answer() const override { return answer_; }

  std::vector<ImagePrediction> PredictImages(std::span<const int> landmarks) const override;
  // The past poses are taken as known, at their means: the covariance is that of one step.
  ReferencePath Reference() const override { return {reference_, state_.map(), {}}; }
  std::vector<LandmarkBelief> LandmarkBeliefs() const override;
  // Of the joint Gaussian, the anchor's pose and its correlation with the landmark included.
  std::vector<LandmarkSpread> LandmarkSpreads() const override;

  // Covariance of the whole state; a landmark's three entries begin at OffsetOf.
  const Eigen::MatrixXd& covariance() const { return P_; }
  int OffsetOf(int landmark) const { return state_.landmark_offset[landmark]; }

 private:
  struct Mode;
  Mode FindMode(std::span<const Match> matches) const;
  void Answer();

  MotionParams motion_;
  LandmarkParams landmark_params_;
  int joint_iterations_;
  JointState state_;
  Eigen::MatrixXd P_;
  Matrix12 since_known_ = Matrix12::Zero();  // covariance of the camera given its pose at the last update
  struct BeforePrediction {
    double dt;  // [s]
    Pose pose;
    Eigen::MatrixXd camera_rows, camera_columns;  // of P_
    Matrix12 since_known;
  } before_;
  PoseGaussian reference_;
  FilterAnswer answer_;
};

}  // namespace vo
