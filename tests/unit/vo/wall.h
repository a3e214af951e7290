// Measurements of a camera that flies sideways past a wall in front of it, without a renderer: for tests that do not
// depend on the images.
// Units: the plane z = 1 of an undistorted camera.
#pragma once

#include <cmath>
#include <vector>

#include "vo/map/landmark.h"

namespace vo_test {

inline Eigen::Vector2d WallRay(int n) { return {0.5 * std::sin(1.3 * n), 0.4 * std::cos(2.1 * n)}; }

inline std::vector<vo::FirstView> WallFirstViews(int count) {
  std::vector<vo::FirstView> views;
  for (int n = 0; n < count; ++n) views.push_back({WallRay(n), 4e-6 * Eigen::Matrix2d::Identity()});
  return views;
}

// Frames from 1 on.
inline std::vector<vo::Match> WallMatches(int count, int frame) {
  std::vector<vo::Match> matches;
  for (int n = 0; n < count; ++n)
    matches.push_back({n,
                       Eigen::Vector2d(0.5 * std::sin(1.3 * n) - 0.002 * frame, 0.4 * std::cos(2.1 * n)) +
                           0.002 * Eigen::Vector2d(std::sin(17.0 * n * frame), std::cos(23.0 * n * frame)),
                       4e-6 * Eigen::Matrix2d::Identity()});
  return matches;
}

}  // namespace vo_test
