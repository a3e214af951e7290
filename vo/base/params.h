// Purpose: every setting of the odometry, with unit, default and what changing it does. Plain values; Validate lists all that is
//          wrong at once. Defaults are the paper's (Section V-A) unless the comment says otherwise.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace vo {

// Nearly constant velocity (6)-(9). Larger: the filter follows violent motion and trusts its prediction less.
struct MotionParams {
  double position_noise = 2.5;     // square root of the power spectral density of acceleration [m/s^1.5]
  double orientation_noise = 1.0;  // the same for angular acceleration [rad/s^1.5]
};

enum class Sampled {
  nothing,            // EKF-SLAM: one Gaussian over everything
  pose,               // RB2-PF: velocity stays Gaussian in each particle
  pose_and_velocity,  // RB-PF (FastSLAM 2.0): velocity is sampled too
};

enum class Proposal {
  bootstrap,  // the motion model, blind to the image; the weight is the likelihood at the sample (FastSLAM 1.0)
  ekf,        // one linearisation at the prediction, landmarks at their prior mean
  ukf,        // unscented transform of the predicted pose, and of each landmark given the pose: the paper
  iterated,   // pose and landmarks re-linearised together until they settle
};

enum class Bearing {
  fixed,      // the paper: a landmark is its inverse depth alone (1-D)
  estimated,  // ray and inverse depth (3-D): the pixel noise of the first view is part of the state
};

enum class Weight {
  importance,  // (17) at the sample: the paper
  evidence,  // p(z_t | path) by Laplace's approximation: the same on a linear-Gaussian model, without the sample's noise
  equal,  // all particles alike, but those that the window's images refute; drawn together, exact in mean and covariance. Needs lag > 0
};

struct FilterParams {
  Sampled sampled = Sampled::pose;
  Proposal proposal = Proposal::iterated;  // the paper: ukf; its first-order twin is ekf
  int particles = 8;
  double resample_below = 0.5;  // resample when N_eff < this fraction of the particles
  int max_iterations = 10;      // of the iterated proposal, and of a landmark given its pose
  // Of ekfslam's update. 1: the textbook EKF; more: Gauss-Newton to the joint mode, which is biased in scale.
  int joint_iterations = 1;
  Weight weight = Weight::evidence;
  int lag = 0;  // poses kept un-sampled, so that later images speak before the map is committed to them (0: the paper)
  // So many poses at the start are one window, found anew in every frame, before any of them is sampled (0: the
  // paper). For pose-sampling filters with proposal ekf or iterated, and weight evidence or equal; others have none.
  int start_window = 30;
  // Propose at the mode of the poses' marginal, not of poses and landmarks jointly: unbiased in scale, but it
  // believes features.sigma_px, which must then be right.
  bool marginal_mode = false;
  bool reject_outliers = true;  // matches that contradict the others are set aside before the update
  // Spread of the sigma points, squared a factor of n + kappa (the paper gives no values: no weight is negative with
  // these). beta: weight of the curvature in the covariance, 2 for a Gaussian.
  double ukf_alpha = 1;
  double ukf_beta = 2;
  double ukf_kappa = 0;
};

struct LandmarkParams {
  Bearing bearing = Bearing::estimated;
  double inverse_depth = 0.25;        // of a new landmark [1/m]
  double inverse_depth_sigma = 0.15;  // [1/m]
  // Of the log of a factor that all lengths share: how well the scale is known beforehand. Part of the answer's
  // covariance [-].
  double scale_sigma = 0;
  double permanent_ratio = 0.05;  // permanent when sigma_rho < ratio * rho (our choice; the paper gives no number)
  int forget_after = 90;          // drop a non-permanent landmark that could not be searched for so many frames
  // Flat memory, of Odometry on images: new ones take the places of the longest unseen, and none begins while all are in view.
  int max_landmarks = 1000;
};

// Existence score (44)-(49).
struct ScoreParams {
  double initial = 0.5;
  double delete_below = 0.4;
  double stay_visible = 0.95;       // P22
  double become_visible = 0.05;     // P12
  double detection = 0.75;          // P_D
  double gate_probability = 0.995;  // P_G
  double gate = 9.21;               // G, on the squared Mahalanobis distance (the paper's pair; 0.995 would be 10.6)
  // Fewer found than this share of those searched: the frame was blind (blur, darkness), and no feature is judged by
  // it; 0 is the paper
  double blind_share = 0.2;
  int grace_frames = 0;  // a landmark younger than this is not deleted for its score (0: the paper)
};

// How the pattern lies when a landmark is looked for again: from the predicted pose, never estimated from the image.
enum class BriskWarp {
  none,        // as in the first view
  similarity,  // turned and scaled
  affine,      // and sheared
};

// Covariance of a match's error.
enum class MatchNoise {
  constant,  // sigma_px for all
  registered,  // of a match that was registered: sigma_floor_px, and what the registration's least squares say, times noise_inflation
  adaptive,  // the same times a factor that each landmark's own residuals tell
};

struct FeatureParams {
  double sigma_px = 0.7;  // standard deviation of a matched pixel, per axis [px] (the paper, to whole pixels: 2)
  MatchNoise noise = MatchNoise::adaptive;
  double sigma_floor_px = 0.2;  // of a match and of a first view [px]
  double noise_inflation = 4;   // the residuals of neighbouring pixels are not independent
  int grid_columns = 8, grid_rows = 6;
  int per_cell = 3;               // corners wanted in every cell of the grid
  int fast_threshold_start = 60;  // grey levels; lowered per cell ...
  int fast_threshold_min = 7;     // ... to this at the least
  double min_distance_px = 10;    // between a new corner and any feature in the image
  double brisk_size_px = 12;  // diameter of BRISK's pattern in OpenCV's terms: larger is more distinct, less invariant
  BriskWarp brisk_warp = BriskWarp::affine;
  double max_hamming = 0.15;  // of 512 bits
  // Looked at first; believed only when the best pixel is not on its border. 1: the paper, without it.
  int window_quick_px = 5;
  int window_px = 9;            // side of the search window about the prediction ...
  int window_enlarged_px = 17;  // ... and when nothing fits there
  // At most, when the prediction itself is uncertain (recovery); where pilots agree, what the prediction from them asks for instead.
  int window_lost_px = 49;
  int window_recovery_px = 241;     // of pilots: after a gap they find back what was there before
  bool subpixel = true;             // refine the match by registering the patch of the first view (our addition)
  double max_view_angle_deg = 45;   // between the present and the first viewing ray
  double max_baseline_ratio = 0.3;  // camera's distance from the first view / depth there
  int max_searched = 200;           // landmarks searched per frame
  std::optional<double> readout_s = std::nullopt;  // rolling shutter, instead of what the camera's file says [s]
  int pilots = 16;  // so many are looked for first; where the others then are, small windows find them (0: the paper)
};

// A chessboard before the camera at the start tells the scale.
struct TargetParams {
  int columns = 0, rows = 0;  // inner corners, where four squares meet; 0: there is none
  double square_m = 0;        // side of a square
  int frames = 30;            // it is looked for until it is found, in no more than so many frames
};

struct Params {
  MotionParams motion;
  FilterParams filter;
  LandmarkParams landmark;
  ScoreParams score;
  FeatureParams features;
  TargetParams target;
};

// Everything wrong with the parameters, one sentence each, with the value; empty when all is well.
std::vector<std::string> Problems(const Params& params);

}  // namespace vo
