// Purpose: EKF-SLAM, the filter without particles: one Gaussian over pose, velocity and all landmarks together.
// Source:  Davison et al., "MonoSLAM" (2007); Civera et al., "Inverse depth parametrization" (2008). Motion is the family's own (6)-(9).
// State:   the camera pose, its velocity, and for every frame in which a landmark was first seen a copy of the pose (its anchor), kept as
//          long as a landmark uses it; each landmark is (x, y, rho) in its anchor's camera. The relation between anchor, camera and
//          landmark is then exact: it does not depend on where the world has its origin, and an error common to all poses (drift)
//          cancels in it however large it is. A landmark moved into W at its first view would carry the linearisation of
//          rho (p_A - p) there for good, which is pixels when neither the depth nor the pose is well known.
// Tangent: pose and anchors (dp in W, dphi in C), velocity (dv in W, dw in C); right perturbation.
// Cost:    n^2 m for n states and m matches: this is what the particle filters avoid.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "vo/base/params.h"
#include "vo/filter/filter.h"

namespace vo {

class EkfSlam final : public Filter {
 public:
  // Of the filter's parameters only joint_iterations is used.
  EkfSlam(const MotionParams& motion, const FilterParams& filter, const LandmarkParams& landmark,
          const FilterPrior& prior);

  void Predict(double dt) override;
  // One linearisation at the prediction: the textbook EKF. With joint_iterations above 1 at most so many steps of Gauss-Newton to the
  // joint mode of poses and landmarks instead: nearer to that, but the landmarks are then linearised where this frame's noise has
  // moved them, so that motion is seen in noise (docs/odometry.md). Covariance by Joseph's form.
  void Update(std::span<const Match> matches) override;
  void AddLandmarks(std::span<const FirstView> views) override;
  void KeepLandmarks(const std::vector<bool>& keep) override;
  int landmark_count() const override { return static_cast<int>(landmarks_.size()); }

  std::vector<ImagePrediction> PredictImages(std::span<const int> landmarks) const override;
  // The past poses are taken as known, at their means: what one step adds.
  const PoseGaussian& ReferencePrediction() const override { return reference_; }
  LocalMap ReferenceMap() const override { return {landmarks_, anchor_of_, anchors_}; }
  Eigen::Vector3d ModeOf(int landmark) const override { return landmarks_[landmark].mean; }
  Pose AnchorOf(int landmark) const override { return anchors_[anchor_of_[landmark]]; }
  std::vector<LandmarkBelief> LandmarkBeliefs() const override;
  std::vector<std::optional<PointMoments>> LandmarkPoints() const override;
  const Belief& belief() const override { return belief_; }
  const std::vector<BeliefComponent>& mixture() const override { return mixture_; }
  double effective_particles() const override { return 1; }
  const Guards& guards() const override { return guards_; }

  // Covariance of the whole state; a landmark's three entries begin at OffsetOf.
  const Eigen::MatrixXd& covariance() const { return P_; }
  int OffsetOf(int landmark) const { return landmark_offset_[landmark]; }

 private:
  ImagePrediction PredictImage(int landmark) const;

  // One match at the present linearisation: its rows of H are not 0 in three places only.
  struct Row {
    Eigen::Vector2d residual;
    Matrix26 H_pose, H_anchor;
    Matrix23 H_landmark;
    int match = 0, anchor_offset = 0, landmark_offset = 0;
  };
  void MoveTo(const Eigen::VectorXd& d);
  double Linearise(std::span<const Match> matches, const Eigen::VectorXd& d);
  template <class Matrix>
  Eigen::MatrixXd RowsTimes(const Matrix& M) const;  // H M
  void Answer();

  MotionParams motion_;
  FilterParams params_;
  LandmarkParams landmark_params_;

  Pose pose_;
  Vector6 velocity_;
  std::vector<Pose> anchors_;
  std::vector<int> anchor_offset_;   // in the state
  std::vector<Landmark> landmarks_;  // with their marginal covariance
  std::vector<int> anchor_of_, landmark_offset_;
  Eigen::MatrixXd P_;
  Matrix12 since_known_ = Matrix12::Zero();  // covariance of the camera, had its pose been known at the last update
  PoseGaussian reference_;

  // Of the update: where it began, and the rows.
  Pose pose_before_;
  Vector6 velocity_before_;
  std::vector<Pose> anchors_before_;
  std::vector<Eigen::Vector3d> means_before_;
  std::vector<Row> rows_;

  Belief belief_;
  Guards guards_;
  std::vector<BeliefComponent> mixture_;
};

}  // namespace vo
