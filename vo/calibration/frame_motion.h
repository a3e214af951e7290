// Motion of the camera during the readout of a frame: Lagrange's polynomial through the poses of the frames about it,
// in the tangent space at the frame's own pose.
// Units:   seconds; tangent (dp in W, dphi in C).
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "vo/geometry/pose.h"

namespace vo {

class FrameMotion {
 public:
  static constexpr int kPoses = 5;  // of the polynomial: three are off by 6 % in velocity at 3 Hz and 30 frames/s
  using Weights = Eigen::Matrix<double, kPoses, 1>;

  // At least kPoses times, ascending.
  explicit FrameMotion(std::vector<double> times);

  // Pose at a time after the stamp of frame k: poses[k] (+) the sum of weight[j] (poses[first + j] (-) poses[k]).
  // `rate`: d weight / dt, which gives the velocity.
  struct Row {
    int first;
    Weights weight, rate;
  };
  Row At(int k, double time) const;
  int First(int k) const;
  // Columns: poses[First(k) + j] (-) poses[k].
  static Eigen::Matrix<double, 6, kPoses> Displacements(std::span<const Pose> poses, int first, int k);

 private:
  std::vector<double> times_;
};

// The times of a camera with a regular clock whose stamps jitter: multiples of the mean period. Unchanged where a step
// is not near a multiple of the median one.
std::vector<double> RegularTimes(std::vector<double> times);

}  // namespace vo
