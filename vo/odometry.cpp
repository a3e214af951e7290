#include "vo/odometry.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>

#include "vo/estimate.h"
#include "vo/features/corner_detector.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/frontend/association.h"
#include "vo/frontend/rolling_shutter.h"
#include "vo/frontend/spread.h"
#include "vo/frontend/target.h"
#include "vo/map/existence.h"
#include "vo/map/forgetting.h"

namespace vo {
namespace {

constexpr int kStartRounds = 6;  // of the second frame, through a rolling shutter

struct NewCorner {
  Eigen::Vector2i pixel;
  std::optional<KnownDepth> depth;  // of the target's
};

}  // namespace

struct Odometry::Impl {
  Impl(const Camera& camera_, const Params& params_, const Prior& prior_, std::uint64_t seed_)
      : camera(camera_),
        params(Checked(params_)),
        prior(prior_),
        seed(seed_),
        filter(MakeFilter(params, prior, seed)),
        scale(params.landmark.scale_sigma, prior.pose.p_WC),
        shutter(camera, params.features),
        first_sampler(FirstSampler(params.features)),
        border_px(std::max(first_sampler.margin(), Patch::kRadius + 1)) {}

  void Require(const Frame& frame) const;
  Estimate Process(const PreparedFrame& prepared);
  void Begin(const PreparedFrame& prepared, const Vector6& velocity);
  void Follow(const PreparedFrame& prepared, FrameDiagnostics& diagnostics);
  void BeginAgain(const PreparedFrame& second, FrameDiagnostics& diagnostics);
  void SeenNow() { last_seen = {0, filter.belief().covariance.bottomRightCorner<6, 6>()}; }
  void UpdateScores(const Association& association);
  std::vector<NewCorner> NewCorners(const PreparedFrame& prepared);
  std::vector<NewCorner> TargetCorners(const PreparedFrame& prepared);
  void Forget(std::size_t wanted);
  std::vector<NewCorner> ThatFit(std::vector<NewCorner> corners) const;
  void AddFeatures(const std::vector<NewCorner>& corners, const PreparedFrame& prepared, const Vector6& velocity);
  void Add(const NewCorner& corner, const PreparedFrame& prepared, const Vector6& velocity,
           std::vector<FirstView>& first);
  Estimate Answer(std::int64_t stamp_ns, FrameDiagnostics diagnostics) const;

