#include "vo/frontend/association.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "vo/features/matcher.h"
#include "vo/filter/consensus.h"
#include "vo/frontend/pilots.h"
#include "vo/frontend/rolling_shutter.h"
#include "vo/frontend/spread.h"

namespace vo {
namespace {

// Velocity, then where the rows' points were at the stamp, then the velocity by these
constexpr int kShutterRounds = 3;
// Of the image's size: so far outside of it no particle has a landmark that others have inside.
constexpr double kFarOut = 0.5;

using Results = std::vector<SearchResult>;  // by request

// A frame, and what is known before it is looked at.
struct Sight {
  const Filter& filter;
  std::span<const LandmarkRecord> records;
  const Camera& camera;
  const PreparedFrame& frame;
  const Params& params;
  LastSeen last_seen;
  RollingShutter shutter;
  LocalMap map;  // of the reference

  const PoseGaussian& prediction() const { return filter.ReferencePrediction(); }
  const Vector6& velocity() const { return filter.belief().velocity; }
  Results Find(const std::vector<SearchRequest>& requests) const {
    Results results = FindFeatures(requests, frame.smooth, frame.brisk, params.features);
    for (SearchResult& result : results)
      if (result.found && !camera.HasRay(result.found->pixel)) result = {false, std::nullopt};
    return results;
  }
};

struct Candidate {
  int landmark = 0;
  ImagePrediction prediction;  // on the plane z = 1
  Eigen::Vector2d pixel;       // the same in the image
  Eigen::Matrix2d lens;        // d pixel / d(plane z = 1)
  double inflation = 1;        // of a match's covariance, by the landmark's residuals until now
};

bool WorthSearching(const Sight& in, int landmark, const ImagePrediction& prediction) {
  const Pose& now = in.prediction().mean;
  const Pose first = in.filter.AnchorOf(landmark);
  const Eigen::Vector3d estimate = in.filter.ModeOf(landmark);
  const Eigen::Vector3d first_ray = first.q_WC * Eigen::Vector3d(estimate.x(), estimate.y(), 1.0).normalized();
  const Eigen::Vector3d present_ray = now.q_WC * Eigen::Vector3d(prediction.z.x(), prediction.z.y(), 1.0).normalized();
  if (first_ray.dot(present_ray) < std::cos(in.params.features.max_view_angle))
    return false;
  const double rho = estimate.z();
  return rho <= 0 || (now.p_WC - first.p_WC).norm() * rho < in.params.features.max_baseline_ratio;
}

// A prediction costs all particles' covariances: of what lies behind the camera or far outside the image on the reference's path, none is made.
std::vector<int> Predictable(const Sight& in) {
  const Camera& camera = in.camera;
  const MapView seen(in.map, in.prediction().mean);
  std::vector<int> predictable;
  for (int n = 0; n < in.filter.landmark_count(); ++n) {
    if (in.records[n].score < in.params.score.delete_below) continue;
    const Projection view = seen(n);
    if (!view.in_front || !camera.Draws(view.z)) continue;
    const Eigen::Vector2d pixel = camera.Project({view.z.x(), view.z.y(), 1.0});
    const bool near = pixel.x() > -kFarOut * camera.width && pixel.x() < (1 + kFarOut) * camera.width &&
                      pixel.y() > -kFarOut * camera.height && pixel.y() < (1 + kFarOut) * camera.height;
    if (near) predictable.push_back(n);
  }
  return predictable;
}

// Section 7: assessed in this order.
std::vector<Candidate> FindCandidates(const Sight& in, int border_px) {
  std::vector<Candidate> candidates;
  const ImageMotion motion(in.shutter, in.map, in.prediction().mean, in.velocity());
  const std::vector<int> predictable = Predictable(in);
  const std::vector<ImagePrediction> predictions = in.filter.PredictImages(predictable);
  for (std::size_t i = 0; i < predictable.size(); ++i) {
    const int n = predictable[i];
    const ImagePrediction& prediction = predictions[i];
    if (!prediction.in_front || !in.camera.Draws(prediction.z) || !WorthSearching(in, n, prediction)) continue;
    const Eigen::Vector2d pixel = motion.InImage(n, prediction.z);
    if (!in.camera.Sees(pixel, border_px)) continue;
    candidates.push_back(
        {n, prediction, pixel, in.camera.LensJacobian(prediction.z),
         in.params.features.noise == MatchNoise::adaptive ? in.records[n].residuals.Inflation() : 1.0});
  }
  return candidates;
}

// No more than max_searched stay, spread over the image: of every cell of the corner detector's grid the surest, then of every cell
// the second, and so on. Returned: where the others are predicted.
std::vector<Eigen::Vector2d> LeaveOut(std::vector<Candidate>& candidates, const Sight& in) {
  std::vector<Eigen::Vector2d> left_out;
  const FeatureParams& params = in.params.features;
  const auto most = static_cast<std::size_t>(params.max_searched);
  if (candidates.size() <= most) return left_out;
  std::stable_sort(candidates.begin(), candidates.end(), [&](const Candidate& a, const Candidate& b) {
    return in.records[a.landmark].score > in.records[b.landmark].score;
  });
  std::vector<Eigen::Vector2d> pixels;
  for (const Candidate& c : candidates) pixels.push_back(c.pixel);
  const std::vector<std::size_t> order =
      SpreadOver(pixels, params.grid_columns, params.grid_rows, in.camera.width, in.camera.height);
  std::vector<Candidate> chosen;
  for (std::size_t i = 0; i < most; ++i) chosen.push_back(candidates[order[i]]);
  for (std::size_t i = most; i < order.size(); ++i) left_out.push_back(pixels[order[i]]);
  candidates = std::move(chosen);
  return left_out;
}

SearchRequest RequestFor(const Sight& in, const Candidate& candidate) {
  const Eigen::Vector3d estimate = in.filter.ModeOf(candidate.landmark);
  const Projection view = Project({in.prediction().mean, in.filter.AnchorOf(candidate.landmark)}, estimate);
  const double sigma_px = in.params.features.sigma_px;
  SearchRequest request{&in.records[candidate.landmark].appearance, candidate.pixel,
                        candidate.lens * candidate.prediction.covariance * candidate.lens.transpose() +
                            sigma_px * sigma_px * Eigen::Matrix2d::Identity(),
                        Eigen::Matrix2d::Identity()};
  if (view.in_front)
    request.warp =
        candidate.lens * view.J_landmark.leftCols<2>() * in.camera.LensJacobian(estimate.head<2>()).inverse();
  return request;
}

Match MatchOf(const Sight& in, const Candidate& candidate, const FoundFeature& found, const Vector6& velocity) {
  const RowView row = in.shutter.Row(found.pixel);
  const auto [z, moved] = row.AsTurned(velocity);
  return {candidate.landmark, z, PixelNoise(candidate.lens, candidate.inflation * found.noise), moved, row};
}

// What an inlier's residual says, the camera being where the frame's matches agree.
Residual ResidualOf(const Candidate& candidate, const Match& match, const MapView& map) {
  const Projection h = map(match);
  if (!h.in_front) return {};
  Residual residual = Residual::Of(
      match.z - h.z, h.J_landmark * map.landmark(match.landmark).covariance * h.J_landmark.transpose(), match.R);
  residual.ratio *= candidate.inflation;
  return residual;
}

// How fast the camera is if it is at `pose` and not where it was predicted to be: at the end of the step, by which nearly constant velocity has
// changed by more than the step's mean has.
Vector6 VelocityAt(const Sight& in, const Pose& pose) {
  return in.velocity() + VelocityChange(in.last_seen, in.params.motion, Minus(pose, in.prediction().mean));
}

// The pilots first, each request as it is; the others where the camera then turns out to be.
Results Find(const Sight& in, const std::vector<Candidate>& candidates, const std::vector<SearchRequest>& requests) {
  std::vector<PilotCandidate> possible;
  for (const Candidate& c : candidates) possible.push_back({c.pixel, &in.records[c.landmark]});
  const std::vector<std::size_t> pilots = ChoosePilots(possible, in.camera, in.params.features);
  if (pilots.empty()) return in.Find(requests);

  Results results(candidates.size());
  std::vector<bool> is_pilot(candidates.size(), false);
  std::vector<SearchRequest> first;
  for (const std::size_t i : pilots) {
    is_pilot[i] = true;
    first.push_back(requests[i]);
    first.back().widest_px = in.params.features.search_relocalise_px;
  }
  const Results leading = in.Find(first);
  std::vector<Match> matches;
  for (std::size_t k = 0; k < pilots.size(); ++k) {
    results[pilots[k]] = leading[k];
    if (leading[k].found) matches.push_back(MatchOf(in, candidates[pilots[k]], *leading[k].found, in.velocity()));
  }

  const std::optional<PilotedPose> pose = PilotedPose::From(in.prediction(), in.map, matches, in.params);
  const Pose& at = pose ? pose->pose().mean : in.prediction().mean;
  const ImageMotion motion(in.shutter, in.map, at, VelocityAt(in, at));
  std::vector<SearchRequest> rest;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (is_pilot[i]) continue;
    rest.push_back(requests[i]);
    const auto where =
        pose ? pose->Predict(candidates[i].landmark, in.camera, in.params.features.sigma_px) : std::nullopt;
    if (!where) continue;
    rest.back().predicted =
        in.shutter.on() ? motion.InImage(candidates[i].landmark, in.camera.Undistort(where->pixel)) : where->pixel;
    rest.back().S = where->covariance;
    rest.back().widest_px = std::max(in.params.features.search_normal_px, WindowOf(where->covariance));
  }
  const Results following = in.Find(rest);
  for (std::size_t i = 0, k = 0; i < candidates.size(); ++i)
    if (!is_pilot[i]) results[i] = following[k++];
  return results;
}

std::vector<Match> MatchesOf(const Sight& in, std::span<const Candidate> candidates, const Results& results,
                             const Vector6& velocity) {
  std::vector<Match> matches;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (results[i].found) matches.push_back(MatchOf(in, candidates[i], *results[i].found, velocity));
  return matches;
}

// Where the camera is by those that agree. Through a rolling shutter `matches` are then as the velocity that follows from it makes them.
Consensus Agree(const Sight& in, std::span<const Candidate> candidates, const Results& results,
                std::vector<Match>& matches) {
  const double gate = OutlierGate(in.filter, in.params.score);
  matches = MatchesOf(in, candidates, results, in.velocity());
  std::optional<Pose> at;
  for (int round = 0; in.shutter.on() && round < kShutterRounds; ++round) {
    at = FindConsensus(in.prediction(), in.map, matches, gate, in.params.filter, at).pose.mean;
    matches = MatchesOf(in, candidates, results, VelocityAt(in, *at));
  }
  Consensus consensus = FindConsensus(in.prediction(), in.map, matches, gate, in.params.filter, at);
  if (!in.params.filter.reject_outliers) consensus.inlier.assign(matches.size(), true);
  return consensus;
}

}  // namespace

