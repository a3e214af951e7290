// Inner loop of the filter, eight matches at a time: matches linearised with the landmark's Gaussian integrated out,
// their sums for the pose, and the landmarks' update. Private to vo/map: others use MatchBatch.
// Source:  (3). With the pose moved by d: z - h = e - j d + noise of covariance S = J P J' + R, and the
//          landmark's mode is mean + gain (e - j d).
// Units:   the plane z = 1, as in landmark.h.
//
// The loop (match_lanes.inc) is compiled once per instruction set, with its widest vectors. Lanes are independent,
// nothing is contracted, and sums over the eight lanes come last, in a fixed order: all of them give the same bits.
// Those files must not use inline functions of other headers: the linker keeps only one copy of such a function,
// perhaps one with instructions that this machine lacks.
#pragma once

#include <cstdint>

#include "vo/base/instruction_set.h"

namespace vo {

constexpr int kLanes = 8;
struct alignas(64) Lanes {
  double v[kLanes];
};
struct alignas(64) LaneInts {
  std::int64_t v[kLanes];
};

// Squared step on the plane z = 1 (0.005 pixels); what it leaves is of second order in it.
constexpr double kLandmarkSettled = 1e-10;

// Symmetric matrices: upper triangle, row by row.
struct MatchLanes {
  // Given. The first two are replaced by UpdateLandmarks.
  Lanes mean[3], covariance[6];
  Lanes anchor_p[3], anchor_q[4];  // p_WA (less the match's centre offset), q_WA (x y z w)
  Lanes z[2], R_given[3];
  Lanes R[3];       // R_given, inflated by re-weighting
  Lanes min_depth;  // of X_C: what is nearer or behind is not in front; infinite where there is no match

  Lanes R_WA[3][3];  // Prepare
  Lanes theta[3];    // where the landmark is linearised
  // Linearise. 0 where a landmark is not in front.
  Lanes in_front;                   // 1: yes
  Lanes e[2], j[2][6], gain[2][3];  // j: by the pose (dp in W, dphi in C)
};

// Weighted sums over particles: of 1, z, and its second moments (xx xy yy).
struct PredictionLanes {
  Lanes weight, z[2], second[3];
};

struct CameraView {
  double R_CW[3][3];
  double p[3];  // in W
};

// log p(z) = -1/2 (cost + log det S) + constant, over the matches in front.
struct MatchSums {
  double cost = 0;      // sum of e'S^-1 e
  double in_front = 0;  // how many
  Lanes det_mantissa;   // product of det S = product of these times 2 to the exponents
  LaneInts det_exponent;
};
struct PoseSums {
  MatchSums matches;
  double A[21] = {}, b[6] = {};  // information on d
};

// `step`: if not null, theta first goes to the mode for the pose moved by it from where it was linearised.
struct MatchKernel {
  // R_WA; theta = mean.
  void (*prepare)(MatchLanes* blocks, int count);
  // [1]: with gradient and Fisher information of -1/2 log|S| through dz/drho = J_shift (p_A - p): the mode of the
  // pose's marginal, not of pose and landmarks jointly.
  void (*linearise[2])(const CameraView& camera, const double* step, MatchLanes* blocks, int count, PoseSums& sums);
  // Of the residuals with R_given, landmarks linearised at their means; infinite where one is not in front.
  void (*squared_distances)(const CameraView& camera, const MatchLanes* blocks, int count, Lanes* distances);
  // Landmarks given the pose.
  void (*update_landmarks)(const CameraView& camera, const double* step, int max_iterations, MatchLanes* blocks,
                           int count, MatchSums& sums);
  // To each sum, where in front: the landmark's predicted image, its covariance J P J' and that of the pose (6 x 6)
  // with it.
  void (*add_predictions)(const CameraView& camera, const double* covariance, double weight, const MatchLanes* blocks,
                          int count, PredictionLanes* sums);
};
const MatchKernel& MatchKernelOf(InstructionSet set);

namespace match_base {
extern const MatchKernel kKernel;
}
namespace match_avx2 {
extern const MatchKernel kKernel;
}
namespace match_avx512 {
extern const MatchKernel kKernel;
}

}  // namespace vo
