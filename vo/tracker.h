// Odometry from one start: the filter with its map of landmarks, and the association of each image. Private to
// Odometry, which tracks a start with two of them.
// Source:  docs/algorithm.md; Algorithm 1.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vo/base/params.h"
#include "vo/base/result.h"
#include "vo/filter/checked_filter.h"
#include "vo/frontend/adaptive_association.h"
#include "vo/frontend/association.h"
#include "vo/frontend/new_features.h"
#include "vo/frontend/relocalisation.h"
#include "vo/frontend/rolling_shutter.h"
#include "vo/geometry/camera.h"
#include "vo/map/landmark_record.h"
#include "vo/scale_ambiguity.h"
#include "vo/start_trajectory.h"

namespace vo {

class Tracker {
 public:
  Tracker(const Camera& camera, const Params& params, const Prior& prior, std::uint64_t seed);

  // Throws std::invalid_argument as Odometry::Track does.
  void Require(const Frame& frame) const;
  Estimate Process(const PreparedFrame& frame);
  // Present state as the estimate of a frame.
  Estimate Answer(std::int64_t stamp_ns, const FrameDiagnostics& diagnostics) const;
  std::vector<MapPoint> Map() const;

  const FilterAnswer& answer() const { return filter_.answer(); }
  const std::vector<StampedPose>& reissued() const { return start_.reissued(); }
  const std::vector<FeatureView>& views() const { return views_; }

  void SetReadout(double readout_s);
  // The answers keep their scale although the filter's path has all lengths times `change`.
  void KeepScale(double change);
  // A tracker in the state before its first frame.
  Tracker Restarted() const;

 private:
  void Start(const PreparedFrame& frame);
  void Begin(const PreparedFrame& frame, const Vector6& velocity);
  double SinceLast(std::int64_t stamp_ns) const;  // [s]
  void Repeat(std::int64_t stamp_ns);
  void Follow(const PreparedFrame& frame, FrameDiagnostics& diagnostics);
  void BeginAgain(const PreparedFrame& frame, Association& association, FrameDiagnostics& diagnostics);
  void RestartFirstFrame(const PreparedFrame& second, FrameDiagnostics& diagnostics);
  std::optional<PathCorrection> Relocalise(const PreparedFrame& frame, const Association& association,
                                           bool failed) const;
  // Whether search budget, depth prior and density of new features follow the map: with `motion.adaptive`, after the
  // start.
  bool adapts_map() const { return params_.motion.adaptive && !filter_.answer().initialising; }
  void Update(std::span<const Match> matches);
  void LoseLandmarks();
  void UpdateTypicalDepth(std::span<const Match> matches, std::span<const Filter::LandmarkBelief> beliefs);
  std::vector<NewFeature> DetectFeatures(const PreparedFrame& frame);
  void Forget(std::size_t wanted, std::span<const Filter::LandmarkBelief> beliefs);
  void AddLandmarks(std::vector<NewFeature> features, const PreparedFrame& frame, const Vector6& velocity);
  void SetFirstVelocity(LandmarkRecord& record, const Vector6& velocity) const;
  FirstView AddRecord(const NewFeature& feature, const PreparedFrame& frame, const Vector6& velocity);
  Matrix6 VelocityCovariance() const;

  Camera camera_;
  Params params_;
  Prior prior_;
  std::uint64_t seed_;
  CheckedFilter filter_;
  ScaleAmbiguity scale_;
  StartTrajectory start_;
  RollingShutter shutter_;
  BriskSampler first_sampler_;
  int border_px_;
  NewFeatureDetector detector_;
  std::vector<LandmarkRecord> records_;  // in the order of the filter's landmarks
  std::vector<FeatureView> views_;
  std::vector<LeftOut> left_out_;                // of this frame
  int budget_;                                   // landmarks of known depth to search for in the next
  bool has_matched_ = false;                     // some frame
  Matrix6 pose_before_start_ = Matrix6::Zero();  // covariance of the path from the first image to the start
  // Covariance of the pose at which the landmarks since the last loss began; of the pose before the present loss.
  Matrix6 pose_before_loss_ = Matrix6::Zero(), known_before_loss_ = Matrix6::Zero();
  std::optional<std::int64_t> last_stamp_ns_;
  SinceUpdate since_update_;
  double coasting_s_ = 0;  // time from the first frame without matches to the last frame, repeated images left out
  NoiseLevel noise_level_;
  ExposureEstimate exposure_;
  AdaptiveAssociation adaptive_;
  Relocaliser relocaliser_;
  std::optional<KnownDepth> typical_depth_;
  int frames_ = 0;
  double path_length_ = 0;                       // [m] of all answers
  int first_id_ = 0, next_id_ = 0;               // of the landmarks since this start; of the next one
  std::optional<PreparedFrame> first_frame_;     // with a rolling shutter, until the second frame
  std::vector<std::int64_t> first_repeated_ns_;  // stamps of the frames between the two, which repeat its image
};

}  // namespace vo
