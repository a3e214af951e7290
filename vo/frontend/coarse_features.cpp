#include "vo/frontend/coarse_features.h"

#include <algorithm>
#include <cmath>

#include "vo/features/corner_detector.h"
#include "vo/filter/consensus.h"

namespace vo {
namespace {

constexpr int kMinAge = 10;  // [frames]
constexpr double kHighScore = 0.9;
constexpr std::size_t kMinInliers = 6;  // a pose has six degrees of freedom, a match gives two equations
constexpr double kMinInlierRatio = 0.5;

// Lower rank is searched first.
int Rank(const LandmarkRecord& record) { return record.score < kHighScore ? 2 : record.permanent ? 0 : 1; }

}  // namespace

std::vector<std::size_t> SelectCoarseFeatures(std::span<const CoarseCandidate> candidates, const Camera& camera,
                                              const FeatureParams& params) {
  const auto count = static_cast<std::size_t>(params.coarse_features);
  std::vector<std::size_t> preferred;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (candidates[i].record->age >= kMinAge) preferred.push_back(i);
  if (count == 0 || preferred.size() < count) return {};
  std::stable_sort(preferred.begin(), preferred.end(), [&](std::size_t a, std::size_t b) {
    return Rank(*candidates[a].record) < Rank(*candidates[b].record);
  });
  std::vector<Eigen::Vector2d> pixels;
  for (const std::size_t i : preferred) pixels.push_back(candidates[i].pixel);
  const int cells = static_cast<int>(std::ceil(std::sqrt(params.coarse_features)));
  std::vector<std::size_t> chosen;
  for (const std::size_t i : BucketRoundRobin(pixels, cells, cells, camera.width, camera.height))
    if (chosen.size() < count) chosen.push_back(preferred[i]);
  return chosen;
}

std::optional<CoarsePose> CoarsePose::From(const PoseGaussian& prediction, const LocalMap& map,
                                           std::span<const Match> matches, const Params& params) {
  if (matches.size() < kMinInliers) return std::nullopt;
  const Consensus found = FindConsensus(prediction, map, matches, params.score.gate, params.filter);
  const auto inliers = static_cast<std::size_t>(std::count(found.inlier.begin(), found.inlier.end(), true));
  if (inliers < kMinInliers || static_cast<double>(inliers) < kMinInlierRatio * static_cast<double>(matches.size()))
    return std::nullopt;
  return CoarsePose(found.pose, map);
}

std::optional<CoarsePose::Prediction> CoarsePose::Predict(int landmark, const Camera& camera, double sigma_px) const {
  const Landmark& estimate = map_.landmark(landmark);
  const Projection view = map_(landmark);
  if (!view.in_front || !camera.IsInjective(view.z)) return std::nullopt;
  const Eigen::Matrix2d lens = camera.LensJacobian(view.z);
  const Matrix26 J_pose = lens * view.J_pose;
  const Matrix23 J_landmark = lens * view.J_landmark;
  return Prediction{camera.Project({view.z.x(), view.z.y(), 1.0}),
                    J_pose * pose_.covariance * J_pose.transpose() +
                        J_landmark * estimate.covariance * J_landmark.transpose() +
                        sigma_px * sigma_px * Eigen::Matrix2d::Identity()};
}

}  // namespace vo
