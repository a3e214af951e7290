// Batch of a frame's matches and one particle's landmarks, eight at a time for the inner loop (match_lanes.h).
// Units:   the plane z = 1, as in landmark.h.
#pragma once

#include <span>
#include <vector>

#include "vo/map/local_map.h"
#include "vo/map/match_lanes.h"
#include "vo/map/moments.h"

namespace vo {

class MatchBatch {
 public:
  explicit MatchBatch(InstructionSet set = BestInstructionSet()) : kernel_(&MatchKernelOf(set)) {}

  // The frame, then each particle in turn. All landmarks are to be linearised at their means.
  void SetMatches(std::span<const Match> matches);
  void SetLandmarks(std::span<const int> landmarks);  // to be predicted only
  void Load(const LocalMap& map);

  // The pose's information, the landmarks integrated out; those that lie behind the camera are left out. With the pose
  // moved by d:
  //   -2 log p(z | pose) = cost - 2 b'd + d'A d + log det, d = (dp in W, dphi in C).
  struct Information {
    Matrix6 A;
    Vector6 b;
    double cost = 0;
    double log_det = 0;  // of 2 pi S, all matches in front
    int behind = 0;      // matches left out
  };
  // `marginal`: see FilterParams::marginal_mode.
  Information Linearise(const Pose& camera, bool marginal);
  const Pose& linearised_at() const { return linearised_at_; }
  // Of each match: its squared residual with landmarks at their means, in standard deviations; infinite behind the
  // camera. Independent of Inflate.
  void SquaredDistances(const Pose& camera, std::vector<double>& distances);
  // From now on the matches' covariances are `factors` times those given.
  void Inflate(std::span<const double> factors);
  // From now on each landmark is linearised at its mode for the pose at linearised_at() (+) d, to first order.
  void Follow(const Vector6& d);

  // Landmarks given the pose: linearised at their mean, then at the mode. Returns the sum of log p(z | pose).
  double UpdateLandmarks(const Pose& camera, int max_iterations);
  void Store(std::span<Landmark> landmarks) const;

  // Moments, over particles, of the landmarks' predicted images from an uncertain pose. SetLandmarks resets the sums.
  void AddPredictions(const Pose& camera, const Matrix6& covariance, double weight);
  ImageMoments Moments(std::size_t place) const;

 private:
  void SetBlocks();
  const double* step() const { return following_ ? step_.data() : nullptr; }

  const MatchKernel* kernel_;
  std::vector<MatchLanes> blocks_;
  std::vector<PredictionLanes> predictions_;
  std::vector<Lanes> distances_;
  std::vector<int> landmark_;  // per match
  std::vector<Eigen::Vector3d> centre_offset_W_;
  Pose linearised_at_;
  Vector6 step_ = Vector6::Zero();
  bool following_ = false;  // by step_, which is still to be done
};

}  // namespace vo
