#include "vo/frontend/search_set.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "vo/features/corner_detector.h"
#include "vo/filter/consensus.h"

namespace vo {
namespace {

// Margin about the image in image sizes: a landmark beyond it on the reference path is outside for every particle.
constexpr double kMargin = 0.5;

// Limits on the change of view since the first one: max_view_angle, max_baseline_ratio.
bool IsSearchable(const AssociationContext& in, int landmark, const ImagePrediction& prediction) {
  const Pose& now = in.prediction().mean;
  const Pose first = in.reference.AnchorOf(landmark);
  const Eigen::Vector3d estimate = in.reference.ModeOf(landmark);
  const Eigen::Vector3d first_ray = first.q_WC * Eigen::Vector3d(estimate.x(), estimate.y(), 1.0).normalized();
  const Eigen::Vector3d present_ray = now.q_WC * Eigen::Vector3d(prediction.z.x(), prediction.z.y(), 1.0).normalized();
  if (first_ray.dot(present_ray) < std::cos(in.params.features.max_view_angle)) return false;
  const double rho = estimate.z();
  return rho <= 0 || (now.p_WC - first.p_WC).norm() * rho < in.params.features.max_baseline_ratio;
}

// Landmarks in front of the camera and near the image on the reference path: only for these is the costly prediction
// over all particles made.
std::vector<int> Predictable(const AssociationContext& in) {
  const Camera& camera = in.camera;
  const MapView map(in.reference.map, in.prediction().mean);
  std::vector<int> predictable;
  for (int n = 0; n < in.filter.landmark_count(); ++n) {
    const bool wanted = in.relocalising() && in.records[n].unseen();
    if (in.records[n].score < in.params.score.delete_below && !wanted) continue;
    const Projection view = map(n);
    if (!view.in_front || !camera.IsInjective(view.z)) continue;
    const Eigen::Vector2d pixel = camera.Project({view.z.x(), view.z.y(), 1.0});
    const bool near = pixel.x() > -kMargin * camera.width && pixel.x() < (1 + kMargin) * camera.width &&
                      pixel.y() > -kMargin * camera.height && pixel.y() < (1 + kMargin) * camera.height;
    if (near) predictable.push_back(n);
  }
  return predictable;
}

constexpr int kMinAge = 10;  // [frames]
constexpr double kHighScore = 0.9;
constexpr std::size_t kMinInliers = 6;  // a pose has six degrees of freedom, a match gives two equations
constexpr double kMinInlierRatio = 0.5;

// Lower rank is searched first.
int Rank(const LandmarkRecord& record) { return record.score < kHighScore ? 2 : record.permanent ? 0 : 1; }

}  // namespace

std::vector<Candidate> FindCandidates(const AssociationContext& in, int border_px) {
  std::vector<Candidate> candidates;
  const ImageMotion motion(in.shutter, in.reference.map, in.prediction().mean, in.velocity());
  const std::vector<int> predictable = Predictable(in);
  const std::vector<ImagePrediction> predictions = in.filter.PredictImages(predictable);
  for (std::size_t i = 0; i < predictable.size(); ++i) {
    const int n = predictable[i];
    const ImagePrediction& prediction = predictions[i];
    if (!prediction.in_front || !in.camera.IsInjective(prediction.z) || !IsSearchable(in, n, prediction)) continue;
    const Eigen::Vector2d rate = motion.Rate(n), pixel = in.shutter.InImage(prediction.z, rate);
    if (!in.camera.IsUsable(pixel, border_px)) continue;
    candidates.push_back(
        {n, prediction, pixel, in.camera.LensJacobian(prediction.z), rate,
         in.params.features.noise == MatchNoise::adaptive ? in.records[n].residuals.Inflation(in.noise_level) : 1.0});
  }
  return candidates;
}

std::vector<LeftOut> LimitToBudget(std::vector<Candidate>& candidates, const AssociationContext& in, int known_most) {
  std::vector<LeftOut> left_out;
  const FeatureParams& params = in.params.features;
  if (static_cast<int>(candidates.size()) <= std::min(known_most, params.max_searched)) return left_out;
  const auto order_key = [&](const Candidate& c) {
    const LandmarkRecord& record = in.records[c.landmark];
    return std::tuple(!(in.relocalising() && record.unseen()), record.lost, -record.score);
  };
  std::ranges::stable_sort(candidates, {}, order_key);
  std::vector<Eigen::Vector2d> pixels;
  for (const Candidate& c : candidates) pixels.push_back(c.pixel);
  const std::vector<std::size_t> order =
      BucketRoundRobin(pixels, params.grid_columns, params.grid_rows, in.camera.width, in.camera.height);
  std::vector<Candidate> chosen;
  int known = 0;
  for (const std::size_t i : order) {
    const int n = candidates[i].landmark;
    const LandmarkRecord& record = in.records[n];
    if (static_cast<int>(chosen.size()) < params.max_searched && (!record.known || known < known_most)) {
      chosen.push_back(candidates[i]);
      if (record.known) ++known;
    } else if (!record.lost) {
      left_out.push_back({n, pixels[i]});
    }
  }
  candidates = std::move(chosen);
  return left_out;
}

SearchRequest RequestFor(const AssociationContext& in, const Candidate& candidate) {
  const Eigen::Vector3d estimate = in.reference.ModeOf(candidate.landmark);
  const Projection view = Project({in.prediction().mean, in.reference.AnchorOf(candidate.landmark)}, estimate);
  SearchRequest request{&in.records[candidate.landmark].appearance, candidate.pixel,
                        candidate.InnovationCovariance(in.params.features.sigma_px), Eigen::Matrix2d::Identity()};
  if (!view.in_front) return request;
  const Eigen::Matrix2d from_first = candidate.lens * view.J_landmark.leftCols<2>();
  request.warp = from_first * in.camera.LensJacobian(estimate.head<2>()).inverse();
  const LandmarkRecord& record = in.records[candidate.landmark];
  const Eigen::Vector3d ray(estimate.x(), estimate.y(), 1);
  const Eigen::Vector3d moves = -estimate.z() * record.first_v_C - record.first_w_C.cross(ray);
  request.first_rate = from_first * (moves.head<2>() - moves.z() * ray.head<2>());
  request.rate = candidate.lens * candidate.rate;
  return request;
}

std::vector<std::size_t> SelectCoarseFeatures(std::span<const Candidate> candidates,
                                              std::span<const LandmarkRecord> records, const Camera& camera,
                                              const FeatureParams& params, Search search) {
  const auto record = [&](std::size_t i) -> const LandmarkRecord& { return records[candidates[i].landmark]; };
  const auto count = static_cast<std::size_t>(params.coarse_features);
  std::vector<std::size_t> preferred;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (record(i).age >= kMinAge) preferred.push_back(i);
  if (search == Search::wide && preferred.size() < count) {
    for (std::size_t i = 0; i < candidates.size(); ++i)
      if (record(i).age < kMinAge && record(i).age > 0 && record(i).frames_unmatched == 0) preferred.push_back(i);
  }
  if (count == 0 || preferred.size() < count) return {};
  std::stable_sort(preferred.begin(), preferred.end(),
                   [&](std::size_t a, std::size_t b) { return Rank(record(a)) < Rank(record(b)); });
  std::vector<Eigen::Vector2d> pixels;
  for (const std::size_t i : preferred) pixels.push_back(candidates[i].pixel);
  const int cells = static_cast<int>(std::ceil(std::sqrt(params.coarse_features)));
  std::vector<std::size_t> chosen;
  for (const std::size_t i : BucketRoundRobin(pixels, cells, cells, camera.width, camera.height))
    if (chosen.size() < count) chosen.push_back(preferred[i]);
  return chosen;
}

std::optional<PoseGaussian> FitCoarsePose(const PoseGaussian& prediction, const LocalMap& map,
                                          std::span<const Match> matches, const Params& params) {
  if (matches.size() < kMinInliers) return std::nullopt;
  const Consensus found = FindConsensus(prediction, map, matches, params.score.gate, params.filter);
  const auto inliers = static_cast<std::size_t>(std::count(found.inlier.begin(), found.inlier.end(), true));
  if (inliers < kMinInliers || static_cast<double>(inliers) < kMinInlierRatio * static_cast<double>(matches.size()))
    return std::nullopt;
  return found.pose;
}

std::optional<PixelPrediction> PredictPixel(const PoseGaussian& pose, const MapView& view, int landmark,
                                            const Camera& camera, double sigma_px) {
  const Projection h = view(landmark);
  if (!h.in_front || !camera.IsInjective(h.z)) return std::nullopt;
  const Eigen::Matrix2d lens = camera.LensJacobian(h.z);
  const Matrix26 J_pose = lens * h.J_pose;
  const Matrix23 J_landmark = lens * h.J_landmark;
  return PixelPrediction{camera.Project({h.z.x(), h.z.y(), 1.0}),
                         J_pose * pose.covariance * J_pose.transpose() +
                             J_landmark * view.landmark(landmark).covariance * J_landmark.transpose() +
                             sigma_px * sigma_px * Eigen::Matrix2d::Identity()};
}

}  // namespace vo