  Camera camera;
  Params params;
  Prior prior;
  std::uint64_t seed;
  WatchedFilter filter;
  UnknownScale scale;
  RollingShutter shutter;
  BriskSampler first_sampler;
  int border_px;
  std::vector<LandmarkRecord> records;  // in the order of the filter's landmarks
  std::vector<FeatureView> views;
  std::vector<Eigen::Vector2d> left_out;  // [px] of this frame: predicted, but not looked for
  std::optional<std::int64_t> last_stamp_ns;
  LastSeen last_seen;
  int next_id = 0;
  int target_frames = 0;                     // in which the target may still be looked for
  std::optional<PreparedFrame> first_frame;  // kept until the second tells how fast its rows were passed over
};

void Odometry::Impl::Require(const Frame& frame) const {
  if (frame.image.cols != camera.width || frame.image.rows != camera.height)
    throw std::invalid_argument("image is " + std::to_string(frame.image.cols) + " x " +
                                std::to_string(frame.image.rows) + ", the camera " + std::to_string(camera.width) +
                                " x " + std::to_string(camera.height));
  if (last_stamp_ns) RequireIncreasing(frame.stamp_ns, *last_stamp_ns);
}

Estimate Odometry::Impl::Process(const PreparedFrame& prepared) {
  FrameDiagnostics diagnostics;
  if (last_stamp_ns) {
    Follow(prepared, diagnostics);
    if (first_frame) BeginAgain(prepared, diagnostics);
  } else {
    Stopwatch watch;
    if (shutter.on()) {
      first_frame = prepared;
      first_frame->grey = prepared.grey.clone();  // the caller's memory
    }
    Begin(prepared, filter.belief().velocity);
    diagnostics.ms_features += watch.Lap();
  }
  diagnostics.ms_features += prepared.ms;
  return Answer(prepared.frame.stamp_ns, diagnostics);
}

// With a filter that has seen nothing yet.
void Odometry::Impl::Begin(const PreparedFrame& prepared, const Vector6& velocity) {
  records.clear();
  views.clear();
  left_out.clear();
  next_id = 0;
  target_frames = params.target.columns > 0 ? params.target.frames : 0;
  last_stamp_ns = prepared.frame.stamp_ns;
  SeenNow();
  AddFeatures(ThatFit(NewCorners(prepared)), prepared, velocity);
}

void Odometry::Impl::Follow(const PreparedFrame& prepared, FrameDiagnostics& diagnostics) {
  const std::int64_t stamp_ns = prepared.frame.stamp_ns;
  const double dt = static_cast<double>(stamp_ns - *last_stamp_ns) * 1e-9;
  Stopwatch watch;
  filter.Predict(dt);
  last_seen.ago += dt;
  Association association = Associate(filter, records, camera, prepared, border_px, last_seen, params);
  diagnostics.ms_matching += watch.Lap();
  filter.Update(association.matches);
  if (!association.matches.empty()) SeenNow();
  scale.Lengthened(filter.lengthened());
  UpdateScores(association);
  diagnostics.searched = static_cast<int>(association.searched.size());
  diagnostics.matched = static_cast<int>(association.matches.size());
  diagnostics.nis = association.nis;
  diagnostics.nis_dof = 2 * diagnostics.matched;
  views = std::move(association.views);
  left_out = std::move(association.left_out);
  diagnostics.ms_filter += watch.Lap();
  last_stamp_ns = stamp_ns;

  std::vector<NewCorner> corners = NewCorners(prepared);
  Forget(corners.size());
  AddFeatures(ThatFit(std::move(corners)), prepared, filter.belief().velocity);
  diagnostics.ms_features += watch.Lap();
}

// How fast the camera was in its first frame only the prior says, and the rows of that frame are as wrong as that: a turn that it does not know
// of shears the whole map, for good. The second frame tells, so both are done again with what it says.
void Odometry::Impl::BeginAgain(const PreparedFrame& second, FrameDiagnostics& diagnostics) {
  const PreparedFrame first = *std::exchange(first_frame, std::nullopt);
  const double dt = static_cast<double>(second.frame.stamp_ns - first.frame.stamp_ns) * 1e-9;
  for (int round = 1; round < kStartRounds && diagnostics.tracked(); ++round) {
    const Vector6 velocity = MinusNear(filter.belief().pose, prior.pose, dt * prior.w_WC_C) / dt;
    filter = WatchedFilter(MakeFilter(params, prior, seed));
    scale = UnknownScale(params.landmark.scale_sigma, prior.pose.p_WC);
    Begin(first, velocity);
    Follow(second, diagnostics);
  }
}

void Odometry::Impl::UpdateScores(const Association& association) {
  for (LandmarkRecord& record : records) {
    record.score = PredictScore(record.score, params.score);
    ++record.age;
    ++record.frames_unsearched;
    record.searched = false;
  }
  for (const Searched& searched : association.searched) records[searched.landmark].searched = true;
  const auto share = [&](std::size_t count) { return params.score.min_found_ratio * static_cast<double>(count); };
  if (static_cast<double>(association.matches.size()) < share(association.searched.size())) return;  // a blind frame
  for (const Searched& searched : association.searched) {
    LandmarkRecord& record = records[searched.landmark];
    record.score = UpdateScore(record.score, searched.mahalanobis_sq, params.score);
    if (searched.mahalanobis_sq) record.residuals.Add(searched.residual);
    record.frames_unsearched = 0;
  }
}

// Room for `wanted` new ones is made as far as nothing that was just searched for has to go.
void Odometry::Impl::Forget(std::size_t wanted) {
  const std::vector<Filter::LandmarkBelief> beliefs = filter.LandmarkBeliefs();
  for (std::size_t n = 0; n < records.size(); ++n)
    records[n].permanent = beliefs[n].relative_sigma() < params.landmark.permanent_ratio;
  const std::vector<bool> keep = WorthKeeping(records, wanted, params.landmark, params.score);
  filter.KeepLandmarks(keep);
  std::size_t to = 0;
  for (std::size_t from = 0; from < records.size(); ++from)
    if (keep[from]) std::swap(records[to++], records[from]);
  records.resize(to);
}

// A new landmark; its first view is what the filter is to be told.
void Odometry::Impl::Add(const NewCorner& corner, const PreparedFrame& prepared, const Vector6& velocity,
                         std::vector<FirstView>& first) {
  const Eigen::Vector2d pixel = corner.pixel.cast<double>();
  LandmarkRecord record;
  record.appearance = {prepared.brisk.Describe(corner.pixel, first_sampler), CutPatch(prepared.smooth, corner.pixel)};
  record.id = next_id++;
  record.score = params.score.initial;
  record.searched = true;
  records.push_back(record);
  first.push_back(FirstSeen(shutter.Row(pixel), filter.belief().pose, velocity));
  // The patch that later views are registered to defines the landmark: its first view is as good as the registration can be.
  first.back().R = PixelNoise(camera.LensJacobian(first.back().ray), params.features.noise != MatchNoise::constant
                                                                         ? params.features.sigma_floor_px
                                                                         : params.features.sigma_px);
  first.back().depth = corner.depth;
  views.push_back(
      {record.id, pixel, pixel, Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero(), FeatureView::Status::fresh});
}

std::vector<NewCorner> Odometry::Impl::TargetCorners(const PreparedFrame& prepared) {
  std::vector<NewCorner> found;
  if (target_frames == 0) return found;
  --target_frames;
  const std::vector<TargetCorner> corners =
      FindTarget(prepared.grey, camera, params.target, params.features.sigma_floor_px);
  if (corners.empty()) return found;
  target_frames = 0;
  for (const TargetCorner& corner : corners)
    if (camera.Sees(corner.pixel.cast<double>(), border_px)) found.push_back({corner.pixel, corner.depth});
  return found;
}

// Where a landmark may begin: the target's corners, then others, none where a landmark was found or is predicted.
std::vector<NewCorner> Odometry::Impl::NewCorners(const PreparedFrame& prepared) {
  std::vector<NewCorner> corners = TargetCorners(prepared);
  std::vector<Eigen::Vector2d> occupied = left_out;
  for (const FeatureView& view : views)
    if (view.status == FeatureView::Status::matched) occupied.push_back(view.pixel);
  for (const NewCorner& corner : corners) occupied.push_back(corner.pixel.cast<double>());
  for (const Eigen::Vector2i& corner : DetectCorners(prepared.grey, occupied, border_px, params.features))
    if (camera.Sees(corner.cast<double>())) corners.push_back({corner, std::nullopt});
  return corners;
}

// No more than the map has room for: the target's, then others from all over the image.
std::vector<NewCorner> Odometry::Impl::ThatFit(std::vector<NewCorner> corners) const {
  const std::size_t room = static_cast<std::size_t>(params.landmark.max_landmarks) - records.size();
  if (corners.size() <= room) return corners;
  std::vector<Eigen::Vector2d> pixels;
  for (const NewCorner& corner : corners) pixels.push_back(corner.pixel.cast<double>());
  const int cells = std::max(1, static_cast<int>(std::sqrt(room)));
  std::vector<std::size_t> order = SpreadOver(pixels, cells, cells, camera.width, camera.height);
  std::stable_partition(order.begin(), order.end(), [&](std::size_t i) { return corners[i].depth.has_value(); });
  std::vector<NewCorner> chosen;
  for (std::size_t i = 0; i < room; ++i) chosen.push_back(corners[order[i]]);
  return chosen;
}

void Odometry::Impl::AddFeatures(const std::vector<NewCorner>& corners, const PreparedFrame& prepared,
                                 const Vector6& velocity) {
  std::vector<FirstView> first;
  for (const NewCorner& corner : corners) Add(corner, prepared, velocity, first);
  filter.AddLandmarks(first);
}

Estimate Odometry::Impl::Answer(std::int64_t stamp_ns, FrameDiagnostics diagnostics) const {
  diagnostics.landmarks = static_cast<int>(records.size());
  diagnostics.permanent = static_cast<int>(
      std::count_if(records.begin(), records.end(), [](const LandmarkRecord& r) { return r.permanent; }));
  return MakeEstimate(filter, scale, stamp_ns, diagnostics);
}

Odometry::Odometry(const Camera& camera, const Params& params, const Prior& prior, std::uint64_t seed)
    : impl_(std::make_unique<Impl>(camera, params, prior, seed)) {}
Odometry::~Odometry() = default;
Odometry::Odometry(Odometry&&) noexcept = default;

Estimate Odometry::Track(const Frame& frame) {
  impl_->Require(frame);
  return impl_->Process(PreparedFrame(frame));
}

Estimate Odometry::Track(const PreparedFrame& frame) {
  impl_->Require(frame.frame);
  return impl_->Process(frame);
}

std::vector<MapPoint> Odometry::Map() const {
  std::vector<MapPoint> points = MakeMap(impl_->filter, impl_->scale);
  for (std::size_t n = 0; n < points.size(); ++n) {
    points[n].id = impl_->records[n].id;
    points[n].permanent = impl_->records[n].permanent;
  }
  return points;
}

const std::vector<FeatureView>& Odometry::Features() const { return impl_->views; }

}  // namespace vo
