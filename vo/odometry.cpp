#include "vo/odometry.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "vo/base/median.h"
#include "vo/base/stopwatch.h"
#include "vo/filter/landmark_table.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/filter/watched_filter.h"
#include "vo/filter_adapter.h"
#include "vo/frontend/adaptive_association.h"
#include "vo/frontend/association.h"
#include "vo/frontend/new_features.h"
#include "vo/frontend/rolling_shutter.h"
#include "vo/map/landmark_record.h"
#include "vo/start_trajectory.h"

namespace vo {

namespace {

// One odometry from one start.
struct Tracker {
  Tracker(const Camera& camera_, const Params& params_, const Prior& prior_, std::uint64_t seed_)
      : camera(camera_),
        params(params_),
        prior(prior_),
        seed(seed_),
        filter(MakeFilter(params, prior, seed)),
        scale(params.landmark.scale_sigma, prior.pose.p_WC),
        shutter(camera, params.features),
        first_sampler(FirstSampler(params.features)),
        border_px(std::max(first_sampler.margin(), Patch::kRadius + 1)),
        detector(camera, params, border_px),
        adaptive(camera) {}

  void Require(const Frame& frame) const {
    if (frame.image.cols != camera.width || frame.image.rows != camera.height)
      throw std::invalid_argument("image is " + std::to_string(frame.image.cols) + " x " +
                                  std::to_string(frame.image.rows) + ", the camera " + std::to_string(camera.width) +
                                  " x " + std::to_string(camera.height));
    if (last_stamp_ns) RequireIncreasing(frame.stamp_ns, *last_stamp_ns);
  }

  Estimate Process(const PreparedFrame& frame) {
    FrameDiagnostics diagnostics;
    if (last_stamp_ns) {
      Follow(frame, diagnostics);
      if (first_frame && has_matched) RestartFirstFrame(frame, diagnostics);
    } else {
      Stopwatch watch;
      Start(frame);
      diagnostics.ms_features += watch.Lap();
    }
    diagnostics.ms_features += frame.ms;
    diagnostics.landmarks = static_cast<int>(records.size());
    diagnostics.permanent = static_cast<int>(
        std::count_if(records.begin(), records.end(), [](const LandmarkRecord& r) { return r.permanent; }));
    return Answer(frame.frame.stamp_ns, diagnostics);
  }

  Estimate Answer(std::int64_t stamp_ns, const FrameDiagnostics& diagnostics) const {
    Estimate estimate = MakeEstimate(filter, scale, stamp_ns, diagnostics);
    estimate.covariance.topLeftCorner<6, 6>() += pose_before_start;
    return estimate;
  }

  void SetReadout(double readout_s) {
    params.features.readout_s = readout_s;
    shutter = RollingShutter(camera, params.features);
  }

  // As it was before its first frame.
  Tracker Restarted() const {
    Tracker again(camera, params, prior, seed);
    again.pose_before_start = pose_before_start;
    again.first_id = again.next_id = first_id;
    return again;
  }

  void Start(const PreparedFrame& frame) {
    if (shutter.on()) {
      first_frame = frame;
      first_frame->grey = frame.grey.clone();  // the memory is the caller's
    }
    Begin(frame, filter.belief().velocity);
  }

  // First frame: its landmarks are seen at the prior pose, with `velocity` during the readout.
  void Begin(const PreparedFrame& frame, const Vector6& velocity) {
    last_stamp_ns = frame.frame.stamp_ns;
    since_update = {0, VelocityCovariance()};
    start.Add(frame.frame.stamp_ns, filter.answer(), scale);
    AddLandmarks(DetectFeatures(frame), frame, velocity);
  }

