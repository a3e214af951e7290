// Record of a landmark that all particles share: appearance, existence score, residual history, and the selection of
// the landmarks that the map keeps. The estimate is each particle's own.
// Source:  docs/algorithm.md, section 6: (44)-(49), probabilistic data association with at most one detection. Residual
//          history: conjugate estimate of a variance (inverse gamma), with forgetting. The latter, and the bound on the
//          number of landmarks, are ours.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "vo/base/params.h"
#include "vo/features/matcher.h"

namespace vo {

// Normalised residual of one match.
struct Residual {
  double ratio = 1;   // r'S^-1 R S^-1 r / tr(S^-1 R), S = R + the landmark's: 1 on average where R is right
  double weight = 0;  // tr((S^-1 R)^2) / 2, 0 ... 1: small where the landmark is more uncertain than its measurement

  // r: match less prediction; of the landmark: its own covariance in the image.
  static Residual Of(const Eigen::Vector2d& r, const Eigen::Matrix2d& of_landmark, const Eigen::Matrix2d& R);
};

// Ratio of a landmark's squared residuals to their stated covariance R. Depth edges, gloss and repetitive texture are
// not visible in a single patch; the residuals of several frames show them.
class ResidualHistory {
 public:
  void Add(const Residual& residual);
  // Factor on R, kLeast to kMost: the mean of the ratios and, with the weight of three matches, `level`, the mean of
  // all landmarks.
  double Inflation(double level) const;

  static constexpr double kLeast = 0.1, kMost = 64;

 private:
  double weight_ = 0, sum_ = 0;
};

struct LandmarkRecord {
  int id = 0;
  Appearance appearance;
  // Of the camera in the first view, in its frame [m/s, rad/s].
  Eigen::Vector3d first_v_C = Eigen::Vector3d::Zero(), first_w_C = Eigen::Vector3d::Zero();
  double score = 0;           // existence (44)-(49)
  int age = 0;                // frames since it was first seen
  int frames_unmatched = 0;   // in a row
  double path_length = 0;     // [m] of the camera, until the last match
  int inliers = 0;            // matches that agreed with the robust pose
  int frames_unsearched = 0;  // in a row; a blind frame searches for nothing
  bool searched = false;      // in the last frame, blind or not, or begun in it
  bool permanent = false;
  bool known = false;         // depth certain enough for a pose
  bool lost = false;          // not found since a frame without matches
  ResidualHistory residuals;  // of its matches; used with MatchNoise::adaptive

  // Whether the landmark is a candidate for relocalisation.
  bool unseen() const {
    constexpr int kLong = 5;  // [frames]
    return known && (lost || frames_unmatched >= kLong);
  }
};

// (44): the score before the image is used.
double PredictScore(double score, const ScoreParams& params);

// (45)-(49) for a feature that was searched for. `mahalanobis_sq` = nu' S^-1 nu of its detection (Searched); none = no
// detection. S itself is not needed: V_G * Lambda = G / (2 P_G) exp(-d^2 / 2).
double UpdateScore(double predicted_score, std::optional<double> mahalanobis_sq, const ScoreParams& params);

// Kept are the permanent ones, and those that exist (lost ones: with known depth) and were searched for in the last
// forget_after frames. Beyond max_landmarks, with the `wanted` new ones, some that the last frame did not search for
// are dropped: of those that are not permanent the longest unsearched, of these the oldest (the first in `records`);
// then permanent ones, so that the rest are spread evenly over all landmarks ever begun, and so over the path.
std::vector<bool> LandmarksToKeep(std::span<const LandmarkRecord> records, std::size_t wanted,
                                  const LandmarkParams& landmark, const ScoreParams& score);

}  // namespace vo
