#include "vo/odometry.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "vo/association.h"
#include "vo/estimate.h"
#include "vo/features/corner_detector.h"
#include "vo/map/existence.h"
#include "vo/map/forgetting.h"
#include "vo/rolling_shutter.h"

namespace vo {
struct Odometry::Impl {
  Impl(const Camera& camera_, const Params& params_, const Prior& prior, std::uint64_t seed)
      : camera(camera_),
        params(Checked(params_)),
        filter(MakeFilter(params, prior, seed)),
        first_sampler(FirstSampler(params.features)),
        border_px(std::max(first_sampler.margin(), Patch::kRadius + 1)) {}

  void Require(const Frame& frame) const;
  Estimate Process(const PreparedFrame& prepared);
  void UpdateScores(const Association& association);
  void Forget();
  void AddFeatures(const cv::Mat& grey, const BriskImage& brisk);
  Estimate Answer(std::int64_t stamp_ns, FrameDiagnostics diagnostics) const;

  Camera camera;
  Params params;
  std::unique_ptr<Filter> filter;
  BriskSampler first_sampler;
  int border_px;
  std::vector<LandmarkRecord> records;  // in the order of the filter's landmarks
  std::vector<FeatureView> views;
  std::vector<Eigen::Vector2d> left_out;  // [px] of this frame: predicted, but not looked for
  std::optional<std::int64_t> last_stamp_ns;
  int next_id = 0;
};

void Odometry::Impl::Require(const Frame& frame) const {
  if (frame.image.cols != camera.width || frame.image.rows != camera.height)
    throw std::invalid_argument("image is " + std::to_string(frame.image.cols) + " x " + std::to_string(frame.image.rows) +
                                ", the camera " + std::to_string(camera.width) + " x " + std::to_string(camera.height));
  if (last_stamp_ns) RequireIncreasing(frame.stamp_ns, *last_stamp_ns);
}

Estimate Odometry::Impl::Process(const PreparedFrame& prepared) {
  const Frame& frame = prepared.frame;
  FrameDiagnostics diagnostics;
  Stopwatch watch;
  views.clear();
  left_out.clear();

  if (last_stamp_ns) {
    const double dt = static_cast<double>(frame.stamp_ns - *last_stamp_ns) * 1e-9;
    filter->Predict(dt);
    Association association = Associate(*filter, records, camera, prepared.grey, prepared.brisk, border_px, dt, params);
    diagnostics.ms_matching = watch.Lap();
    filter->Update(association.matches);
    UpdateScores(association);
    diagnostics.searched = static_cast<int>(association.searched.size());
    diagnostics.matched = static_cast<int>(association.matches.size());
    diagnostics.nis = association.nis;
    diagnostics.nis_dof = 2 * diagnostics.matched;
    views = std::move(association.views);
    left_out = std::move(association.left_out);
    diagnostics.ms_filter = watch.Lap();
  }
  last_stamp_ns = frame.stamp_ns;

  Forget();
  AddFeatures(prepared.grey, prepared.brisk);
  diagnostics.ms_features = prepared.ms + watch.Lap();
  return Answer(frame.stamp_ns, diagnostics);
}

void Odometry::Impl::UpdateScores(const Association& association) {
  for (LandmarkRecord& record : records) {
    record.score = PredictScore(record.score, params.score);
    ++record.age;
    ++record.frames_unsearched;
  }
  const auto share = [&](std::size_t count) { return params.score.blind_share * static_cast<double>(count); };
  if (static_cast<double>(association.matches.size()) < share(association.searched.size())) return;  // a blind frame
  for (const Searched& searched : association.searched) {
    LandmarkRecord& record = records[searched.landmark];
    record.score = UpdateScore(record.score, searched.mahalanobis_sq, params.score);
    record.frames_unsearched = 0;
  }
}

void Odometry::Impl::Forget() {
  const std::vector<Filter::LandmarkBelief> beliefs = filter->LandmarkBeliefs();
  for (std::size_t n = 0; n < records.size(); ++n)
    records[n].permanent = beliefs[n].relative_sigma < params.landmark.permanent_ratio;
  const std::vector<bool> keep = WorthKeeping(records, params.landmark, params.score);
  filter->KeepLandmarks(keep);
  std::size_t to = 0;
  for (std::size_t from = 0; from < records.size(); ++from)
    if (keep[from]) std::swap(records[to++], records[from]);
  records.resize(to);
}

void Odometry::Impl::AddFeatures(const cv::Mat& grey, const BriskImage& brisk) {
  std::vector<Eigen::Vector2d> occupied = left_out;
  for (const FeatureView& view : views)
    if (view.status == FeatureView::Status::matched) occupied.push_back(view.pixel);
  const std::vector<Eigen::Vector2i> corners = DetectCorners(grey, occupied, border_px, params.features);
  const Belief& belief = filter->belief();
  const RollingShutter shutter(camera, params.features);
  std::vector<FirstView> first;
  for (const Eigen::Vector2i& corner : corners) {
    const Eigen::Vector2d pixel = corner.cast<double>();
    if (!camera.Sees(pixel)) continue;  // at the edge of a fisheye lens
    LandmarkRecord record;
    record.appearance = {brisk.Describe(corner, first_sampler), CutPatch(grey, corner)};
    record.id = next_id++;
    record.score = params.score.initial;
    records.push_back(record);
    first.push_back(shutter.FirstSeen(pixel, belief.pose, belief.velocity));
    // The patch that later views are registered to defines the landmark: its first view is as good as the registration can be.
    first.back().R = PixelNoise(camera.LensJacobian(first.back().ray), params.features.noise == MatchNoise::registered ? params.features.sigma_floor_px
                                                                                                                       : params.features.sigma_px);
    views.push_back({record.id, pixel, pixel, Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero(), FeatureView::Status::fresh});
  }
  filter->AddLandmarks(first);
}

Estimate Odometry::Impl::Answer(std::int64_t stamp_ns, FrameDiagnostics diagnostics) const {
  diagnostics.landmarks = static_cast<int>(records.size());
  diagnostics.permanent =
      static_cast<int>(std::count_if(records.begin(), records.end(), [](const LandmarkRecord& r) { return r.permanent; }));
  return MakeEstimate(*filter, stamp_ns, diagnostics);
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
  std::vector<MapPoint> points;
  const std::vector<Filter::LandmarkBelief> beliefs = impl_->filter->LandmarkBeliefs();
  const std::vector<std::optional<PointMoments>> moments = impl_->filter->LandmarkPoints();
  for (std::size_t n = 0; n < beliefs.size(); ++n)
    points.push_back({impl_->records[n].id, beliefs[n].X_W, beliefs[n].inverse_depth, beliefs[n].inverse_depth_sigma,
                      impl_->records[n].permanent, beliefs[n].relative_sigma, moments[n]});
  return points;
}

const std::vector<FeatureView>& Odometry::Features() const { return impl_->views; }

}  // namespace vo
