#include "vo/frontend/pilots.h"

#include <algorithm>
#include <cmath>

#include "vo/filter/consensus.h"
#include "vo/frontend/spread.h"

namespace vo {
namespace {

constexpr int kSettledFrames = 10;
constexpr double kSureScore = 0.9;
constexpr std::size_t kFewest = 6;  // that agree: a pose has six unknowns, each pilot tells two
constexpr double kAgreeing = 0.5;   // of those found

// Small is good.
int Rank(const LandmarkRecord& record) { return record.score < kSureScore ? 2 : record.permanent ? 0 : 1; }

}  // namespace

std::vector<std::size_t> ChoosePilots(std::span<const PilotCandidate> candidates, const Camera& camera,
                                      const FeatureParams& params) {
  const auto count = static_cast<std::size_t>(params.coarse_features);
  std::vector<std::size_t> preferred;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (candidates[i].record->age >= kSettledFrames) preferred.push_back(i);
  if (count == 0 || preferred.size() < count) return {};
  std::stable_sort(preferred.begin(), preferred.end(), [&](std::size_t a, std::size_t b) {
    return Rank(*candidates[a].record) < Rank(*candidates[b].record);
  });
  std::vector<Eigen::Vector2d> pixels;
  for (const std::size_t i : preferred) pixels.push_back(candidates[i].pixel);
  const int cells = static_cast<int>(std::ceil(std::sqrt(params.coarse_features)));
  std::vector<std::size_t> pilots;
  for (const std::size_t i : SpreadOver(pixels, cells, cells, camera.width, camera.height))
    if (pilots.size() < count) pilots.push_back(preferred[i]);
  return pilots;
}

std::optional<PilotedPose> PilotedPose::From(const PoseGaussian& prediction, const LocalMap& map,
                                             std::span<const Match> pilots, const Params& params) {
  if (pilots.size() < kFewest) return std::nullopt;
  const Consensus found = FindConsensus(prediction, map, pilots, params.score.gate, params.filter);
  const auto agreeing = static_cast<std::size_t>(std::count(found.inlier.begin(), found.inlier.end(), true));
  if (agreeing < kFewest || static_cast<double>(agreeing) < kAgreeing * static_cast<double>(pilots.size()))
    return std::nullopt;
  return PilotedPose(found.pose, map);
}

std::optional<PilotedPose::Prediction> PilotedPose::Predict(int landmark, const Camera& camera, double sigma_px) const {
  const Landmark& believed = map_.landmark(landmark);
  const Projection view = map_(landmark);
  if (!view.in_front || !camera.Draws(view.z)) return std::nullopt;
  const Eigen::Matrix2d lens = camera.LensJacobian(view.z);
  const Matrix26 J_pose = lens * view.J_pose;
  const Matrix23 J_landmark = lens * view.J_landmark;
  return Prediction{camera.Project({view.z.x(), view.z.y(), 1.0}),
                    J_pose * pose_.covariance * J_pose.transpose() +
                        J_landmark * believed.covariance * J_landmark.transpose() +
                        sigma_px * sigma_px * Eigen::Matrix2d::Identity()};
}

}  // namespace vo
