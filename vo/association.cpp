#include "vo/association.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "vo/features/matcher.h"
#include "vo/filter/consensus.h"
#include "vo/filter/motion_model.h"
#include "vo/pilots.h"
#include "vo/rolling_shutter.h"
#include "vo/spread.h"

namespace vo {
namespace {

constexpr int kShutterRounds = 3;  // velocity, then where the rows' points were at the stamp, then the velocity by these
constexpr double kFarOut = 0.5;    // of the image's size: so far outside of it no particle has a landmark that others have inside

struct Candidate {
  int landmark = 0;
  ImagePrediction prediction;  // on the plane z = 1
  Eigen::Vector2d pixel;       // the same in the image
  Eigen::Matrix2d lens;        // d pixel / d(plane z = 1)
  double inflation = 1;        // of a match's covariance, by the landmark's residuals until now
};

bool WorthSearching(const Filter& filter, int landmark, const ImagePrediction& prediction, const Params& params) {
  const Pose& now = filter.ReferencePrediction().mean;
  const Pose first = filter.AnchorOf(landmark);
  const Eigen::Vector3d estimate = filter.ModeOf(landmark);
  const Eigen::Vector3d first_ray = first.q_WC * Eigen::Vector3d(estimate.x(), estimate.y(), 1.0).normalized();
  const Eigen::Vector3d present_ray = now.q_WC * Eigen::Vector3d(prediction.z.x(), prediction.z.y(), 1.0).normalized();
  if (first_ray.dot(present_ray) < std::cos(params.features.max_view_angle_deg * std::numbers::pi / 180)) return false;
  const double rho = estimate.z();
  return rho <= 0 || (now.p_WC - first.p_WC).norm() * rho < params.features.max_baseline_ratio;
}

// A prediction costs all particles' covariances: of what lies behind the camera or far outside the image on the reference's path, none is made.
std::vector<int> Predictable(const Filter& filter, std::span<const LandmarkRecord> records, const Camera& camera, const LocalMap& map,
                             const Params& params) {
  const MapView seen(map, filter.ReferencePrediction().mean);
  std::vector<int> predictable;
  for (int n = 0; n < filter.landmark_count(); ++n) {
    if (records[n].score < params.score.delete_below) continue;
    const Projection view = seen(n);
    if (!view.in_front) continue;
    const Eigen::Vector2d pixel = camera.Project({view.z.x(), view.z.y(), 1.0});
    const bool near = pixel.x() > -kFarOut * camera.width && pixel.x() < (1 + kFarOut) * camera.width &&
                      pixel.y() > -kFarOut * camera.height && pixel.y() < (1 + kFarOut) * camera.height;
    if (near) predictable.push_back(n);
  }
  return predictable;
}

// Section 7: assessed in this order.
std::vector<Candidate> FindCandidates(const Filter& filter, std::span<const LandmarkRecord> records, const Camera& camera,
                                      const LocalMap& map, const ImageMotion& motion, int border_px, const Params& params) {
  std::vector<Candidate> candidates;
  const std::vector<int> predictable = Predictable(filter, records, camera, map, params);
  const std::vector<ImagePrediction> predictions = filter.PredictImages(predictable);
  for (std::size_t i = 0; i < predictable.size(); ++i) {
    const int n = predictable[i];
    const ImagePrediction& prediction = predictions[i];
    if (!prediction.in_front || !WorthSearching(filter, n, prediction, params)) continue;
    const Eigen::Vector2d pixel = motion.InImage(n, prediction.z);
    if (!camera.Sees(pixel, border_px)) continue;
    candidates.push_back({n, prediction, pixel, camera.LensJacobian(prediction.z),
                          params.features.noise == MatchNoise::adaptive ? records[n].residuals.Inflation() : 1.0});
  }
  return candidates;
}

// No more than max_searched stay, spread over the image: of every cell of the corner detector's grid the surest, then of every cell
// the second, and so on. Returned: where the others are predicted.
std::vector<Eigen::Vector2d> LeaveOut(std::vector<Candidate>& candidates, std::span<const LandmarkRecord> records, const Camera& camera,
                                      const FeatureParams& params) {
  std::vector<Eigen::Vector2d> left_out;
  const auto most = static_cast<std::size_t>(params.max_searched);
  if (candidates.size() <= most) return left_out;
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](const Candidate& a, const Candidate& b) { return records[a.landmark].score > records[b.landmark].score; });
  std::vector<Eigen::Vector2d> pixels;
  for (const Candidate& c : candidates) pixels.push_back(c.pixel);
  const std::vector<std::size_t> order = SpreadOver(pixels, params.grid_columns, params.grid_rows, camera.width, camera.height);
  std::vector<Candidate> chosen;
  for (std::size_t i = 0; i < most; ++i) chosen.push_back(candidates[order[i]]);
  for (std::size_t i = most; i < order.size(); ++i) left_out.push_back(pixels[order[i]]);
  candidates = std::move(chosen);
  return left_out;
}

