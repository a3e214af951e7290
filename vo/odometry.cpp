#include "vo/odometry.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "vo/base/stopwatch.h"
#include "vo/tracker.h"

namespace vo {

namespace {

// Prior with a larger velocity covariance, for the first of the two trackers of a start.
Prior WithVagueVelocity(Prior prior) {
  constexpr double kFactor = 4;  // of the standard deviation
  prior.velocity_covariance *= kFactor * kFactor;
  return prior;
}

}  // namespace

// With an unknown motion, two trackers process the start, with a vague prior of the velocity and with that given: the
// first may converge to a wrong mode where the camera hardly moves at first, the second where it moves quickly. One
// answers, the other takes over where its matches fit clearly better; after the start one continues.
struct Odometry::Impl {
  Impl(const Camera& camera_, const Params& params_, const Prior& prior_, std::uint64_t seed_)
      : camera(camera_), params(params_), prior(prior_), seed(seed_) {
    if (params.motion.adaptive && params.filter.start_window > params.filter.lag)
      trackers.emplace_back(camera, params, WithVagueVelocity(prior), seed);
    trackers.emplace_back(camera, params, prior, seed);
  }

  Estimate Process(const PreparedFrame& frame) {
    constexpr double kClearly = 1.15;   // in each frame
    constexpr double kAtTheEnd = 1.06;  // in the last one
    std::vector<Estimate> estimates;
    for (Tracker& tracker : trackers) estimates.push_back(tracker.Process(frame));
    const auto score = [](const Tracker& tracker) { return tracker.answer().start_score; };
    const bool end =
        std::ranges::any_of(trackers, [](const Tracker& tracker) { return !tracker.answer().initialising; });
    if (trackers.size() > 1 && score(trackers[1]) > (end ? kAtTheEnd : kClearly) * score(trackers[0])) {
      std::swap(trackers[0], trackers[1]);
      std::swap(estimates[0], estimates[1]);
    }
    if (trackers.size() > 1 || !end) start_score = score(trackers[0]);
    if (end) trackers.erase(trackers.begin() + 1, trackers.end());
    FrameDiagnostics& diagnostics = estimates[0].diagnostics;
    for (std::size_t i = 1; i < estimates.size(); ++i) {  // the frame is prepared once
      diagnostics.ms_features += estimates[i].diagnostics.ms_features - frame.ms;
      diagnostics.ms_matching += estimates[i].diagnostics.ms_matching;
      diagnostics.ms_filter += estimates[i].diagnostics.ms_filter;
    }
    return estimates[0];
  }
  void SetReadout(double readout_s) {
    params.features.readout_s = readout_s;
    for (Tracker& tracker : trackers) tracker.SetReadout(readout_s);
  }
  std::unique_ptr<Impl> Restarted() const { return std::make_unique<Impl>(camera, params, prior, seed); }
  const Tracker& tracker() const { return trackers[0]; }