  // One iteration of Algorithm 1; sections of docs/algorithm.md.
  void Follow(const PreparedFrame& frame, FrameDiagnostics& diagnostics) {
    const double dt = static_cast<double>(frame.frame.stamp_ns - *last_stamp_ns) * 1e-9;
    Stopwatch watch;
    const double coasting_s = since_update.dt_s;
    since_update.dt_s += dt;
    const auto associate = [&](const MotionInput& input) {
      since_update.input = input;
      return Associate(filter, records, camera, frame, border_px, since_update, params);  // line 3: section 7
    };
    Association association;
    if (params.motion.adaptive) {
      association = adaptive.PredictAndAssociate(filter, dt, coasting_s, frame.grey, associate);
    } else {
      filter.Predict(dt);  // line 2: (6)-(9), (12), (13)
      association = associate({});
    }
    diagnostics.ms_matching += watch.Lap();
    if (params.motion.adaptive && association.matches.empty() && filter.answer().initialising && !has_matched)
      return BeginAgain(frame, association, diagnostics);
    has_matched = true;

    Update(association.matches);  // lines 4-11: (15)-(17), (37)-(43)
    start.Add(frame.frame.stamp_ns, filter.answer(), scale);
    UpdateScores(association, params.score, records);  // section 6: (44)-(49)
    diagnostics.searched = static_cast<int>(association.searched.size());
    diagnostics.matched = static_cast<int>(association.matches.size());
    diagnostics.nis = association.nis;
    diagnostics.nis_dof = 2 * diagnostics.matched;
    diagnostics.repeated = association.repeated;
    views = std::move(association.views);
    left_out = std::move(association.left_out);
    diagnostics.ms_filter += watch.Lap();
    last_stamp_ns = frame.frame.stamp_ns;

    const std::vector<Filter::LandmarkBelief> beliefs = filter.LandmarkBeliefs();
    if (params.motion.adaptive && !filter.answer().initialising) UpdateTypicalDepth(association.matches, beliefs);
    std::vector<NewFeature> features = DetectFeatures(frame);            // section 7
    Forget(features.size(), beliefs);                                    // section 6: deletion
    AddLandmarks(std::move(features), frame, filter.belief().velocity);  // section 5
    diagnostics.ms_features += watch.Lap();
  }

  // Start with the present frame where no landmark of the first is found, at the pose of the prior. What the camera may
  // have moved until then stays in the covariance of all answers to come.
  void BeginAgain(const PreparedFrame& frame, Association& association, FrameDiagnostics& diagnostics) {
    filter.Update({});
    pose_before_start += filter.belief().covariance.topLeftCorner<6, 6>();
    first_id = next_id;
    *this = Restarted();
    diagnostics.searched = static_cast<int>(association.searched.size());
    diagnostics.repeated = association.repeated;
    Start(frame);
    views.insert(views.begin(), association.views.begin(), association.views.end());
  }

  // The velocity in the first frame is that of the prior, and its error shears the map through the rolling shutter. The
  // second frame measures it: both frames are processed again with the result, as a fixed-point iteration.
  void RestartFirstFrame(const PreparedFrame& second, FrameDiagnostics& diagnostics) {
    constexpr int kRounds = 6;
    const PreparedFrame first = *std::exchange(first_frame, std::nullopt);
    const double dt = static_cast<double>(second.frame.stamp_ns - first.frame.stamp_ns) * 1e-9;
    for (int round = 1; round < kRounds && diagnostics.matched >= FrameDiagnostics::kTrackedMatches; ++round) {
      const Vector6 velocity = MinusNear(filter.belief().pose, prior.pose, dt * prior.w_WC_C) / dt;
      *this = Restarted();
      Begin(first, velocity);
      Follow(second, diagnostics);
    }
  }

  void Update(std::span<const Match> matches) {
    scale.AbsorbChange(filter.Update(matches).scale_change);
    if (!matches.empty()) since_update = {0, VelocityCovariance()};
  }

  // Prior of new landmarks: the median depth of those in view, whose map may have any scale. Kept where too few are
  // known.
  void UpdateTypicalDepth(std::span<const Match> matches, std::span<const Filter::LandmarkBelief> beliefs) {
    constexpr double kKnown = 0.3, kRelativeSigma = 1.4;
    constexpr std::size_t kEnough = 8;
    const Pose& pose = filter.belief().pose;
    std::vector<double> depths;
    for (const Match& match : matches) {
      const Filter::LandmarkBelief& belief = beliefs[match.landmark];
      const double depth = (pose.q_WC.conjugate() * (belief.X_W - pose.p_WC)).z();
      if (belief.relative_sigma() < kKnown && depth > 0) depths.push_back(depth);
    }
    if (depths.size() < kEnough) return;
    const double depth = UpperMedian(std::move(depths));
    typical_depth = {1 / depth, kRelativeSigma / depth};
  }

  // Away from found landmarks and from predicted ones that were not searched for.
  std::vector<NewFeature> DetectFeatures(const PreparedFrame& frame) {
    std::vector<Eigen::Vector2d> occupied = left_out;
    for (const FeatureView& view : views)
      if (view.status == FeatureView::Status::matched) occupied.push_back(view.pixel);
    return detector.Detect(frame, std::move(occupied));
  }