SearchRequest RequestFor(const Candidate& candidate, const Filter& filter, const LandmarkRecord& record, const Camera& camera,
                         double sigma_px) {
  const Eigen::Vector3d estimate = filter.ModeOf(candidate.landmark);
  const Projection view = Project({filter.ReferencePrediction().mean, filter.AnchorOf(candidate.landmark)}, estimate);
  SearchRequest request{&record.appearance, candidate.pixel,
                        candidate.lens * candidate.prediction.covariance * candidate.lens.transpose() +
                            sigma_px * sigma_px * Eigen::Matrix2d::Identity(),
                        Eigen::Matrix2d::Identity()};
  if (view.in_front)
    request.warp = candidate.lens * view.J_landmark.leftCols<2>() * camera.LensJacobian(estimate.head<2>()).inverse();
  return request;
}

using Found = std::vector<std::optional<FoundFeature>>;

Match MatchOf(const Candidate& candidate, const FoundFeature& found, const RollingShutter& shutter, const Vector6& velocity) {
  const auto [z, moved] = shutter.AsTurned(found.pixel, velocity);
  return {candidate.landmark, z, PixelNoise(candidate.lens, candidate.inflation * found.noise), moved};
}

// Where it would be seen from the camera's place at the stamp, as far as its depth is known.
Eigen::Vector2d AtStamp(const Match& match, const MapView& map) {
  if (match.moved.isZero(0)) return match.z;
  const Projection there = map(match), here = map(match.landmark);
  return there.in_front && here.in_front ? Eigen::Vector2d(match.z - there.z + here.z) : match.z;
}

// What an inlier's residual says, the camera being where the frame's matches agree.
Residual ResidualOf(const Candidate& candidate, const Match& match, const MapView& map) {
  const Projection h = map(match);
  if (!h.in_front) return {};
  Residual residual = Residual::Of(match.z - h.z, h.J_landmark * map.landmark(match.landmark).covariance * h.J_landmark.transpose(), match.R);
  residual.ratio *= candidate.inflation;
  return residual;
}

// How fast the camera is if it is at `pose` and not where it was predicted to be: at the end of the step, by which nearly constant velocity has
// changed by more than the step's mean has.
Vector6 VelocityAt(const Filter& filter, const Pose& pose, const MotionModel& model) {
  const Matrix6 V = filter.belief().covariance.bottomRightCorner<6, 6>();
  const Matrix6 step = model.F.topRightCorner<6, 6>();
  const Matrix6 predicted = step * V * step.transpose() + model.Q.topLeftCorner<6, 6>();
  const Matrix6 shared = V * step.transpose() + model.Q.bottomLeftCorner<6, 6>();
  return filter.belief().velocity + shared * predicted.llt().solve(Minus(pose, filter.ReferencePrediction().mean));
}

