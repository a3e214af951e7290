// Challenge of a solution: a first guess for another mode of the same images, to be solved and compared by its
// objective. Sideways motion and rotation nearly explain each other as long as depths are unknown: several modes fit
// nearly as well (depth reversal), and no later image undoes a wrong choice.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "vo/filter/window.h"

namespace vo {

constexpr std::uint32_t kGuesses = 6;

// By the density at the mode, not by evidence: evidence rewards depths that stay unknown, as if each had a prior of its
// own, and prefers a deep scene with little parallax to a wall.
inline bool IsBetter(const PathGaussian& other, const PathGaussian& path) {
  return other.objective < path.objective || std::isnan(path.objective);
}

// The path with another sideways motion: `guess` 0: none, 1: the opposite, 2 ... 5: along an axis of the first camera.
// Rotated so that points at the mean depth keep their images; landmarks are triangulated from the new path.
PathSolution PerturbTranslation(const Window& window, const LandmarkTable& table, const WindowInput& in,
                                const PathSolution& solution, std::uint32_t guess);

// Modes of the landmarks given the path, by Gauss-Newton from those of the solution: all views of a landmark linearised
// together.
std::vector<Eigen::Vector3d> Triangulate(const Window& window, const LandmarkTable& table, const WindowInput& in,
                                         const PathSolution& solution);

}  // namespace vo
