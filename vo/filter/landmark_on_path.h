// Landmark of a solved path window: its Gaussian given the poses, with the anchor's pose, and its image from the last
// pose. Linearised at the mode theta: landmark = theta - D (poses - their means) + N(0, P).
// Of a window that was solved, or extended since (path_end.h).
#pragma once

#include "vo/filter/path_window.h"
#include "vo/map/image_prediction.h"

namespace vo {

// theta and P.
Landmark LandmarkGivenPath(const WindowInput& in, const Track& track, const PathGaussian& path,
                           const Eigen::Vector3d& theta);

// Covariance of the anchor's pose (dp in W, dphi in C; 0 where it has been sampled) and, behind it, the landmark, the
// poses integrated out.
Eigen::Matrix<double, 9, 9> AnchorAndLandmarkCovariance(const WindowInput& in, const Track& track,
                                                        const PathGaussian& path, const Eigen::Vector3d& theta);

// Covariance of the landmark's place in W.
Eigen::Matrix3d PointCovarianceOnPath(const WindowInput& in, const Track& track, const PathGaussian& path,
                                      const Eigen::Vector3d& theta);

// Image from the last pose, poses and landmark integrated out.
ImagePrediction PredictImageOnPath(const WindowInput& in, const Track& track, const PathGaussian& path,
                                   const Eigen::Vector3d& theta);

}  // namespace vo
