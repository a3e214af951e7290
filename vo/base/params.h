// Settings of the odometry: one struct per component, with its field table (key in `odometry:`, unit, range, meaning).
// Defaults are those of docs/algorithm.md, section 11; the paper's (Section V-A) are systems rb2pf_paper and
// rbpf_paper.
#pragma once

#include <numbers>
#include <optional>
#include <vector>

#include "tools/base/settings/fields.h"

namespace vo {

using settings::Range;
using settings::Unit;

// Nearly constant velocity (6)-(9).
struct MotionParams {
  double position_noise = 2.5;     // [m/s^1.5]
  double orientation_noise = 1.0;  // [rad/s^1.5]
  bool adaptive = true;
};

template <class V>
void Visit(V& v, MotionParams& p) {
  v("position_noise", p.position_noise,
    {Unit::acceleration_density, Range::Positive(), "root of the power spectral density of white acceleration"});
  v("orientation_noise", p.orientation_noise,
    {Unit::angular_acceleration_density, Range::Positive(), "the same of white angular acceleration"});
  v("adaptive", p.adaptive,
    {"on images: estimate both on line, from the values above on, and repeat failed predictions"});
}

enum class Sampled {
  nothing,            // EKF-SLAM: one Gaussian over everything
  pose,               // RB2-PF: velocity stays Gaussian in each particle
  pose_and_velocity,  // RB-PF (FastSLAM 2.0): velocity is sampled too
};

enum class Proposal {
  bootstrap,  // the motion model, without the image; the weight is the likelihood at the sample (FastSLAM 1.0)
  ekf,        // one linearisation at the prediction, landmarks at their prior mean
  ukf,        // unscented transform of the predicted pose, and of each landmark given the pose: the paper
  iterated,   // Gauss-Newton to the joint mode of pose and landmarks
};

enum class Bearing {
  fixed,      // the paper: a landmark is its inverse depth alone (1-D)
  estimated,  // ray and inverse depth (3-D): the pixel noise of the first view is part of the state
};

enum class Weight {
  importance,  // (17) at the sample: the paper
  evidence,    // p(z_t | path) by Laplace's approximation: the same on a linear-Gaussian model, without sampling noise
  uniform,     // all alike but for rejected particles; drawn together, exact in mean and covariance. Needs lag > 0
};

struct FilterParams {
  Sampled sampled = Sampled::pose;  // no key: it distinguishes the systems
  Proposal proposal = Proposal::iterated;
  int particles = 16;
  double resample_below = 0.5;
  int max_iterations = 10;
  int joint_iterations = 1;
  Weight weight = Weight::uniform;
  int lag = 5;
  int start_window = 30;
  bool marginal_mode = false;
  bool reject_outliers = true;
  double ukf_alpha = 1, ukf_beta = 2, ukf_kappa = 0;  // no weight is negative with these
};

template <class V>
void Visit(V& v, FilterParams& p) {
  using enum Proposal;
  v("proposal", p.proposal, {{"bootstrap", bootstrap}, {"ekf", ekf}, {"ukf", ukf}, {"iterated", iterated}},
    "of poses: motion model; one linearisation; unscented transform (the paper); joint mode");
  v("particles", p.particles, {Range{1, 100'000}, "number of particles"});
  v("resample_below", p.resample_below, {Range{0, 1}, "least N_eff, as a fraction of the particles"});
  v("max_iterations", p.max_iterations, {Range{1, 1000}, "of Gauss-Newton: poses, a landmark given the pose"});
  v("joint_iterations", p.joint_iterations, {Range{1, 1000}, "of `ekfslam`; above 1: the joint mode, biased in scale"});
  v.Renamed("weight", "equal", "uniform");
  v("weight", p.weight,
    {{"importance", Weight::importance}, {"evidence", Weight::evidence}, {"uniform", Weight::uniform}},
    "(17) at the sample (the paper); p(z_t given the path) by Laplace's approximation (lag 0); all alike (with a lag)");
  v("lag", p.lag,
    {Range{0, 100},
     "poses that stay Gaussian before the oldest is sampled; 0: the paper, and without a window (ukf, bootstrap, "
     "importance)"});
  v("start_window", p.start_window, {Range{0, 100}, "first poses, solved as one window; 0: the paper"});
  v("marginal_mode", p.marginal_mode, {"propose at the mode of the poses' marginal, unbiased in scale"});
  v("reject_outliers", p.reject_outliers, {"leave out matches that contradict the others"});
  v("ukf_alpha", p.ukf_alpha, {Range{.min = 0, .max = 1, .above_min = true}, "spread of the sigma points"});
  v("ukf_beta", p.ukf_beta, {Range::AtLeast(0), "at least alpha squared; 2: a Gaussian's kurtosis"});
  v("ukf_kappa", p.ukf_kappa, {Range::AtLeast(0), "the spread is alpha sqrt(n + kappa)"});
}

struct LandmarkParams {
  Bearing bearing = Bearing::estimated;
  double inverse_depth = 0.25;        // [1/m]
  double inverse_depth_sigma = 0.15;  // [1/m]
  double scale_sigma = 0.5;
  double permanent_ratio = 0.05;  // our choice; not given in the paper
  int proving_matches = 5;
  int forget_after = 90;
  int max_landmarks = 1000;
};

template <class V>
void Visit(V& v, LandmarkParams& p) {
  v("bearing", p.bearing, {{"fixed", Bearing::fixed}, {"estimated", Bearing::estimated}},
    "state of a landmark: inverse depth alone (the paper); or ray and inverse depth");
  v("inverse_depth", p.inverse_depth, {Range::Positive(), "prior mean of a new landmark [1/m]"});
  v("inverse_depth_sigma", p.inverse_depth_sigma, {Range::Positive(), "its standard deviation [1/m]"});
  v("scale_sigma", p.scale_sigma,
    {Range{0, 3}, "prior standard deviation of the log of the scale of all lengths; 0 with a target"});
  v("permanent_ratio", p.permanent_ratio, {Range::Positive(), "permanent when sigma_rho < ratio * rho"});
  v("proving_matches", p.proving_matches,
    {Range::AtLeast(0), "on images: matches that agree until a new one acts on the pose"});
  v("forget_after", p.forget_after, {Range::AtLeast(1), "frames without a search until one not permanent is deleted"});
  v("max_landmarks", p.max_landmarks, {Range::AtLeast(10), "on images: new ones replace those longest out of view"});
}

// Existence score (44)-(49).
struct ScoreParams {
  double initial = 0.5;
  double delete_below = 0.4;
  double stay_visible = 0.95;       // P22
  double become_visible = 0.05;     // P12
  double detection = 0.75;          // P_D
  double gate_probability = 0.995;  // P_G
  double gate = 9.21;               // G (the paper's pair; 0.995 would be 10.6)
  double min_found_ratio = 0.2;
  int grace_frames = 0;
};

template <class V>
void Visit(V& v, ScoreParams& p) {
  const Range probability = Range::Between(0, 1);
  v("initial", p.initial, {probability, "existence probability of a new landmark"});
  v("delete_below", p.delete_below, {probability, "a landmark below this is deleted"});
  v("stay_visible", p.stay_visible, {probability, "P22: visible in this frame if in the last"});
  v("become_visible", p.become_visible, {probability, "P12: visible in this frame if not in the last"});
  v("detection", p.detection, {probability, "P_D: a visible landmark is matched"});
  v("gate_probability", p.gate_probability, {probability, "P_G: a match of the landmark lies in the gate"});
  v("gate", p.gate, {Range::Positive(), "G: largest squared Mahalanobis distance of a match"});
  v.Renamed("blind_share", "min_found_ratio");
  v("min_found_ratio", p.min_found_ratio,
    {Range{.min = 0, .max = 1, .below_max = true},
     "below this share found of those searched, scores are only predicted, by (44)"});
  v("grace_frames", p.grace_frames, {Range::AtLeast(0), "a younger landmark is not deleted for its score"});
}

// Warp of BRISK's pattern when a landmark is searched again: by the predicted pose, never estimated from the image.
enum class BriskWarp {
  none,        // as in the first view
  similarity,  // rotation and scale
  affine,      // and shear
};

// Covariance of a match's error.
enum class MatchNoise {
  constant,    // sigma_px for all
  registered,  // registered match: sigma_floor_px, and the registration's least-squares covariance * noise_inflation
  adaptive,    // the same and a random walk, times a factor from each landmark's own residuals
};

struct FeatureParams {
  double sigma_px = 0.7;  // the paper, to whole pixels: 2
  MatchNoise noise = MatchNoise::adaptive;
  double first_view_px = 0.2;
  double sigma_floor_px = 0.05;
  double noise_inflation = 1;
  double wander_px = 0.02;
  int grid_columns = 8, grid_rows = 6;
  int per_cell = 3;
  int fast_threshold_start = 60;  // grey levels
  int fast_threshold_min = 7;
  double min_distance_px = 10;
  double brisk_size_px = 12;
  BriskWarp brisk_warp = BriskWarp::affine;
  double max_hamming = 0.15;
  int search_first_px = 5;
  int search_normal_px = 9;
  int search_wide_px = 17;
  int search_uncertain_px = 49;
  int search_relocalise_px = 241;
  bool subpixel = true;
  double max_view_angle = 45 * std::numbers::pi / 180;  // [rad]
  double max_baseline_ratio = 0.3;
  int max_searched = 200;
  int enough_matches = 100;
  std::optional<double> readout_s = std::nullopt;
  int coarse_features = 16;
};

template <class V>
void Visit(V& v, FeatureParams& p) {
  const Range window = Range::OddAtLeast(1);
  v("sigma", p.sigma_px, {Unit::pixel, Range::Positive(), "of a match per axis; the paper, to whole pixels: 2 px"});
  v("noise", p.noise,
    {{"constant", MatchNoise::constant}, {"registered", MatchNoise::registered}, {"adaptive", MatchNoise::adaptive}},
    "covariance of a match: `sigma`; from its registration; that times a factor from the landmark's residuals");
  v("first_view_sigma", p.first_view_px,
    {Unit::pixel, Range::Positive(), "of a landmark's place in its first view, where matches are registered to it"});
  v("sigma_floor", p.sigma_floor_px, {Unit::pixel, Range::Positive(), "least of a registered match"});
  v("noise_inflation", p.noise_inflation, {Range::AtLeast(0), "factor on the registration's covariance"});
  v("wander", p.wander_px,
    {Unit::pixel, Range::AtLeast(0), "random walk, from match to match, of what a patch follows; `adaptive` alone"});
  v("grid_columns", p.grid_columns, {Range::AtLeast(1), "cells of the grid on which corners are detected"});
  v("grid_rows", p.grid_rows, {Range::AtLeast(1), "the same"});
  v("per_cell", p.per_cell, {Range::AtLeast(1), "corners wanted in each cell"});
  v("fast_threshold_start", p.fast_threshold_start,
    {Range{1, 255}, "FAST's threshold [grey levels], lowered per cell"});
  v("fast_threshold_min", p.fast_threshold_min, {Range{1, 255}, "its least value"});
  v("min_distance", p.min_distance_px, {Unit::pixel, Range::Positive(), "of a new corner from any other feature"});
  v("brisk_size", p.brisk_size_px, {Unit::pixel, Range::Positive(), "diameter of BRISK's pattern (OpenCV's size)"});
  v("brisk_warp", p.brisk_warp,
    {{"none", BriskWarp::none}, {"similarity", BriskWarp::similarity}, {"affine", BriskWarp::affine}},
    "of the descriptor's pattern, by the predicted pose");
  v("max_hamming", p.max_hamming,
    {Range{.min = 0, .max = 1, .above_min = true}, "of a match, as a fraction of 512 bits"});
  v.Renamed("window_quick", "search_first");
  v.Renamed("window", "search_normal");
  v.Renamed("window_enlarged", "search_wide");
  v.Renamed("window_lost", "search_uncertain");
  v.Renamed("window_recovery", "search_relocalise");
  v("search_first", p.search_first_px, {Unit::pixel, window, "side of the first window; 1: the paper, without it"});
  v("search_normal", p.search_normal_px, {Unit::pixel, window, "side of the search window about the prediction"});
  v("search_wide", p.search_wide_px, {Unit::pixel, window, "the same where nothing fits in the normal one"});
  v("search_uncertain", p.search_uncertain_px,
    {Unit::pixel, window, "largest side, where the prediction is uncertain"});
  v("search_relocalise", p.search_relocalise_px, {Unit::pixel, window, "the same for coarse features, after a gap"});
  v("subpixel", p.subpixel, {"refine a match by registering the patch of the first view"});
  v("max_view_angle", p.max_view_angle,
    {Unit::angle, Range::Between(0, std::numbers::pi / 2), "between the first and the present viewing ray"});
  v("max_baseline_ratio", p.max_baseline_ratio, {Range::Positive(), "distance from the first view / depth there"});
  v("max_searched", p.max_searched, {Range::AtLeast(1), "landmarks searched per frame"});
  v("enough_matches", p.enough_matches,
    {Range::AtLeast(1),
     "matches wanted per frame: it limits the landmarks of known depth that are searched; `motion.adaptive` alone"});
  v("rolling_shutter", p.readout_s, {Unit::time, Range{-1, 1}, "readout time of all rows, instead of the camera's"});
  v.Renamed("pilots", "coarse_features");
  v("coarse_features", p.coarse_features,
    {Range::AtLeast(0), "landmarks searched first, in large windows; 0: the paper"});
}

// Calibration target: a chessboard before the camera at the start, which gives the scale.
struct TargetParams {
  int columns = 0, rows = 0;
  double square_m = 0;
  int frames = 30;
};

template <class V>
void Visit(V& v, TargetParams& p) {
  v("columns", p.columns, {Range{0, 100}, "inner corners of the chessboard, where four squares meet; 0: none"});
  v("rows", p.rows, {Range{0, 100}, "the same"});
  v("square", p.square_m, {Unit::length, Range::AtLeast(0), "side of a square"});
  v("frames", p.frames, {Range::AtLeast(1), "first frames in which it is searched"});
}

// Estimated camera parameters.
struct CalibrationParams {
  bool estimate = true;
};

template <class V>
void Visit(V& v, CalibrationParams& p) {
  v("estimate", p.estimate,
    {"on images: the shutter's readout time where it is not stated, and a check of the focal length"});
}

struct Params {
  MotionParams motion;
  FilterParams filter;
  LandmarkParams landmark;
  ScoreParams score;
  FeatureParams features;
  TargetParams target;
  CalibrationParams calibration;
};

template <class V>
void Visit(V& v, Params& p) {
  v.Child("motion", p.motion);
  v.Child("filter", p.filter);
  v.Child("landmark", p.landmark);
  v.Child("score", p.score);
  v.Child("features", p.features);
  v.Child("target", p.target);
  v.Child("calibration", p.calibration);
}

// Ranges and the rules between several values; empty if valid. Keys are those of `odometry:`.
std::vector<settings::FieldProblem> Problems(Params params);

}  // namespace vo
