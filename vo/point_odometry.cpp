#include "vo/point_odometry.h"

#include <Eigen/LU>
#include <algorithm>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "vo/base/source.h"
#include "vo/base/stopwatch.h"
#include "vo/filter/checked_filter.h"
#include "vo/filter/consensus.h"
#include "vo/filter/landmark_table.h"
#include "vo/filter_adapter.h"
#include "vo/start_trajectory.h"

namespace vo {

struct PointOdometry::Impl {
  Impl(const Camera& camera_, const Params& params_, const Prior& prior, std::uint64_t seed)
      : camera(camera_),
        params(params_),
        filter(MakeFilter(params, prior, seed)),
        scale(params.landmark.scale_sigma, prior.pose.p_WC) {}

  // Observation on the plane z = 1.
  struct Ray {
    std::int64_t id;
    Eigen::Vector2d z;
  };

  struct Record {
    std::int64_t id = 0;
    int frames_unseen = 0;  // in a row
  };

  // Observations at invertible pixels; checks the frame.
  std::vector<Ray> RaysOf(const PointFrame& frame) const {
    if (last_stamp_ns) RequireIncreasing(frame.stamp_ns, *last_stamp_ns);
    const auto refuse = [&](const PointObservation& observation, const std::string& what) {
      throw std::invalid_argument("point " + std::to_string(observation.id) + what + " in the frame at " +
                                  std::to_string(frame.stamp_ns) + " ns");
    };
    std::unordered_set<std::int64_t> ids;
    std::vector<Ray> rays;
    for (const PointObservation& observation : frame.observations) {
      if (!ids.insert(observation.id).second) refuse(observation, " comes twice");
      if (!observation.pixel.allFinite()) refuse(observation, " is nowhere");
      if (const auto ray = camera.TryUnproject(observation.pixel)) rays.push_back({observation.id, *ray});
    }
    return rays;
  }

  Estimate Process(const PointFrame& frame) {
    const std::vector<Ray> rays = RaysOf(frame);
    FrameDiagnostics diagnostics;
    Stopwatch watch;
    if (last_stamp_ns) {
      filter.Predict(static_cast<double>(frame.stamp_ns - *last_stamp_ns) * 1e-9);
      const std::vector<Match> matches = MatchesIn(rays, diagnostics);
      diagnostics.ms_matching = watch.Lap();
      scale.AbsorbChange(filter.Update(matches).scale_change);
      diagnostics.ms_filter = watch.Lap();
    }
    start.Add(frame.stamp_ns, filter.answer(), scale);
    last_stamp_ns = frame.stamp_ns;
    Forget();
    AddNew(rays);
    diagnostics.landmarks = static_cast<int>(records.size());
    for (const Filter::LandmarkBelief& belief : filter.LandmarkBeliefs())
      diagnostics.permanent += belief.relative_sigma() < params.landmark.permanent_ratio;
    diagnostics.ms_features = watch.Lap();
    if (!scale.known()) {
      mixture = filter.mixture();
      for (BeliefComponent& component : mixture) component = scale.ToAnswer(component, filter.belief());
    }
    return MakeEstimate(filter, scale, frame.stamp_ns, diagnostics);
  }

  std::vector<Match> MatchesIn(std::span<const Ray> rays, FrameDiagnostics& diagnostics) {
    for (Record& record : records) ++record.frames_unseen;
    std::vector<Match> matches;
    for (const Ray& ray : rays) {
      const auto known = landmark_of.find(ray.id);
      if (known == landmark_of.end()) continue;
      Record& record = records[static_cast<std::size_t>(known->second)];
      record.frames_unseen = 0;
      matches.push_back({known->second, ray.z, PixelNoise(camera.LensJacobian(ray.z), params.features.sigma_px)});
    }
    diagnostics.searched = static_cast<int>(matches.size());
    const ReferencePath reference = filter.Reference();
    const std::vector<bool> inlier = FindInliers(reference.prediction, reference.map, matches,
                                                 OutlierGate(filter.answer(), params.score), params.filter);
    Compact(inlier, matches);
    std::vector<int> landmarks;
    for (const Match& match : matches) landmarks.push_back(match.landmark);
    const std::vector<ImagePrediction> predictions = filter.PredictImages(landmarks);
    for (std::size_t i = 0; i < matches.size(); ++i) {
      const ImagePrediction& prediction = predictions[i];
      if (!prediction.in_front) continue;
      const Eigen::Vector2d nu = matches[i].z - prediction.z;
      diagnostics.nis += nu.dot(Eigen::Matrix2d(prediction.covariance + matches[i].R).inverse() * nu);
      diagnostics.nis_dof += 2;
    }
    diagnostics.matched = static_cast<int>(matches.size());
    return matches;
  }

  void Forget() {
    std::vector<bool> keep;
    for (const Record& record : records) keep.push_back(record.frames_unseen < params.landmark.forget_after);
    if (std::find(keep.begin(), keep.end(), false) == keep.end()) return;
    filter.KeepLandmarks(keep);
    Compact(keep, records);
    landmark_of.clear();
    for (std::size_t n = 0; n < records.size(); ++n) landmark_of[records[n].id] = static_cast<int>(n);
  }

  void AddNew(std::span<const Ray> rays) {
    std::vector<FirstView> views;
    for (const Ray& ray : rays) {
      if (!landmark_of.try_emplace(ray.id, static_cast<int>(records.size())).second) continue;
      records.push_back({ray.id, 0});
      views.push_back({ray.z, PixelNoise(camera.LensJacobian(ray.z), params.features.sigma_px)});
    }
    filter.AddLandmarks(views);
  }

  Camera camera;
  Params params;
  CheckedFilter filter;
  ScaleAmbiguity scale;
  StartTrajectory start;
  std::vector<BeliefComponent> mixture;               // of the answer, where the scale is unknown
  std::vector<Record> records;                        // in the order of the filter's landmarks
  std::unordered_map<std::int64_t, int> landmark_of;  // id -> index
  std::optional<std::int64_t> last_stamp_ns;
};

PointOdometry::PointOdometry(const Camera& camera, const Params& params, const Prior& prior, std::uint64_t seed)
    : impl_(std::make_unique<Impl>(camera, params, prior, seed)) {}
PointOdometry::~PointOdometry() = default;
PointOdometry::PointOdometry(PointOdometry&&) noexcept = default;

Estimate PointOdometry::Track(const PointFrame& frame) { return impl_->Process(frame); }

const std::vector<StampedPose>& PointOdometry::Reissued() const { return impl_->start.reissued(); }

const Filter& PointOdometry::filter() const { return impl_->filter.watched(); }

const std::vector<BeliefComponent>& PointOdometry::Mixture() const {
  return impl_->scale.known() ? impl_->filter.mixture() : impl_->mixture;
}

std::vector<MapPoint> PointOdometry::Map() const {
  std::vector<MapPoint> points = MakeMap(impl_->filter, impl_->scale);
  for (std::size_t n = 0; n < points.size(); ++n) points[n].id = impl_->records[n].id;
  return points;
}

}  // namespace vo