// The pilots first, each request as it is; the others where the camera then turns out to be.
Found Find(const std::vector<Candidate>& candidates, const std::vector<SearchRequest>& requests, const Filter& filter,
           std::span<const LandmarkRecord> records, const Camera& camera, const RollingShutter& shutter,
           const LocalMap& map, const cv::Mat& smooth, const BriskImage& brisk, const MotionModel& model, const Params& params) {
  std::vector<PilotCandidate> possible;
  for (const Candidate& c : candidates) possible.push_back({c.pixel, &records[c.landmark]});
  const std::vector<std::size_t> pilots = ChoosePilots(possible, camera, params.features);
  if (pilots.empty()) return FindFeatures(requests, smooth, brisk, params.features);

  Found found(candidates.size());
  std::vector<bool> is_pilot(candidates.size(), false);
  std::vector<SearchRequest> first;
  for (const std::size_t i : pilots) {
    is_pilot[i] = true;
    first.push_back(requests[i]);
    first.back().widest_px = params.features.window_recovery_px;
  }
  const Found leading = FindFeatures(first, smooth, brisk, params.features);
  std::vector<Match> matches;
  for (std::size_t k = 0; k < pilots.size(); ++k) {
    found[pilots[k]] = leading[k];
    if (leading[k]) matches.push_back(MatchOf(candidates[pilots[k]], *leading[k], shutter, filter.belief().velocity));
  }

  const std::optional<PilotedPose> pose = PilotedPose::From(filter.ReferencePrediction(), map, matches, params);
  const Pose& at = pose ? pose->pose().mean : filter.ReferencePrediction().mean;
  const ImageMotion motion(shutter, map, at, VelocityAt(filter, at, model));
  std::vector<SearchRequest> rest;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (is_pilot[i]) continue;
    rest.push_back(requests[i]);
    const auto where = pose ? pose->Predict(candidates[i].landmark, camera, params.features.sigma_px) : std::nullopt;
    if (!where) continue;
    rest.back().predicted = shutter.on() ? motion.InImage(candidates[i].landmark, camera.Undistort(where->pixel)) : where->pixel;
    rest.back().S = where->covariance;
    rest.back().widest_px = std::max(params.features.window_px, WindowOf(where->covariance));
  }
  const Found following = FindFeatures(rest, smooth, brisk, params.features);
  for (std::size_t i = 0, k = 0; i < candidates.size(); ++i)
    if (!is_pilot[i]) found[i] = following[k++];
  return found;
}

}  // namespace

Association Associate(const Filter& filter, std::span<const LandmarkRecord> records, const Camera& camera, const cv::Mat& smooth,
                      const BriskImage& brisk, int border_px, double dt, const Params& params) {
  Association result;
  const LocalMap map = filter.ReferenceMap();
  const PoseGaussian& prediction = filter.ReferencePrediction();
  const double gate = OutlierGate(filter, params.score);
  const MotionModel model = NearlyConstantVelocity(params.motion, dt);
  const RollingShutter shutter(camera, params.features);
  const ImageMotion predicted(shutter, map, prediction.mean, filter.belief().velocity);
  std::vector<Candidate> candidates = FindCandidates(filter, records, camera, map, predicted, border_px, params);
  result.left_out = LeaveOut(candidates, records, camera, params.features);
  std::vector<SearchRequest> requests;
  for (const Candidate& c : candidates)
    requests.push_back(RequestFor(c, filter, records[c.landmark], camera, params.features.sigma_px));
  const Found found = Find(candidates, requests, filter, records, camera, shutter, map, smooth, brisk, model, params);

  const auto matches_at = [&](const Vector6& velocity) {
    std::vector<Match> matches;
    for (std::size_t i = 0; i < candidates.size(); ++i)
      if (found[i]) matches.push_back(MatchOf(candidates[i], *found[i], shutter, velocity));
    return matches;
  };
  std::vector<Match> matches = matches_at(filter.belief().velocity);
  std::optional<Pose> at;
  if (shutter.on()) {
    for (int round = 0; round < kShutterRounds; ++round) {
      at = FindConsensus(prediction, map, matches, gate, params.filter, at).pose.mean;
      matches = matches_at(VelocityAt(filter, *at, model));
    }
  }
  Consensus consensus = FindConsensus(prediction, map, matches, gate, params.filter, at);
  if (!params.filter.reject_outliers) consensus.inlier.assign(matches.size(), true);
  const MapView agreed(map, consensus.pose.mean);

  for (std::size_t i = 0, m = 0; i < candidates.size(); ++i) {
    const Candidate& c = candidates[i];
    Searched searched{c.landmark, std::nullopt, {}};
    FeatureView view{records[c.landmark].id, c.pixel, found[i] ? found[i]->pixel : c.pixel, requests[i].S,
                     found[i] ? Eigen::Matrix2d(c.inflation * found[i]->noise) : Eigen::Matrix2d::Zero(), FeatureView::Status::missed};
    if (found[i]) {
      const Match& match = matches[m];
      view.status = consensus.inlier[m] ? FeatureView::Status::matched : FeatureView::Status::rejected;
      if (consensus.inlier[m]) {
        const Eigen::Vector2d nu = AtStamp(match, agreed) - c.prediction.z;
        searched.mahalanobis_sq = nu.dot(Eigen::Matrix2d(c.prediction.covariance + match.R).inverse() * nu);
        searched.residual = ResidualOf(c, match, agreed);
        result.nis += *searched.mahalanobis_sq;
        result.matches.push_back(match);
      }
      ++m;
    }
    result.searched.push_back(searched);
    result.views.push_back(view);
  }
  return result;
}

}  // namespace vo
