#include "vo/frontend/association.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "vo/features/matcher.h"
#include "vo/filter/consensus.h"
#include "vo/frontend/corner_recognition.h"
#include "vo/frontend/moving_points.h"
#include "vo/frontend/search_set.h"
#include "vo/map/landmark_record.h"

namespace vo {
namespace {

// Fixed-point iterations between the rolling-shutter correction of the matches and the velocity that follows from them.
constexpr int kShutterRounds = 3;

constexpr double kNearly = 2;  // times the gate: rejected residuals that count for the noise

constexpr double kMoved_px = 1.5;  // of a predicted image, or a streak: beyond it a landmark is searched again

using Results = std::vector<SearchResult>;  // by request

// Guided matching without matches at pixels that are not invertible.
Results SearchAll(const AssociationContext& in, const std::vector<SearchRequest>& requests) {
  Results results = FindFeatures(requests, in.frame.smooth, in.frame.brisk, in.params.features, in.exposure_s);
  for (SearchResult& result : results)
    if (result.found && !in.camera.IsInvertible(result.found->pixel)) result = {false, std::nullopt};
  return results;
}

Match MatchOf(const AssociationContext& in, const Candidate& candidate, const FoundFeature& found,
              const Vector6& velocity) {
  const RowView row = in.shutter.Row(found.pixel);
  const auto [z, centre_offset_W] = row.RotationCompensated(velocity);
  const double wander_px = std::sqrt(candidate.inflation) * in.params.features.wander_px;
  const bool wanders =
      in.params.features.noise == MatchNoise::adaptive && in.params.landmark.bearing == Bearing::estimated;
  return {candidate.landmark, z,   PixelNoise(candidate.lens, candidate.inflation * found.noise),
          centre_offset_W,    row, wanders ? PixelNoise(candidate.lens, wander_px) : Eigen::Matrix2d::Zero(),
          candidate.inflation};
}

double MahalanobisSquared(const Eigen::Vector2d& nu, const Eigen::Matrix2d& S) { return nu.dot(S.inverse() * nu); }

// Residual of a match given the pose of `map`, and the landmark's covariance in the image.
struct ResidualAtPose {
  bool in_front = false;  // the rest is valid only then
  Eigen::Vector2d r = Eigen::Vector2d::Zero();
  Eigen::Matrix2d of_landmark = Eigen::Matrix2d::Zero();
};
ResidualAtPose ResidualGivenPose(const Match& match, const MapView& map) {
  const Projection h = map(match);
  if (!h.in_front) return {};
  return {true, match.z - h.z, h.J_landmark * map.landmark(match.landmark).covariance * h.J_landmark.transpose()};
}

// The same relative to R without inflation, for the landmark's history.
Residual ResidualOf(const Candidate& candidate, const Match& match, const ResidualAtPose& at) {
  if (!at.in_front) return {};
  Residual residual = Residual::Of(at.r, at.of_landmark, match.R);
  residual.ratio *= candidate.inflation;
  return residual;
}

// Velocity given that the camera is at `pose` instead of its prediction.
Vector6 VelocityAt(const AssociationContext& in, const Pose& pose) {
  return in.velocity() + VelocityCorrection(in.since_update, in.params.motion, Minus(pose, in.prediction().mean));
}

// Request in a small window about the prediction of the landmark from the coarse pose.
SearchRequest Refined(const AssociationContext& in, const PoseGaussian& pose, const ImageMotion& motion,
                      const Candidate& candidate, SearchRequest request) {
  const int landmark = candidate.landmark;
  const auto prediction = PredictPixel(pose, motion.view(), landmark, in.camera, in.params.features.sigma_px);
  if (!prediction) return request;
  const Eigen::Vector2d rate = motion.Rate(landmark);
  request.predicted =
      in.shutter.on() ? in.shutter.InImage(in.camera.Undistort(prediction->pixel), rate) : prediction->pixel;
  request.rate = candidate.lens * rate;
  request.S = prediction->covariance;
  request.widest_px = std::max(in.params.features.search_normal_px, WindowSide(prediction->covariance));
  return request;
}

// Coarse-to-fine: the coarse features in wide windows about the prediction, the others in small ones about the coarse
// pose. `requests` become those of the small windows.
Results SearchCoarseToFine(const AssociationContext& in, const std::vector<Candidate>& candidates,
                           std::vector<SearchRequest>& requests) {
  const std::vector<std::size_t> coarse =
      SelectCoarseFeatures(candidates, in.records, in.camera, in.params.features, in.search);
  if (coarse.empty()) return SearchAll(in, requests);

  Results results(candidates.size());
  std::vector<bool> is_coarse(candidates.size(), false);
  std::vector<SearchRequest> wide;
  for (const std::size_t i : coarse) {
    is_coarse[i] = true;
    wide.push_back(requests[i]);
    wide.back().widest_px = in.params.features.search_relocalise_px;
  }
  const Results coarse_results = SearchAll(in, wide);
  std::vector<Match> matches;
  for (std::size_t k = 0; k < coarse.size(); ++k) {
    const SearchResult& result = coarse_results[k];
    results[coarse[k]] = result;
    if (result.found) matches.push_back(MatchOf(in, candidates[coarse[k]], *result.found, in.velocity()));
  }

  const std::optional<PoseGaussian> pose = FitCoarsePose(in.prediction(), in.reference.map, matches, in.params);
  const Pose& at = pose ? pose->mean : in.prediction().mean;
  const ImageMotion motion(in.shutter, in.reference.map, at, VelocityAt(in, at));
  std::vector<SearchRequest> fine;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (is_coarse[i]) continue;
    if (pose) requests[i] = Refined(in, *pose, motion, candidates[i], requests[i]);
    fine.push_back(requests[i]);
  }
  const Results fine_results = SearchAll(in, fine);
  for (std::size_t i = 0, k = 0; i < candidates.size(); ++i)
    if (!is_coarse[i]) results[i] = fine_results[k++];
  return results;
}

// Search of the missed landmarks about the corners at which they are recognised, within the widest window.
void SearchAtCorners(const AssociationContext& in, const std::vector<SearchRequest>& requests, int border_px,
                     Results& results) {
  constexpr int kMoreCorners = 8;  // per cell
  std::vector<std::size_t> missed;
  std::vector<const Descriptor*> known;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    if (results[i].found || !results[i].in_sight) continue;
    missed.push_back(i);
    known.push_back(&requests[i].appearance->descriptor);
  }
  const FeatureParams& params = in.params.features;
  std::vector<std::size_t> chosen;
  std::vector<SearchRequest> again;
  for (const auto& [index, pixel] : RecogniseCorners(in.frame, known, params, kMoreCorners, border_px)) {
    SearchRequest request = requests[missed[index]];
    const Eigen::Vector2d corner = pixel.cast<double>();
    if (2 * (corner - request.predicted).cwiseAbs().maxCoeff() > params.search_relocalise_px) continue;
    request.predicted = corner;
    request.widest_px = params.search_normal_px;
    chosen.push_back(missed[index]);
    again.push_back(request);
  }
  const Results found = SearchAll(in, again);
  for (std::size_t k = 0; k < chosen.size(); ++k)
    if (found[k].found) results[chosen[k]] = found[k];
}