  Camera camera;
  Params params;
  Prior prior;
  std::uint64_t seed;
  std::vector<Tracker> trackers;  // the first answers
  double start_score = 0;         // FilterAnswer's, the start's last
};

Odometry::Odometry(const Camera& camera, const Params& params, const Prior& prior, std::uint64_t seed)
    : impl_(std::make_unique<Impl>(camera, params, prior, seed)) {
  if (!params.calibration.estimate) return;
  calibration_.emplace(camera, params.features.readout_s ? params.features.readout_s : camera.readout_s);
}
Odometry::~Odometry() = default;
Odometry::Odometry(Odometry&&) noexcept = default;

Estimate Odometry::Track(const Frame& frame) {
  impl_->tracker().Require(frame);
  return Track(PreparedFrame(frame));
}

Estimate Odometry::Track(const PreparedFrame& frame) {
  impl_->tracker().Require(frame.frame);
  const Estimate estimate = impl_->Process(frame);
  reissued_ = impl_->tracker().reissued();
  return calibration_ ? Calibrated(frame, estimate) : estimate;
}

// The frames so far are tracked again with the first estimated readout time: a map that was begun with another one is
// sheared. A later change takes effect from the next frame on.
Estimate Odometry::Calibrated(const PreparedFrame& frame, const Estimate& estimate) {
  Stopwatch watch;
  const bool starting = calibration_->starting();
  if (starting) {
    first_frames_.push_back({frame.frame.stamp_ns, frame.grey.clone()});  // the memory is the caller's
    first_poses_.push_back(estimate.pose);
  }
  Estimate out = estimate;
  if (calibration_->Add(estimate.stamp_ns, estimate.pose, impl_->tracker().views())) {
    if (ChangeReadout() && starting) out = TrackFirstFramesAgain(estimate);
    if (!calibration_->starting()) first_frames_.clear();
  }
  out.diagnostics.ms_filter += watch.Lap();
  return out;
}

// Sets the estimated readout time; whether it has changed.
bool Odometry::ChangeReadout() {
  const std::optional<double> readout_s = calibration_->ChangeReadout();
  if (!readout_s) return false;
  impl_->SetReadout(*readout_s);
  return true;
}

// With the readout time that impl_ has now. Where the scale is unknown, the answers keep that of those already given.
// Where the turns differ by more than a readout time changes them, one of both starts is in a wrong mode: that which
// explains its images worse. If it is the new one, the first continues, with its `estimate`.
Estimate Odometry::TrackFirstFramesAgain(const Estimate& estimate) {
  constexpr int kRounds = 3;
  constexpr double kOtherMode = 0.3;  // [rad]
  std::unique_ptr<Impl> first = std::exchange(impl_, impl_->Restarted());
  SelfCalibration calibration = std::exchange(*calibration_, calibration_->Restarted());
  std::vector<StampedPose> reissued = reissued_;
  Estimate last;
  double turn = 0;  // largest between the answers
  const Eigen::Vector3d origin = impl_->prior.pose.p_WC;
  for (int round = 1;; ++round) {
    reissued_.clear();
    double product = 0, square = 0;
    turn = 0;
    for (std::size_t k = 0; k < first_frames_.size(); ++k) {
      last = impl_->Process(PreparedFrame(first_frames_[k]));
      reissued_.push_back({last.stamp_ns, last.pose});
      const std::vector<StampedPose>& start = impl_->tracker().reissued();
      std::copy(start.begin(), start.end(), reissued_.end() - static_cast<std::ptrdiff_t>(start.size()));
      calibration_->Add(last.stamp_ns, last.pose, impl_->tracker().views());
      turn = std::max(turn, last.pose.q_WC.angularDistance(first_poses_[k].q_WC));
      const Eigen::Vector3d from_start = last.pose.p_WC - origin;
      product += from_start.dot(first_poses_[k].p_WC - origin);
      square += from_start.squaredNorm();
    }
    if (product > 0) {
      impl_->trackers[0].KeepScale(square / product);
      for (StampedPose& pose : reissued_) pose.pose.p_WC = origin + product / square * (pose.pose.p_WC - origin);
    }
    calibration_->EndFit();  // of the last window too
    if (round == kRounds || !ChangeReadout()) break;
    impl_ = impl_->Restarted();
    *calibration_ = calibration_->Restarted();
  }
  if (turn < kOtherMode || impl_->start_score >= first->start_score)
    return impl_->tracker().Answer(last.stamp_ns, last.diagnostics);
  impl_ = std::move(first);
  *calibration_ = std::move(calibration);
  reissued_ = std::move(reissued);
  return estimate;
}

std::vector<MapPoint> Odometry::Map() const { return impl_->tracker().Map(); }

const std::vector<StampedPose>& Odometry::Reissued() const { return reissued_; }

const std::vector<FeatureView>& Odometry::Features() const { return impl_->tracker().views(); }

std::optional<CalibrationEstimate> Odometry::Calibration() const {
  return calibration_ ? std::optional(calibration_->Estimate()) : std::nullopt;
}

}  // namespace vo
