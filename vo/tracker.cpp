#include "vo/tracker.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "vo/base/median.h"
#include "vo/base/source.h"
#include "vo/base/stopwatch.h"
#include "vo/filter/landmark_table.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/filter_adapter.h"

namespace vo {
namespace {

constexpr std::size_t kEnoughToBegin = 20;  // features, where no landmark is found
constexpr double kKnown = 0.3;              // relative sigma of a depth that is known

}  // namespace

Tracker::Tracker(const Camera& camera, const Params& params, const Prior& prior, std::uint64_t seed)
    : camera_(camera),
      params_(params),
      prior_(prior),
      seed_(seed),
      filter_(MakeFilter(params, prior, seed)),
      scale_(params.landmark.scale_sigma, prior.pose.p_WC),
      shutter_(camera, params.features),
      first_sampler_(FirstSampler(params.features)),
      border_px_(std::max(first_sampler_.margin(), Patch::kRadius)),
      detector_(camera, params, border_px_),
      budget_(params.features.max_searched),
      adaptive_(camera, params.motion),
      relocaliser_(camera, params.features, border_px_) {}

void Tracker::Require(const Frame& frame) const {
  if (frame.image.cols != camera_.width || frame.image.rows != camera_.height)
    throw std::invalid_argument("image is " + std::to_string(frame.image.cols) + " x " +
                                std::to_string(frame.image.rows) + ", the camera " + std::to_string(camera_.width) +
                                " x " + std::to_string(camera_.height));
  if (last_stamp_ns_) RequireIncreasing(frame.stamp_ns, *last_stamp_ns_);
}

Estimate Tracker::Process(const PreparedFrame& frame) {
  FrameDiagnostics diagnostics;
  if (last_stamp_ns_) {
    Follow(frame, diagnostics);
    if (first_frame_ && has_matched_) RestartFirstFrame(frame, diagnostics);
  } else {
    Stopwatch watch;
    Start(frame);
    diagnostics.ms_features += watch.Lap();
  }
  diagnostics.ms_features += frame.ms;
  diagnostics.landmarks = static_cast<int>(records_.size());
  diagnostics.permanent = static_cast<int>(
      std::count_if(records_.begin(), records_.end(), [](const LandmarkRecord& r) { return r.permanent; }));
  return Answer(frame.frame.stamp_ns, diagnostics);
}

Estimate Tracker::Answer(std::int64_t stamp_ns, const FrameDiagnostics& diagnostics) const {
  Estimate estimate = MakeEstimate(filter_, scale_, stamp_ns, diagnostics);
  estimate.covariance.topLeftCorner<6, 6>() += pose_before_start_ + pose_before_loss_;
  return estimate;
}

void Tracker::SetReadout(double readout_s) {
  params_.features.readout_s = readout_s;
  shutter_ = RollingShutter(camera_, params_.features);
}

Tracker Tracker::Restarted() const {
  Tracker again(camera_, params_, prior_, seed_);
  again.pose_before_start_ = pose_before_start_;
  again.exposure_ = exposure_;
  again.first_id_ = again.next_id_ = first_id_;
  return again;
}

void Tracker::Start(const PreparedFrame& frame) {
  if (shutter_.on()) {
    first_frame_ = frame;
    first_frame_->grey = frame.grey.clone();  // the memory is the caller's
  }
  Begin(frame, filter_.belief().velocity);
}

// First frame: its landmarks are seen at the prior pose, with `velocity` during the readout.
void Tracker::Begin(const PreparedFrame& frame, const Vector6& velocity) {
  last_stamp_ns_ = frame.frame.stamp_ns;
  since_update_ = {0, VelocityCovariance()};
  start_.Add(frame.frame.stamp_ns, filter_.answer(), scale_);
  AddLandmarks(DetectFeatures(frame), frame, velocity);
  if (params_.motion.adaptive) adaptive_.Keep(frame.grey);
}

double Tracker::SinceLast(std::int64_t stamp_ns) const {
  return static_cast<double>(stamp_ns - *last_stamp_ns_) * 1e-9;
}

// A frame whose image repeats the last one: predicted, not associated.
void Tracker::Repeat(std::int64_t stamp_ns) {
  const double dt = SinceLast(stamp_ns);
  since_update_.dt_s += dt;
  adaptive_.Predict(filter_, dt, coasting_s_);
  Update({});
  start_.Add(stamp_ns, filter_.answer(), scale_);
  last_stamp_ns_ = stamp_ns;
  views_.clear();
}

// One iteration of Algorithm 1; sections of docs/algorithm.md.
void Tracker::Follow(const PreparedFrame& frame, FrameDiagnostics& diagnostics) {
  if (params_.motion.adaptive && adaptive_.IsRepeated(frame.grey)) {  // section 7.1
    if (first_frame_) first_repeated_ns_.push_back(frame.frame.stamp_ns);
    return Repeat(frame.frame.stamp_ns);
  }
  const double dt = SinceLast(frame.frame.stamp_ns);
  Stopwatch watch;
  since_update_.dt_s += dt;
  ++frames_;
  const auto associate = [&](const MotionInput& input, Search search) {
    since_update_.input = input;
    return Associate(filter_, records_, camera_, frame, border_px_, since_update_, search, params_,
                     noise_level_.value(), exposure_.seconds(), budget_);  // line 3: section 7
  };
  Association association;
  if (params_.motion.adaptive) {
    association = adaptive_.PredictAndAssociate(
        filter_, dt, coasting_s_, frame.grey, associate,
        [&](const Association& now, bool failed) { return Relocalise(frame, now, failed); });
  } else {
    filter_.Predict(dt);  // line 2: (6)-(9), (12), (13)
    association = associate({}, Search::usual);
  }
  if (params_.motion.adaptive && params_.features.subpixel) exposure_.Learn(association.moving, records_, frame.smooth);
  diagnostics.ms_matching += watch.Lap();
  if (params_.motion.adaptive && association.matches.empty() && filter_.answer().initialising && !has_matched_)
    return BeginAgain(frame, association, diagnostics);
  has_matched_ = true;

  if (std::ranges::any_of(association.matches, [&](const Match& m) { return records_[m.landmark].lost; }))
    pose_before_loss_.setZero();
  if (!association.matches.empty()) known_before_loss_ = pose_before_loss_;
  const Eigen::Vector3d previous = filter_.belief().pose.p_WC;
  Update(association.matches);  // lines 4-11: (15)-(17), (37)-(43)
  coasting_s_ = association.matches.empty() ? coasting_s_ + dt : 0;
  // The prior does not have the velocity in the first frame; the second measures it.
  if (frames_ == 1)
    for (LandmarkRecord& record : records_) SetFirstVelocity(record, filter_.belief().velocity);
  start_.Add(frame.frame.stamp_ns, filter_.answer(), scale_);
  UpdateScores(association, params_.score, records_);  // section 6: (44)-(49)
  noise_level_.Learn(association);
  if (association.matches.empty()) noise_level_ = {};  // the next match is after a gap
  path_length_ += (filter_.belief().pose.p_WC - previous).norm();
  for (const Match& match : association.matches) records_[match.landmark].path_length = path_length_;
  diagnostics.searched = static_cast<int>(association.searched.size());
  diagnostics.matched = static_cast<int>(association.matches.size());
  diagnostics.nis = association.nis;
  diagnostics.nis_dof = 2 * diagnostics.matched;
  diagnostics.repeated = association.repeated;
  views_ = std::move(association.views);
  left_out_ = std::move(association.left_out);
  if (adapts_map()) budget_ = NextBudget(association, params_.features);
  diagnostics.ms_filter += watch.Lap();
  last_stamp_ns_ = frame.frame.stamp_ns;

  const std::vector<Filter::LandmarkBelief> beliefs = filter_.LandmarkBeliefs();
  if (adapts_map()) UpdateTypicalDepth(association.matches, beliefs);
  std::vector<NewFeature> features = DetectFeatures(frame);  // section 7
  if (params_.motion.adaptive && association.matches.empty()) {
    if (features.size() < kEnoughToBegin)
      features.clear();  // of noise, in darkness
    else
      LoseLandmarks();
  }
  if (!association.matches.empty() || !features.empty()) adaptive_.Keep(frame.grey);
  Forget(features.size(), beliefs);                                     // section 6: deletion
  AddLandmarks(std::move(features), frame, filter_.belief().velocity);  // section 5
  diagnostics.ms_features += watch.Lap();
}

// Restarts with the present frame where no landmark of the first is found, at the pose of the prior. The possible
// motion until then is added to the covariance of all later answers.
void Tracker::BeginAgain(const PreparedFrame& frame, Association& association, FrameDiagnostics& diagnostics) {
  filter_.Update({});
  pose_before_start_ += filter_.belief().covariance.topLeftCorner<6, 6>();
  first_id_ = next_id_;
  *this = Restarted();
  diagnostics.searched = static_cast<int>(association.searched.size());
  diagnostics.repeated = association.repeated;
  Start(frame);
  views_.insert(views_.begin(), association.views.begin(), association.views.end());
}

// The velocity in the first frame is that of the prior, and its error shears the map through the rolling shutter. The
// second frame measures it: both frames are processed again with the result, as a fixed-point iteration.
void Tracker::RestartFirstFrame(const PreparedFrame& second, FrameDiagnostics& diagnostics) {
  constexpr int kRounds = 6;
  const PreparedFrame first = *std::exchange(first_frame_, std::nullopt);
  const std::vector<std::int64_t> repeated_ns = first_repeated_ns_;
  const double dt = static_cast<double>(second.frame.stamp_ns - first.frame.stamp_ns) * 1e-9;
  for (int round = 1; round < kRounds && diagnostics.matched >= FrameDiagnostics::kTrackedMatches; ++round) {
    const Vector6 velocity = MinusNear(filter_.belief().pose, prior_.pose, dt * prior_.w_WC_C) / dt;
    const std::optional<MotionInput> input = adaptive_.repeated_input();
    *this = Restarted();
    Begin(first, velocity);
    for (const std::int64_t stamp_ns : repeated_ns) Repeat(stamp_ns);
    adaptive_.BeginWith(input);
    Follow(second, diagnostics);
  }
}

// Correction of the path where landmarks that were not matched for a while are recognised.
std::optional<PathCorrection> Tracker::Relocalise(const PreparedFrame& frame, const Association& association,
                                                  bool failed) const {
  constexpr int kEvery = 6;       // [frames]
  constexpr double kOlder = 0.1;  // of the matches, enough to tie the path to the recognised part of the map
  constexpr double kDrift = 0.1;  // largest relative drift of the path since then, where the prediction has not failed
  constexpr double kDisplaced_px = 4;  // median, below which the ordinary search finds them
  if (filter_.answer().initialising) return std::nullopt;
  if (!failed && frames_ % kEvery != 0) return std::nullopt;
  std::vector<int> unseen;
  for (std::size_t n = 0; n < records_.size(); ++n)
    if (records_[n].unseen()) unseen.push_back(static_cast<int>(n));
  if (unseen.size() < Relocaliser::kLeastInliers) return std::nullopt;
  const auto tied = [&](int first) {
    const auto older = std::ranges::count_if(association.matches, [&](const Match& m) { return m.landmark < first; });
    return static_cast<double>(older) > kOlder * static_cast<double>(association.matches.size());
  };
  if (!failed && tied(unseen[Relocaliser::kLeastInliers - 1] + 1)) return std::nullopt;  // whatever the inliers
  const std::vector<Filter::LandmarkBelief> beliefs = filter_.LandmarkBeliefs();
  std::vector<KnownPoint> points;
  for (const int n : unseen) points.push_back({&records_[n].appearance.descriptor, beliefs[n].X_W});
  const std::optional<Relocalisation> found = relocaliser_.Find(frame, points);
  if (!found) return std::nullopt;
  const int first = unseen[found->inliers.back()] + 1;
  if (!failed && tied(first)) return std::nullopt;
  const Pose prediction = filter_.Reference().prediction.mean;
  double last_seen = 0;  // path length
  for (const int i : found->inliers) last_seen = std::max(last_seen, records_[unseen[i]].path_length);
  if (!failed && (found->pose.p_WC - prediction.p_WC).norm() > kDrift * (path_length_ - last_seen)) return std::nullopt;
  const Pose predicted = Inverse(prediction);
  std::vector<double> displacements;  // on the plane z = 1
  for (const int i : found->inliers) {
    const Eigen::Vector3d& X_W = points[static_cast<std::size_t>(i)].X_W;
    const Eigen::Vector3d was = predicted.p_WC + predicted.q_WC * X_W;
    const Pose seen = Inverse(found->pose);
    const Eigen::Vector3d is = seen.p_WC + seen.q_WC * X_W;
    displacements.push_back(was.z() > 0 ? (was.hnormalized() - is.hnormalized()).norm() : INFINITY);
  }
  if (UpperMedian(std::move(displacements)) * camera_.fx < kDisplaced_px) return std::nullopt;
  return PathCorrection{found->pose, first};
}

// Loss of all landmarks: the image has features, but none of the map's. After resampling the next samples are
// independent of the present covariance, which is therefore kept.
void Tracker::LoseLandmarks() {
  for (LandmarkRecord& record : records_) record.lost = true;
  pose_before_loss_ = known_before_loss_ + filter_.belief().covariance.topLeftCorner<6, 6>();
}

void Tracker::Update(std::span<const Match> matches) {
  scale_.AbsorbChange(filter_.Update(matches).scale_change);
  if (!matches.empty()) since_update_ = {0, VelocityCovariance()};
}

// Prior of new landmarks: the median depth of those in view, whose map may have any scale. Unchanged where too few
// depths are known.
void Tracker::UpdateTypicalDepth(std::span<const Match> matches, std::span<const Filter::LandmarkBelief> beliefs) {
  constexpr double kRelativeSigma = 1.4;
  constexpr std::size_t kEnough = 8;
  const Pose& pose = filter_.belief().pose;
  std::vector<double> depths;
  for (const Match& match : matches) {
    const Filter::LandmarkBelief& belief = beliefs[match.landmark];
    const double depth = (pose.q_WC.conjugate() * (belief.X_W - pose.p_WC)).z();
    if (belief.relative_sigma() < kKnown && depth > 0) depths.push_back(depth);
  }
  if (depths.size() < kEnough) return;
  const double depth = UpperMedian(std::move(depths));
  typical_depth_ = {1 / depth, kRelativeSigma / depth};
}

// Away from found landmarks and from predicted ones that were not searched for.
std::vector<NewFeature> Tracker::DetectFeatures(const PreparedFrame& frame) {
  std::vector<Eigen::Vector2d> occupied;
  for (const LeftOut& one : left_out_) occupied.push_back(one.pixel);
  for (const FeatureView& view : views_)
    if (view.status == FeatureView::Status::matched) occupied.push_back(view.pixel);
  return detector_.Detect(frame, std::move(occupied), adapts_map() ? params_.features.enough_matches : 0);
}

// Deletes landmarks, also to make room for `wanted` new ones; those searched for in this frame are kept.
void Tracker::Forget(std::size_t wanted, std::span<const Filter::LandmarkBelief> beliefs) {
  for (std::size_t n = 0; n < records_.size(); ++n) {
    records_[n].permanent = beliefs[n].relative_sigma() < params_.landmark.permanent_ratio;
    records_[n].known = beliefs[n].relative_sigma() < kKnown;
  }
  const std::vector<bool> keep = LandmarksToKeep(records_, wanted, params_.landmark, params_.score);
  filter_.KeepLandmarks(keep);
  Compact(keep, records_);
}

void Tracker::AddLandmarks(std::vector<NewFeature> features, const PreparedFrame& frame, const Vector6& velocity) {
  const auto capacity = static_cast<std::size_t>(params_.landmark.max_landmarks) - records_.size();
  std::vector<FirstView> first_views;
  for (const NewFeature& feature : LimitToCapacity(std::move(features), capacity, camera_))
    first_views.push_back(AddRecord(feature, frame, velocity));
  filter_.AddLandmarks(first_views);
}

void Tracker::SetFirstVelocity(LandmarkRecord& record, const Vector6& velocity) const {
  record.first_v_C = filter_.belief().pose.q_WC.conjugate() * velocity.head<3>();
  record.first_w_C = velocity.tail<3>();
}

FirstView Tracker::AddRecord(const NewFeature& feature, const PreparedFrame& frame, const Vector6& velocity) {
  const Eigen::Vector2d pixel = feature.pixel.cast<double>();
  LandmarkRecord record;
  record.appearance = {frame.brisk.Describe(feature.pixel, first_sampler_), CutPatch(frame.smooth, feature.pixel)};
  record.id = next_id_++;
  SetFirstVelocity(record, velocity);
  record.score = params_.score.initial;
  record.path_length = path_length_;
  record.searched = true;
  records_.push_back(record);
  views_.push_back(
      {record.id, pixel, pixel, Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero(), FeatureView::Status::fresh});
  FirstView view = FirstSeen(shutter_.Row(pixel), filter_.belief().pose, velocity);
  // Later views are registered to the patch of the first: its error is that of the point in the patch.
  const FeatureParams& features = params_.features;
  view.R = PixelNoise(camera_.LensJacobian(view.ray),
                      features.noise != MatchNoise::constant ? features.first_view_px : features.sigma_px);
  view.depth = feature.depth ? feature.depth : typical_depth_;
  return view;
}

Matrix6 Tracker::VelocityCovariance() const { return filter_.belief().covariance.bottomRightCorner<6, 6>(); }

std::vector<MapPoint> Tracker::Map() const {
  std::vector<MapPoint> points = MakeMap(filter_, scale_);
  for (std::size_t n = 0; n < points.size(); ++n) {
    points[n].id = records_[n].id;
    points[n].permanent = records_[n].permanent;
  }
  return points;
}

void Tracker::KeepScale(double change) { scale_.AbsorbChange(change); }

}  // namespace vo