std::vector<Match> MatchesOf(const AssociationContext& in, std::span<const Candidate> candidates,
                             const Results& results, const Vector6& velocity) {
  std::vector<Match> matches;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (results[i].found) matches.push_back(MatchOf(in, candidates[i], *results[i].found, velocity));
  if (in.params.landmark.proving_matches > 0 && !in.filter.answer().initialising)
    MarkProvisional(in.records, in.params.landmark.proving_matches, matches);
  return matches;
}

// Robust fit of the pose to the matches. With a rolling shutter `matches` are corrected by the velocity that follows
// from it.
Consensus RobustPose(const AssociationContext& in, std::span<const Candidate> candidates, const Results& results,
                     std::vector<Match>& matches) {
  const double gate = OutlierGate(in.filter.answer(), in.params.score);
  matches = MatchesOf(in, candidates, results, in.velocity());
  std::optional<Pose> at;
  for (int round = 0; in.shutter.on() && round < kShutterRounds; ++round) {
    at = FindConsensus(in.prediction(), in.reference.map, matches, gate, in.params.filter, at).pose.mean;
    const Vector6 velocity = VelocityAt(in, *at);
    for (Match& match : matches) {
      const auto [z, centre_offset_W] = match.row.RotationCompensated(velocity);
      match.z = z;
      match.centre_offset_W = centre_offset_W;
    }
  }
  Consensus consensus = FindConsensus(in.prediction(), in.reference.map, matches, gate, in.params.filter, at);
  if (!in.params.filter.reject_outliers) consensus.inlier.assign(matches.size(), true);
  return consensus;
}