  // Deletes landmarks, also to make room for `wanted` new ones; those searched for in this frame are kept.
  void Forget(std::size_t wanted, std::span<const Filter::LandmarkBelief> beliefs) {
    for (std::size_t n = 0; n < records.size(); ++n)
      records[n].permanent = beliefs[n].relative_sigma() < params.landmark.permanent_ratio;
    const std::vector<bool> keep = LandmarksToKeep(records, wanted, params.landmark, params.score);
    filter.KeepLandmarks(keep);
    Compact(keep, records);
  }

  void AddLandmarks(std::vector<NewFeature> features, const PreparedFrame& frame, const Vector6& velocity) {
    const auto capacity = static_cast<std::size_t>(params.landmark.max_landmarks) - records.size();
    std::vector<FirstView> first_views;
    for (const NewFeature& feature : LimitToCapacity(std::move(features), capacity, camera))
      first_views.push_back(AddRecord(feature, frame, velocity));
    filter.AddLandmarks(first_views);
  }

  FirstView AddRecord(const NewFeature& feature, const PreparedFrame& frame, const Vector6& velocity) {
    const Eigen::Vector2d pixel = feature.pixel.cast<double>();
    LandmarkRecord record;
    record.appearance = {frame.brisk.Describe(feature.pixel, first_sampler), CutPatch(frame.smooth, feature.pixel)};
    record.id = next_id++;
    record.score = params.score.initial;
    record.searched = true;
    records.push_back(record);
    views.push_back(
        {record.id, pixel, pixel, Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero(), FeatureView::Status::fresh});
    FirstView view = FirstSeen(shutter.Row(pixel), filter.belief().pose, velocity);
    // Later views are registered to the patch of the first, which thus defines the landmark: only the floor of the
    // noise is left.
    const double sigma_px =
        params.features.noise != MatchNoise::constant ? params.features.sigma_floor_px : params.features.sigma_px;
    view.R = PixelNoise(camera.LensJacobian(view.ray), sigma_px);
    view.depth = feature.depth ? feature.depth : typical_depth;
    return view;
  }

  Matrix6 VelocityCovariance() const { return filter.belief().covariance.bottomRightCorner<6, 6>(); }

  Camera camera;
  Params params;
  Prior prior;
  std::uint64_t seed;
  WatchedFilter filter;
  ScaleAmbiguity scale;
  StartTrajectory start;
  RollingShutter shutter;
  BriskSampler first_sampler;
  int border_px;
  NewFeatureDetector detector;
  std::vector<LandmarkRecord> records;  // in the order of the filter's landmarks
  std::vector<FeatureView> views;
  std::vector<Eigen::Vector2d> left_out;        // [px] predicted in this frame, beyond max_searched
  bool has_matched = false;                     // some frame
  Matrix6 pose_before_start = Matrix6::Zero();  // covariance of the path from the first image to the start
  std::optional<std::int64_t> last_stamp_ns;
  SinceUpdate since_update;
  AdaptiveAssociation adaptive;
  std::optional<KnownDepth> typical_depth;
  int first_id = 0, next_id = 0;             // of the landmarks since this start; of the next one
  std::optional<PreparedFrame> first_frame;  // with a rolling shutter, until the second frame
};

// A start whose velocity the prior does not know well is made twice.
Prior WithVagueVelocity(Prior prior) {
  constexpr double kFactor = 4;  // of the standard deviation
  prior.velocity_covariance *= kFactor * kFactor;
  return prior;
}

}  // namespace

// With an unknown motion, two trackers make the start, with a vague prior of the velocity and with that given: the first
// may take a wrong mode where the camera hardly moves at first, the second where it moves quickly. One answers, the
// other takes over where its matches fit clearly better; the start over, one goes on.
struct Odometry::Impl {
  Impl(const Camera& camera, const Params& params, const Prior& prior_, std::uint64_t seed) : prior(prior_) {
    if (params.motion.adaptive && params.filter.start_window > params.filter.lag)
      trackers.emplace_back(camera, params, WithVagueVelocity(prior), seed);
    trackers.emplace_back(camera, params, prior, seed);
  }

