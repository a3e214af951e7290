#include "vo/base/params.h"

#include <cmath>
#include <sstream>

namespace vo {
namespace {

class Checker {
 public:
  void Require(bool ok, const char* name, double value, const char* rule) {
    if (ok && std::isfinite(value)) return;
    std::ostringstream text;
    text << name << " = " << value << " " << rule;
    problems_.push_back(text.str());
  }
  void Refuse(const char* sentence) { problems_.emplace_back(sentence); }
  void Positive(const char* name, double value) { Require(value > 0, name, value, "must be positive"); }
  void Probability(const char* name, double value) {
    Require(value > 0 && value < 1, name, value, "must lie between 0 and 1");
  }
  std::vector<std::string> Take() { return std::move(problems_); }

 private:
  std::vector<std::string> problems_;
};

}  // namespace

std::vector<std::string> Problems(const Params& params) {
  Checker check;
  check.Positive("motion.position_noise", params.motion.position_noise);
  check.Positive("motion.orientation_noise", params.motion.orientation_noise);

  const FilterParams& filter = params.filter;
  check.Require(filter.particles >= 1, "filter.particles", filter.particles, "must be at least 1");
  check.Require(filter.resample_below >= 0 && filter.resample_below <= 1, "filter.resample_below",
                filter.resample_below, "must lie in 0 ... 1");
  check.Require(filter.max_iterations >= 1, "filter.max_iterations", filter.max_iterations, "must be at least 1");
  check.Require(filter.joint_iterations >= 1, "filter.joint_iterations", filter.joint_iterations, "must be at least 1");
  check.Require(filter.lag >= 0, "filter.lag", filter.lag, "must not be negative");
  check.Require(filter.start_window >= 0, "filter.start_window", filter.start_window, "must not be negative");
  check.Require(filter.ukf_alpha > 0 && filter.ukf_alpha <= 1, "filter.ukf_alpha", filter.ukf_alpha,
                "must be above 0 and at most 1");
  check.Require(filter.ukf_beta >= filter.ukf_alpha * filter.ukf_alpha, "filter.ukf_beta", filter.ukf_beta,
                "must be at least filter.ukf_alpha squared, or covariances lose their sign");
  check.Require(filter.ukf_kappa >= 0, "filter.ukf_kappa", filter.ukf_kappa, "must not be negative");
  if (filter.proposal == Proposal::bootstrap && filter.weight != Weight::importance)
    check.Refuse(
        "filter.weight must be importance where filter.proposal is bootstrap: a proposal blind to the image has no "
        "evidence");
  if (filter.weight == Weight::equal)
    check.Require(filter.lag > 0, "filter.lag", filter.lag,
                  "must be above 0 for filter.weight equal: the window's images must have spoken before a draw");
  if (filter.lag > 0) {
    check.Require(filter.proposal == Proposal::ekf || filter.proposal == Proposal::iterated, "filter.lag", filter.lag,
                  "needs filter.proposal ekf or iterated: bootstrap and ukf know no window of poses");
    check.Require(filter.sampled == Sampled::pose, "filter.lag", filter.lag, "needs the velocity unsampled (rb2pf)");
    check.Require(filter.weight != Weight::importance, "filter.lag", filter.lag, "needs weight: evidence or equal");
  }

  const LandmarkParams& landmark = params.landmark;
  check.Positive("landmark.inverse_depth", landmark.inverse_depth);
  check.Positive("landmark.inverse_depth_sigma", landmark.inverse_depth_sigma);
  check.Require(landmark.scale_sigma >= 0 && landmark.scale_sigma <= 3, "landmark.scale_sigma", landmark.scale_sigma,
                "must lie in 0 ... 3");
  check.Positive("landmark.permanent_ratio", landmark.permanent_ratio);
  check.Require(landmark.forget_after >= 1, "landmark.forget_after", landmark.forget_after, "must be at least 1");
  check.Require(landmark.max_landmarks >= 10, "landmark.max_landmarks", landmark.max_landmarks, "must be at least 10");

  const ScoreParams& score = params.score;
  check.Probability("score.initial", score.initial);
  check.Probability("score.delete_below", score.delete_below);
  check.Probability("score.stay_visible", score.stay_visible);
  check.Probability("score.become_visible", score.become_visible);
  check.Probability("score.detection", score.detection);
  check.Probability("score.gate_probability", score.gate_probability);
  check.Positive("score.gate", score.gate);
  check.Require(score.blind_share >= 0 && score.blind_share < 1, "score.blind_share", score.blind_share,
                "must lie in 0 ... 1");
  check.Require(score.grace_frames >= 0, "score.grace_frames", score.grace_frames, "must not be negative");

  const FeatureParams& features = params.features;
  check.Require(features.pilots >= 0, "features.pilots", features.pilots, "must not be negative");
  const auto odd = [&](const char* name, int value) {
    check.Require(value >= 1 && value % 2 == 1, name, value, "must be odd and positive");
  };
  check.Positive("features.sigma_px", features.sigma_px);
  check.Positive("features.sigma_floor_px", features.sigma_floor_px);
  check.Require(features.noise_inflation >= 0, "features.noise_inflation", features.noise_inflation,
                "must not be negative");
  check.Require(features.grid_columns >= 1, "features.grid_columns", features.grid_columns, "must be at least 1");
  check.Require(features.grid_rows >= 1, "features.grid_rows", features.grid_rows, "must be at least 1");
  check.Require(features.per_cell >= 1, "features.per_cell", features.per_cell, "must be at least 1");
  check.Require(features.fast_threshold_min >= 1, "features.fast_threshold_min", features.fast_threshold_min,
                "must be at least 1");
  check.Require(features.fast_threshold_start >= features.fast_threshold_min && features.fast_threshold_start <= 255,
                "features.fast_threshold_start", features.fast_threshold_start,
                "must lie between fast_threshold_min and 255");
  check.Positive("features.min_distance_px", features.min_distance_px);
  check.Positive("features.brisk_size_px", features.brisk_size_px);
  check.Require(features.max_hamming > 0 && features.max_hamming <= 1, "features.max_hamming", features.max_hamming,
                "must lie in 0 ... 1");
  odd("features.window_quick_px", features.window_quick_px);
  odd("features.window_px", features.window_px);
  odd("features.window_enlarged_px", features.window_enlarged_px);
  odd("features.window_lost_px", features.window_lost_px);
  odd("features.window_recovery_px", features.window_recovery_px);
  check.Require(features.window_enlarged_px >= features.window_px, "features.window_enlarged_px",
                features.window_enlarged_px, "must not be below features.window_px");
  check.Require(features.window_lost_px >= features.window_enlarged_px, "features.window_lost_px",
                features.window_lost_px, "must not be below features.window_enlarged_px");
  check.Require(features.window_recovery_px >= features.window_lost_px, "features.window_recovery_px",
                features.window_recovery_px, "must not be below features.window_lost_px");
  check.Require(features.max_view_angle_deg > 0 && features.max_view_angle_deg < 90, "features.max_view_angle_deg",
                features.max_view_angle_deg, "must lie between 0 and 90");
  check.Positive("features.max_baseline_ratio", features.max_baseline_ratio);
  check.Require(std::abs(features.readout_s.value_or(0)) <= 1, "features.readout_s", features.readout_s.value_or(0),
                "must lie in -1 ... 1 s");
  check.Require(features.max_searched >= 1, "features.max_searched", features.max_searched, "must be at least 1");
  const TargetParams& target = params.target;
  if (target.columns != 0 || target.rows != 0) {  // findChessboardCornersSB asks for three
    check.Require(target.columns >= 3, "target.columns", target.columns, "must be 3 or more, or 0 with target.rows 0");
    check.Require(target.rows >= 3, "target.rows", target.rows, "must be 3 or more, or 0 with target.columns 0");
    check.Positive("target.square", target.square_m);
    check.Require(landmark.scale_sigma == 0, "landmark.scale_sigma", landmark.scale_sigma,
                  "must be 0 where a target tells the scale");
    check.Require(target.frames >= 1, "target.frames", target.frames, "must be at least 1");
  }
  return check.Take();
}

}  // namespace vo