// Second search about the robust pose: landmarks without an agreeing match, and those whose streak differs. Returns
// whether there were any.
bool SearchAgain(const AssociationContext& in, std::span<const Candidate> candidates, const Consensus& consensus,
                 std::vector<SearchRequest>& requests, Results& results) {
  const Pose& at = consensus.pose.mean;
  const ImageMotion motion(in.shutter, in.reference.map, at, VelocityAt(in, at));
  std::vector<std::size_t> chosen;
  std::vector<SearchRequest> again;
  for (std::size_t i = 0, m = 0; i < candidates.size(); ++i) {
    const bool agrees = results[i].found && consensus.inlier[m];
    if (results[i].found) ++m;
    const SearchRequest request = Refined(in, consensus.pose, motion, candidates[i], requests[i]);
    const double moved_px = (request.predicted - requests[i].predicted).norm();
    const double streak_px = in.exposure_s * (request.rate - requests[i].rate).norm();
    if ((agrees || moved_px < kMoved_px) && streak_px < kMoved_px) continue;
    chosen.push_back(i);
    again.push_back(request);
  }
  const Results found = SearchAll(in, again);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    if (!found[k].found) continue;
    requests[chosen[k]] = again[k];
    results[chosen[k]] = found[k];
  }
  return !chosen.empty();
}

}  // namespace

Association Associate(const Filter& filter, std::span<const LandmarkRecord> records, const Camera& camera,
                      const PreparedFrame& frame, int border_px, const SinceUpdate& since_update, Search search,
                      const Params& params, double noise_level, double exposure_s, int budget) {
  const AssociationContext in{filter,
                              records,
                              camera,
                              frame,
                              params,
                              since_update,
                              search,
                              RollingShutter(camera, params.features),
                              filter.Reference(),
                              noise_level,
                              exposure_s};
  Association result;
  std::vector<Candidate> candidates = FindCandidates(in, border_px);
  result.left_out = LimitToBudget(candidates, in, budget);
  std::vector<SearchRequest> requests;
  for (const Candidate& c : candidates) requests.push_back(RequestFor(in, c));
  Results results = SearchCoarseToFine(in, candidates, requests);
  if (search == Search::wide) SearchAtCorners(in, requests, border_px, results);
  std::vector<Match> matches;
  Consensus consensus = RobustPose(in, candidates, results, matches);
  const auto agree = std::ranges::count(consensus.inlier, true);
  if (params.motion.adaptive && !filter.answer().initialising && agree >= FrameDiagnostics::kTrackedMatches &&
      SearchAgain(in, candidates, consensus, requests, results))
    consensus = RobustPose(in, candidates, results, matches);
  const MapView map(in.reference.map, consensus.pose.mean);
  result.predicted = in.prediction();
  result.agreed = consensus.pose;
  const ImageMotion motion(in.shutter, in.reference.map, consensus.pose.mean, VelocityAt(in, consensus.pose.mean));

  for (std::size_t i = 0, m = 0; i < candidates.size(); ++i) {
    const Candidate& c = candidates[i];
    const std::optional<FoundFeature>& found = results[i].found;
    if (!found && !results[i].in_sight) continue;
    Searched searched{c.landmark, std::nullopt, {}};
    FeatureView view{records[c.landmark].id,
                     c.pixel,
                     found ? found->pixel : c.pixel,
                     c.InnovationCovariance(params.features.sigma_px),
                     found ? Eigen::Matrix2d(c.inflation * found->noise) : Eigen::Matrix2d::Zero(),
                     FeatureView::Status::missed};
    if (found) {
      const Match& match = matches[m];
      const ResidualAtPose at = ResidualGivenPose(match, map);
      searched.residual = ResidualOf(c, match, at);
      view.status = consensus.inlier[m] ? FeatureView::Status::matched : FeatureView::Status::rejected;
      if (consensus.inlier[m]) {
        const Eigen::Vector2d nu = map.AtStamp(match).z - c.prediction.z;
        const double predicted_sq = MahalanobisSquared(nu, c.prediction.covariance + match.R);
        searched.mahalanobis_sq =
            params.motion.adaptive && at.in_front ? MahalanobisSquared(at.r, at.of_landmark + match.R) : predicted_sq;
        result.nis += predicted_sq;
        result.matches.push_back(match);
        result.moving.push_back(
            {c.landmark, requests[i].warp, found->pixel, requests[i].first_rate, c.lens * motion.Rate(c.landmark)});
        if (records[c.landmark].unseen()) ++result.unseen_matched;
      } else if (searched.residual.ratio > c.inflation * kNearly * params.score.gate) {
        searched.residual = {};
      }
      ++m;
    }
    if (records[c.landmark].unseen()) ++result.unseen;
    result.searched.push_back(searched);
    result.views.push_back(view);
  }
  return result;
}

