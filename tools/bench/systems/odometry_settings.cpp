#include "tools/bench/systems/odometry_settings.h"

#include <numbers>
#include <string>

namespace vobench {
namespace {

using settings::Range;
using settings::Section;
using settings::Unit;

// The members are taken apart by structured bindings: one that is added to a struct and forgotten here does not
// compile.

void ReadMotion(Section section, vo::MotionParams& params) {
  auto& [position_noise, orientation_noise] = params;
  section.Read("position_noise", position_noise, Unit::acceleration_density, Range::Positive());
  section.Read("orientation_noise", orientation_noise, Unit::angular_acceleration_density, Range::Positive());
}

void ReadFilter(Section section, vo::FilterParams& params) {
  // Which velocities are sampled is what tells the systems apart: --system says it.
  [[maybe_unused]] auto& [sampled, proposal, particles, resample_below, max_iterations, joint_iterations, weight, lag,
                          start_window, marginal_mode, reject_outliers, ukf_alpha, ukf_beta, ukf_kappa] = params;
  section.ReadChoice("proposal", proposal,
                     {{"bootstrap", vo::Proposal::bootstrap},
                      {"ekf", vo::Proposal::ekf},
                      {"ukf", vo::Proposal::ukf},
                      {"iterated", vo::Proposal::iterated}});
  section.Read("particles", particles, Range{1, 100'000});
  section.Read("resample_below", resample_below, Range{0, 1});
  section.Read("max_iterations", max_iterations, Range{1, 1000});
  section.Read("joint_iterations", joint_iterations, Range{1, 1000});
  section.ReadChoice(
      "weight", weight,
      {{"importance", vo::Weight::importance}, {"evidence", vo::Weight::evidence}, {"equal", vo::Weight::equal}});
  section.Read("lag", lag, Range{0, 100});
  section.Read("start_window", start_window, Range{0, 100});
  section.Read("marginal_mode", marginal_mode);
  section.Read("reject_outliers", reject_outliers);
  section.Read("ukf_alpha", ukf_alpha, Range{0, 1});
  section.Read("ukf_beta", ukf_beta, Range::AtLeast(0));
  section.Read("ukf_kappa", ukf_kappa, Range::AtLeast(0));
}

void ReadLandmark(Section section, vo::LandmarkParams& params) {
  auto& [bearing, inverse_depth, inverse_depth_sigma, scale_sigma, permanent_ratio, forget_after, max_landmarks] =
      params;
  section.ReadChoice("bearing", bearing, {{"fixed", vo::Bearing::fixed}, {"estimated", vo::Bearing::estimated}});
  section.Read("inverse_depth", inverse_depth, Range::Positive());
  section.Read("inverse_depth_sigma", inverse_depth_sigma, Range::Positive());
  section.Read("scale_sigma", scale_sigma, Range{0, 3});
  section.Read("permanent_ratio", permanent_ratio, Range::Positive());
  section.Read("forget_after", forget_after, Range::AtLeast(1));
  section.Read("max_landmarks", max_landmarks, Range::AtLeast(1));
}

void ReadScore(Section section, vo::ScoreParams& params) {
  auto& [initial, delete_below, stay_visible, become_visible, detection, gate_probability, gate, blind_share,
         grace_frames] = params;
  section.Read("initial", initial, Range{0, 1});
  section.Read("delete_below", delete_below, Range{0, 1});
  section.Read("stay_visible", stay_visible, Range{0, 1});
  section.Read("become_visible", become_visible, Range{0, 1});
  section.Read("detection", detection, Range{0, 1});
  section.Read("gate_probability", gate_probability, Range{0, 1});
  section.Read("gate", gate, Range::Positive());
  section.Read("blind_share", blind_share, Range{0, 1});
  section.Read("grace_frames", grace_frames, Range::AtLeast(0));
}

void ReadFeatures(Section section, vo::FeatureParams& params) {
  auto& [sigma_px, noise, sigma_floor_px, noise_inflation, grid_columns, grid_rows, per_cell, fast_threshold_start,
         fast_threshold_min, min_distance_px, brisk_size_px, brisk_warp, max_hamming, window_quick_px, window_px,
         window_enlarged_px, window_lost_px, window_recovery_px, subpixel, max_view_angle_deg, max_baseline_ratio,
         max_searched, readout_s, pilots] = params;
  section.Read("sigma", sigma_px, Unit::pixel, Range::Positive());
  section.ReadChoice("noise", noise,
                     {{"constant", vo::MatchNoise::constant},
                      {"registered", vo::MatchNoise::registered},
                      {"adaptive", vo::MatchNoise::adaptive}});
  section.Read("sigma_floor", sigma_floor_px, Unit::pixel, Range::Positive());
  section.Read("noise_inflation", noise_inflation, Range::AtLeast(0));
  section.Read("grid_columns", grid_columns, Range::AtLeast(1));
  section.Read("grid_rows", grid_rows, Range::AtLeast(1));
  section.Read("per_cell", per_cell, Range::AtLeast(1));
  section.Read("fast_threshold_start", fast_threshold_start, Range{1, 255});
  section.Read("fast_threshold_min", fast_threshold_min, Range{1, 255});
  section.Read("min_distance", min_distance_px, Unit::pixel, Range::AtLeast(0));
  section.Read("brisk_size", brisk_size_px, Unit::pixel, Range::Positive());
  section.ReadChoice(
      "brisk_warp", brisk_warp,
      {{"none", vo::BriskWarp::none}, {"similarity", vo::BriskWarp::similarity}, {"affine", vo::BriskWarp::affine}});
  section.Read("max_hamming", max_hamming, Range{0, 1});
  section.Read("window_quick", window_quick_px, Range::AtLeast(1));
  section.Read("window", window_px, Range::AtLeast(1));
  section.Read("window_enlarged", window_enlarged_px, Range::AtLeast(1));
  section.Read("window_lost", window_lost_px, Range::AtLeast(1));
  section.Read("window_recovery", window_recovery_px, Range::AtLeast(1));
  section.Read("subpixel", subpixel);
  constexpr double kRadPerDeg = std::numbers::pi / 180;
  double max_view_angle = max_view_angle_deg * kRadPerDeg;
  if (section.Read("max_view_angle", max_view_angle, Unit::angle, Range{0, std::numbers::pi})) {
    max_view_angle_deg = max_view_angle / kRadPerDeg;
  }
  section.Read("max_baseline_ratio", max_baseline_ratio, Range::Positive());
  section.Read("max_searched", max_searched, Range::AtLeast(1));
  if (double told = 0; section.Has("rolling_shutter")) {
    section.Read("rolling_shutter", told, Unit::time, Range{-1, 1});
    readout_s = told;
  }
  section.Read("pilots", pilots, Range::AtLeast(0));
}

void ReadTarget(Section section, vo::TargetParams& params) {
  auto& [columns, rows, square_m, frames] = params;
  section.Read("columns", columns, Range{0, 100});
  section.Read("rows", rows, Range{0, 100});
  section.Read("square", square_m, Unit::length, Range::AtLeast(0));
  section.Read("frames", frames, Range::AtLeast(1));
}

}  // namespace

void ReadOdometry(Section section, vo::Params& params) {
  auto& [motion, filter, landmark, score, features, target] = params;
  ReadMotion(section.Child("motion"), motion);
  ReadFilter(section.Child("filter"), filter);
  ReadLandmark(section.Child("landmark"), landmark);
  ReadScore(section.Child("score"), score);
  ReadFeatures(section.Child("features"), features);
  ReadTarget(section.Child("target"), target);
  // Rules between several values; each text begins with the key.
  for (const std::string& problem : vo::Problems(params)) section.Reject(problem.substr(0, problem.find(' ')), problem);
}

void ReadPrior(Section section, PriorSettings& prior) {
  auto& [start, velocity_sigma, angular_rate_sigma, focal_error] = prior;
  section.ReadChoice("start", start,
                     {{"truth", PriorSettings::Start::truth}, {"origin", PriorSettings::Start::origin}});
  section.Read("velocity_sigma", velocity_sigma, Unit::speed, Range::Positive());
  section.Read("angular_rate_sigma", angular_rate_sigma, Unit::angular_rate, Range::Positive());
  section.Read("focal_error", focal_error, Range{-0.9, 9});
}

}  // namespace vobench
