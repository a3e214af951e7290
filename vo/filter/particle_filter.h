// Purpose: RB2-PF (and RB-PF) without images: particles over the camera's pose, each with a Kalman filter for the velocity and one
//          for every landmark. Between Predict and Update the caller finds the landmarks in the image, once for all particles.
// Source:  Zhou & Maskell, Algorithm 1. Section numbers in the comments are those of the algorithm's description.
// Frames:  poses T_WC; image points on the plane z = 1 of an undistorted camera.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "vo/base/params.h"
#include "vo/filter/filter.h"
#include "vo/filter/mixture.h"
#include "vo/filter/motion_model.h"
#include "vo/filter/path_prior.h"
#include "vo/filter/path_window.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/filter/proposal.h"
#include "vo/map/landmark.h"

namespace vo {

struct Particle {
  Pose pose;                             // sampled
  CameraVelocityFilter::State velocity;  // Gaussian given the path: (v in W, w in C); all have the same covariance
  std::vector<Landmark> landmarks;       // Gaussian given the path
  std::vector<Pose> anchors;             // of the landmarks' first views, on this particle's path
  double log_weight = 0;
  PoseGaussian prediction;  // (12)(13), valid between Predict and Update

  // Delayed sampling only: the poses after `pose`, and each landmark where all images put it.
  PathGaussian path;
  std::vector<Eigen::Vector3d> modes;
};

class ParticleFilter final : public Filter {
 public:
  ParticleFilter(const MotionParams& motion, const FilterParams& filter, const LandmarkParams& landmark,
                 const FilterPrior& prior, std::uint64_t seed);

  // Algorithm 1, line 2. dt > 0 [s].
  void Predict(double dt) override;
  // Algorithm 1, lines 4-11, with the matches of line 3. No matches: the filter coasts. Nothing is sampled then, and the next
  // Predict goes on from the last sampled pose over the whole time since: exact, and the covariance grows as the model says.
  void Update(std::span<const Match> matches) override;

  // A landmark for every ray (plane z = 1), first seen at the present pose of each particle, which is sampled now if the filter
  // coasts. Indices follow those in use.
  void AddLandmarks(std::span<const FirstView> views) override;
  // Keeps the landmarks marked true, in their order.
  void KeepLandmarks(const std::vector<bool>& keep) override;

  int landmark_count() const override { return static_cast<int>(anchor_of_.size()); }
  // Moments over the particles; in the start's window, which they share, the first one's. Valid after Predict.
  std::vector<ImagePrediction> PredictImages(std::span<const int> landmarks) const override;
  // The heaviest particle, and its landmarks as all images until now have them.
  const PoseGaussian& ReferencePrediction() const override { return Heaviest().prediction; }
  LocalMap ReferenceMap() const override;
  Eigen::Vector3d ModeOf(int landmark) const override { return ModeOf(Heaviest(), landmark); }
  Pose AnchorOf(int landmark) const override { return Heaviest().anchors[anchor_of_[landmark]]; }

  std::vector<LandmarkBelief> LandmarkBeliefs() const override;
  std::vector<double> InverseDepthSigmas() const override;
  std::vector<std::optional<PointMoments>> LandmarkPoints() const override;
  // The filter's answer: moments of the mixture over particles of the pose just before it is sampled, and the velocity with it.
  const Belief& belief() const override { return belief_; }
  // The mixture itself; empty before the first Update.
  const std::vector<BeliefComponent>& mixture() const override { return mixture_; }
  double effective_particles() const override { return effective_particles_; }
  const Guards& guards() const override { return guards_; }
  bool undecided() const override { return undecided_; }
  double lengthened() const override { return lengthened_; }
  const std::vector<Particle>& particles() const { return particles_; }
  const std::vector<double>& weights() const { return weights_; }
  const FilterParams& params() const { return params_; }

 private:
  friend struct ParticleFilterPeer;  // a test's: puts into the state what no image can

  // A frame whose pose is not sampled yet.
  struct Step {
    double dt = 0;  // [s] since the one before
    std::uint32_t frame = 0;
    std::vector<Match> matches;
  };

