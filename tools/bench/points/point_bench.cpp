#include "tools/bench/points/point_bench.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace vobench {
namespace {

void Record(std::int64_t stamp_ns, const PointEstimate& e, evaluation::EstimateRun& run) {
  const bool finite = e.p_WC.allFinite() && e.q_WC.coeffs().allFinite() && e.v_WC.allFinite() && e.w_WC_C.allFinite() &&
                      e.covariance.allFinite();
  if (!finite || !(std::abs(e.q_WC.norm() - 1) < 1e-6)) {
    throw std::invalid_argument("the estimate at " + std::to_string(stamp_ns) + " ns is not finite or not a rotation");
  }
  run.trajectory.push_back({stamp_ns, e.p_WC, e.q_WC});
  run.beliefs.push_back({{stamp_ns, e.v_WC, e.w_WC_C}, e.covariance});
}

}  // namespace

PointPlay Play(sim::PointWorld& world, const PointFilter& filter) {
  PointPlay play;
  while (std::optional<sim::PointFrame> frame = world.Next()) {
    Append(frame->stamp_ns, frame->truth, play.truth);
    Record(frame->stamp_ns, filter(frame->stamp_ns, frame->observations), play.estimates);
    play.frames.push_back(*std::move(frame));
  }
  return play;
}

PointResult Judge(sim::PointWorld world, const PointFilter& filter, const evaluation::JudgeOptions& options) {
  const auto [frames, truth, run] = Play(world, filter);
  const evaluation::JudgedSeries judged = evaluation::JudgeSeries(run, truth.poses, truth.velocities, options);
  return {judged.metrics, NeesByBlock(run, judged.consistency)};
}

std::vector<evaluation::FrameConsistency> ConsistencyOf(const PointPlay& play) {
  return evaluation::ComputeConsistency(play.estimates, play.truth.poses, play.truth.velocities,
                                        evaluation::AssociationOptions().gap_ns);
}

std::vector<BlockNees> NeesByBlock(const evaluation::EstimateRun& run,
                                   const std::vector<evaluation::FrameConsistency>& frames) {
  std::vector<BlockNees> all;
  std::size_t belief = 0;
  for (const evaluation::FrameConsistency& frame : frames) {
    while (run.beliefs[belief].velocity.stamp_ns < frame.stamp_ns) ++belief;
    const evaluation::Matrix12d& P = run.beliefs[belief].covariance;
    BlockNees nees{};
    for (std::size_t b = 0; b < nees.size(); ++b) {
      const auto [name, start, size] = evaluation::kStateBlocks[b];
      nees[b] = evaluation::Nees(frame.error.segment(start, size), P.block(start, start, size, size));
    }
    all.push_back(nees);
  }
  return all;
}

}  // namespace vobench
