// Relocalisation: the camera's pose from landmarks recognised by their descriptors alone, independent of the
// prediction.
// Source:  P3P and consensus (Fischler & Bolles 1981), by OpenCV's solvePnPRansac; docs/algorithm.md, section 7.2.
// Frames:  points in W, poses T_WC; image points on the plane z = 1.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "vo/base/params.h"
#include "vo/features/brisk.h"
#include "vo/frontend/prepared_frame.h"
#include "vo/geometry/camera.h"
#include "vo/geometry/pose.h"

namespace vo {

struct KnownPoint {
  const Descriptor* descriptor = nullptr;
  Eigen::Vector3d X_W;
};

struct Relocalisation {
  Pose pose;                 // T_WC
  std::vector<int> inliers;  // indices of the points, increasing
};

class Relocaliser {
 public:
  Relocaliser(const Camera& camera, const FeatureParams& params, int border_px);

  // None where fewer than kLeastInliers points agree on a pose: some five of a thousand agree by chance.
  std::optional<Relocalisation> Find(const PreparedFrame& frame, std::span<const KnownPoint> points) const;

  static constexpr std::size_t kLeastInliers = 12;

 private:
  Camera camera_;
  FeatureParams params_;
  int border_px_;
};

}  // namespace vo