int NextBudget(const Association& association, const FeatureParams& params) {
  const auto matches = static_cast<double>(association.matches.size());
  if (association.repeated > 0 || matches < FrameDiagnostics::kTrackedMatches) return params.max_searched;
  const double per_match = static_cast<double>(association.searched.size()) / matches;
  return static_cast<int>(std::min<double>(std::ceil(params.enough_matches * per_match), params.max_searched));
}

void Association::RejectAll() {
  matches.clear();
  nis = 0;
  for (Searched& one : searched) one.mahalanobis_sq.reset();
  for (FeatureView& view : views)
    if (view.status == FeatureView::Status::matched) view.status = FeatureView::Status::rejected;
}

void UpdateScores(const Association& association, const ScoreParams& params, std::span<LandmarkRecord> records) {
  for (LandmarkRecord& record : records) {
    if (!record.lost) record.score = PredictScore(record.score, params);
    ++record.frames_unmatched;
    ++record.age;
    ++record.frames_unsearched;
    record.searched = false;
  }
  for (const LeftOut& one : association.left_out) --records[one.landmark].frames_unmatched;
  for (const Searched& searched : association.searched) records[searched.landmark].searched = true;
  const auto expected = std::ranges::count_if(
      association.searched, [&](const Searched& s) { return s.mahalanobis_sq || !records[s.landmark].lost; });
  if (static_cast<double>(association.matches.size()) < params.min_found_ratio * static_cast<double>(expected)) return;
  for (const Searched& searched : association.searched) {
    LandmarkRecord& record = records[searched.landmark];
    record.score = UpdateScore(record.score, searched.mahalanobis_sq, params);
    if (searched.mahalanobis_sq) {
      record.residuals.Add(searched.residual);
      record.frames_unmatched = 0;
      record.lost = false;
      ++record.inliers;
    }
    record.frames_unsearched = 0;
  }
}

void NoiseLevel::Learn(const Association& association) {
  constexpr double kEnough = 10, kRate = 0.1, kLeast = 0.3, kMost = 20;
  double weight = 0, sum = 0;
  for (const Searched& one : association.searched) {
    weight += one.residual.weight;
    sum += one.residual.weight * one.residual.ratio;
  }
  if (weight < kEnough) return;
  const double rate = std::max(kRate, 1.0 / ++frames_);
  value_ = std::clamp(value_ + rate * (sum / weight - value_), kLeast, kMost);
}

}  // namespace vo
