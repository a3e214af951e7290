// First guesses of a window's solution in other modes.
// Source:  docs/algorithm.md, section 9.2.
#pragma once

#include <cstdint>
#include <optional>

#include "vo/filter/window.h"

namespace vo {

// First guesses for other modes of the same images (multi-start): each is solved and compared by its objective.
// Sideways motion and rotation nearly explain each other as long as depths are unknown: several modes fit nearly as
// well (depth reversal), and no later image undoes a wrong choice.
constexpr std::uint32_t kPerturbations = 6;
constexpr std::uint32_t kGuesses = kPerturbations + 1;

// The path with another sideways motion: `guess` 0: none, 1: the opposite, 2 ... 5: along an axis of the first camera.
// Rotated so that points at the mean depth keep their images; landmarks are triangulated from the new path.
PathSolution PerturbTranslation(const Window& window, const LandmarkTable& table, const WindowInput& in,
                                const PathSolution& solution, std::uint32_t guess);

// The path that ends at the relative pose of the last frame and the earliest one with enough landmarks in common, from
// their images alone; as long as the solution's, at constant velocity in between. None where no frame has as many.
std::optional<PathSolution> EpipolarPath(const Window& window, const LandmarkTable& table, const WindowInput& in,
                                         const PathSolution& solution);

// Number `guess` of kGuesses: the perturbations, then the epipolar path.
inline std::optional<PathSolution> FirstGuess(const Window& window, const LandmarkTable& table, const WindowInput& in,
                                              const PathSolution& solution, std::uint32_t guess) {
  if (guess < kPerturbations) return PerturbTranslation(window, table, in, solution, guess);
  return EpipolarPath(window, table, in, solution);
}

}  // namespace vo