  const Particle& Heaviest() const;
  LocalMap MapOf(const Particle& particle) const { return {particle.landmarks, anchor_of_, particle.anchors}; }
  // Poses that are kept un-sampled after an update.
  int window_size() const { return undecided_ ? std::max(params_.lag, start_window_) : params_.lag; }
  bool delayed() const { return window_size() > 0; }
  const Eigen::Vector3d& ModeOf(const Particle& particle, int landmark) const {
    return delayed() ? particle.modes[landmark] : particle.landmarks[landmark].mean;
  }
  // delayed_sampling.cpp
  void PredictPath(double dt);
  void UpdatePath(std::span<const Match> matches);
  void SolvePaths();
  void SolvePath(Particle& particle, double beaten_by = std::numeric_limits<double>::infinity());
  void PlaceAnchors(Particle& particle) const;
  // In the start's window the particles differ by where they start at most: what the first one finds, the others follow.
  std::span<Particle> Leaders() { return {particles_.data(), together() ? 1 : particles_.size()}; }
  bool together() const { return undecided_ && start_window_ > params_.lag; }
  // What a row has seen is seen from so far beside the camera's place at the stamp, or, with the depths that a solution has, from there.
  enum class Rows { from_beside, from_stamp };
  bool tells_rows() const { return rolling_ && together(); }
  std::vector<Vector6> VelocitiesAlong(const Particle& particle) const;
  void TellRows(Particle& particle, Rows rows);
  void SettleRows();
  double Lengthened() const;
  void FollowFirst();
  void LookForBetter();
  Particle Sideways(const Particle& particle, std::uint32_t guess) const;
  void Triangulate(Particle& particle) const;
  void Decide();
  WindowInput InputOf(const Particle& particle) const {
    return {particle.pose, particle.velocity.mean, particle.landmarks, particle.anchors};
  }
  static Track::View ViewOf(const Match& match, int slot);
  void BuildTracks();
  std::vector<Track> TrackOfEach() const;
  Eigen::Matrix3d PointCovariance(const Particle& particle, const Track& track) const;
  void WeighPaths();
  bool ToResample() const;
  void CommitOldest(int count);
  std::vector<Pose> Draw(int slot) const;
  static void Fix(Particle& particle, int slot, const Pose& drawn);
  void UpdateGiven(Particle& particle, int slot, std::uint32_t index) const;
  void UpdateLandmarksAt(int slot, const Particle& particle, std::vector<Landmark>& landmarks) const;
  BeliefComponent ComponentOnPath(const Particle& particle) const;
  std::vector<ImagePrediction> PredictImagesOnPath(std::span<const int> landmarks) const;

  void Coast();
  void SampleStep(std::span<const Match> matches);
  PoseGaussian PredictPose(const Particle& particle, const Matrix6& covariance) const;
  Eigen::Vector3d PredictedTurn(const Particle& particle) const;  // since the last sampled pose [rad in C]
  PoseProposal ProposePose(const Particle& particle, std::span<const Match> matches);
  double UpdateLandmarks(Particle& particle, const Pose& pose, std::span<const Match> matches);
  CameraVelocityFilter::Gain VelocityGiven(const Particle& particle) const;
  void UpdateVelocity(Particle& particle, const Pose& pose, const Eigen::Vector3d& turn,
                      const CameraVelocityFilter::Gain& gain, std::uint32_t index) const;
  void Weigh();
  void ReplaceImpossible();
  void Answer();
  void Resample();

  MotionParams motion_;
  FilterParams params_;
  LandmarkParams landmark_params_;
  std::uint64_t seed_;
  std::uint32_t frame_ = 0;
  double since_sampled_ = 0;   // [s]; 0 when the present pose is sampled
  CameraVelocityFilter step_;  // from the last sampled pose to the present
  std::vector<Particle> particles_;
  std::vector<Particle> children_;  // workspace of resampling, without memory of their own
  std::vector<int> ancestors_;      // workspace of resampling
  std::vector<double> weights_;     // normalised
  std::vector<int> anchor_of_;      // shared: all particles associate alike

  MatchBatch batch_;  // workspace

  // Delayed sampling only.
  std::vector<Step> steps_;       // the last is the present frame
  std::vector<int> anchor_slot_;  // per anchor: the step of its pose, -1: sampled
  std::vector<Track> tracks_;     // of the landmarks seen from these steps
  std::vector<int> track_of_;     // per landmark: index into tracks_ or -1
  std::optional<PathPrior> path_prior_;
  PathWindow window_;
  std::vector<Eigen::Vector3d> modes_;  // workspace
  int start_window_ = 0;                // 0 where the settings know no window
  bool undecided_ = false;              // no pose has been sampled yet
  bool rolling_ = false;                // rows have times of their own
  std::vector<FirstView> first_views_;  // the start's: of the landmarks, which no update has changed yet
  std::vector<Pose> answered_;          // the start's path at the last answer
  double lengthened_ = 1;
  std::vector<Landmark> heaviest_landmarks_;

  Belief belief_;
  std::vector<BeliefComponent> mixture_;
  double effective_particles_ = 0;
  Guards guards_;
};

}  // namespace vo
