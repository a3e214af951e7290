// Input of the consistency verdict from a run on a world of points: mixtures at the rank frames, and innovations.
// Source: docs/metrics.md, "Consistency as pass or fail".
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "tools/bench/points/point_bench.h"
#include "tools/judge/evaluation/consistency_verdict.h"
#include "vo/point_odometry.h"

namespace vobench {

// Rank frames, about a second apart, at most ten, the last frame among them. Each has its own histogram of ranks over
// runs: frames of one run are never pooled.
std::vector<std::size_t> RankFrames(std::size_t frames, double rate_hz);

// Data of a run for the verdict: the mixture at the rank frames, the size of the innovations at all frames.
class VerdictRecorder {
 public:
  explicit VerdictRecorder(std::vector<std::size_t> rank_frames) : rank_frames_(std::move(rank_frames)) {}

  // `mixture`: its moments are `estimate`. Every frame, in order.
  void Add(const vo::Estimate& estimate, const std::vector<vo::BeliefComponent>& mixture);

  // errors: truth less estimate, and nees, of all frames. `seed` names the run: ranks are among draws from the mixture.
  // The innovation tested for whiteness is (NIS - dof) / sqrt(2 dof). Throws std::invalid_argument where the numbers of
  // frames differ.
  evaluation::VerdictRun Finish(const std::vector<evaluation::Vector12d>& errors, const std::vector<BlockNees>& nees,
                                std::uint64_t seed) const;

 private:
  struct Frame {
    double nis = 0;
    int nis_dof = 0;
    double effective_components = 1;
    evaluation::Mixture mixture;  // at rank frames only
  };
  std::vector<std::size_t> rank_frames_;
  std::vector<Frame> frames_;
};

// In the tangent space at the estimate, where errors are taken.
evaluation::Mixture MixtureAbout(const vo::Estimate& estimate, const std::vector<vo::BeliefComponent>& mixture);

// Options of the command line; `linearised` are exact filters of the same worlds.
evaluation::VerdictOptions VerdictOptionsFor(std::vector<std::size_t> rank_frames,
                                             std::span<const evaluation::LinearisedRuns> linearised);

}  // namespace vobench