Association Associate(const Filter& filter, std::span<const LandmarkRecord> records, const Camera& camera,
                      const PreparedFrame& frame, int border_px, const LastSeen& last_seen, const Params& params) {
  const Sight in{filter,
                 records,
                 camera,
                 frame,
                 params,
                 last_seen,
                 RollingShutter(camera, params.features),
                 filter.ReferenceMap()};
  Association result;
  std::vector<Candidate> candidates = FindCandidates(in, border_px);
  result.left_out = LeaveOut(candidates, in);
  std::vector<SearchRequest> requests;
  for (const Candidate& c : candidates) requests.push_back(RequestFor(in, c));
  const Results results = Find(in, candidates, requests);
  std::vector<Match> matches;
  const Consensus consensus = Agree(in, candidates, results, matches);
  const MapView agreed(in.map, consensus.pose.mean);

  for (std::size_t i = 0, m = 0; i < candidates.size(); ++i) {
    const Candidate& c = candidates[i];
    const std::optional<FoundFeature>& found = results[i].found;
    if (!found && !results[i].in_sight) continue;
    Searched searched{c.landmark, std::nullopt, {}};
    FeatureView view{records[c.landmark].id,
                     c.pixel,
                     found ? found->pixel : c.pixel,
                     requests[i].S,
                     found ? Eigen::Matrix2d(c.inflation * found->noise) : Eigen::Matrix2d::Zero(),
                     FeatureView::Status::missed};
    if (found) {
      const Match& match = matches[m];
      view.status = consensus.inlier[m] ? FeatureView::Status::matched : FeatureView::Status::rejected;
      if (consensus.inlier[m]) {
        const Eigen::Vector2d nu = agreed.AtStamp(match).z - c.prediction.z;
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