  Estimate Process(const PreparedFrame& frame) {
    constexpr double kClearly = 1.15;
    std::vector<Estimate> estimates;
    for (Tracker& tracker : trackers) estimates.push_back(tracker.Process(frame));
    const auto score = [](const Tracker& tracker) { return tracker.filter.answer().start_score; };
    if (trackers.size() > 1 && score(trackers[1]) > kClearly * score(trackers[0])) {
      std::swap(trackers[0], trackers[1]);
      std::swap(estimates[0], estimates[1]);
    }
    const auto ended = [](const Tracker& tracker) { return !tracker.filter.answer().initialising; };
    if (std::ranges::any_of(trackers, ended)) trackers.erase(trackers.begin() + 1, trackers.end());
    FrameDiagnostics& diagnostics = estimates[0].diagnostics;
    for (std::size_t i = 1; i < estimates.size(); ++i) {  // the frame is prepared once
      diagnostics.ms_features += estimates[i].diagnostics.ms_features - frame.ms;
      diagnostics.ms_matching += estimates[i].diagnostics.ms_matching;
      diagnostics.ms_filter += estimates[i].diagnostics.ms_filter;
    }
    return estimates[0];
  }
  void SetReadout(double readout_s) {
    for (Tracker& tracker : trackers) tracker.SetReadout(readout_s);
  }
  const Tracker& tracker() const { return trackers[0]; }

  Prior prior;
  std::vector<Tracker> trackers;  // the first answers
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
  reissued_ = impl_->tracker().start.reissued();
  return calibration_ ? Calibrated(frame, estimate) : estimate;
}

// The frames until then are tracked again with the first readout time that is known: a map that was begun with another
// is sheared. A later change holds from the next frame on.
Estimate Odometry::Calibrated(const PreparedFrame& frame, const Estimate& estimate) {
  Stopwatch watch;
  const bool starting = calibration_->starting();
  if (starting) {
    first_frames_.push_back({frame.frame.stamp_ns, frame.grey.clone()});  // the memory is the caller's
    first_places_.push_back(estimate.pose.p_WC);
  }
  if (!calibration_->Add(estimate.stamp_ns, estimate.pose, impl_->tracker().views)) return estimate;
  const bool changed = ChangeReadout();
  Estimate out = changed && starting ? TrackFirstFramesAgain() : estimate;
  if (!calibration_->starting()) first_frames_.clear();
  out.diagnostics.ms_filter += watch.Lap();
  return out;
}

// Whether it is another one from now on.
bool Odometry::ChangeReadout() {
  const std::optional<double> readout_s = calibration_->ChangeReadout();
  if (!readout_s) return false;
  impl_->SetReadout(*readout_s);
  return true;
}

// With the readout time that impl_ has now. Where the scale is not known, the answers keep that of those already given.
Estimate Odometry::TrackFirstFramesAgain() {
  constexpr int kRounds = 3;
  Estimate last;
  const Eigen::Vector3d origin = impl_->prior.pose.p_WC;
  for (int round = 1; round <= kRounds; ++round) {
    const Tracker& tracker = impl_->tracker();
    impl_ = std::make_unique<Impl>(tracker.camera, tracker.params, impl_->prior, tracker.seed);
    calibration_->Restart();
    reissued_.clear();
    double product = 0, square = 0;
    for (std::size_t k = 0; k < first_frames_.size(); ++k) {
      last = impl_->Process(PreparedFrame(first_frames_[k]));
      reissued_.push_back({last.stamp_ns, last.pose});
      const std::vector<StampedPose>& start = impl_->tracker().start.reissued();
      std::copy(start.begin(), start.end(), reissued_.end() - static_cast<std::ptrdiff_t>(start.size()));
      calibration_->Add(last.stamp_ns, last.pose, impl_->tracker().views);
      const Eigen::Vector3d from_start = last.pose.p_WC - origin;
      product += from_start.dot(first_places_[k] - origin);
      square += from_start.squaredNorm();
    }
    if (product > 0) {
      impl_->trackers[0].scale.AbsorbChange(square / product);
      for (StampedPose& pose : reissued_) pose.pose.p_WC = origin + product / square * (pose.pose.p_WC - origin);
    }
    if (round == kRounds || !ChangeReadout()) break;
  }
  return impl_->tracker().Answer(last.stamp_ns, last.diagnostics);
}

std::vector<MapPoint> Odometry::Map() const {
  const Tracker& tracker = impl_->tracker();
  std::vector<MapPoint> points = MakeMap(tracker.filter, tracker.scale);
  for (std::size_t n = 0; n < points.size(); ++n) {
    points[n].id = tracker.records[n].id;
    points[n].permanent = tracker.records[n].permanent;
  }
  return points;
}

const std::vector<StampedPose>& Odometry::Reissued() const { return reissued_; }

const std::vector<FeatureView>& Odometry::Features() const { return impl_->tracker().views; }

std::optional<CalibrationEstimate> Odometry::Calibration() const {
  return calibration_ ? std::optional(calibration_->Estimate()) : std::nullopt;
}

}  // namespace vo
