// Evaluation of any filter on a point world: a few lines in a unit test (docs/point_world.md).
// Needs sim and tools/judge/evaluation only.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <vector>

#include "sim/points/point_world.h"
#include "tools/bench/points/truth.h"
#include "tools/judge/evaluation/mixture_scores.h"
#include "tools/judge/evaluation/summary.h"

namespace vobench {

// Estimate of a filter after a frame: conventions as in docs/conventions.md.
struct PointEstimate {
  Eigen::Vector3d p_WC = Eigen::Vector3d::Zero();            // [m]
  Eigen::Quaterniond q_WC = Eigen::Quaterniond::Identity();  // unit
  Eigen::Vector3d v_WC = Eigen::Vector3d::Zero();            // in W [m/s]
  Eigen::Vector3d w_WC_C = Eigen::Vector3d::Zero();          // in C [rad/s]
  // (dp in W, dphi in C, dv in W, dw in C).
  evaluation::Matrix12d covariance = evaluation::Matrix12d::Zero();
};

// A filter's input is that of a detector: stamps and observations, no truth.
using PointFilter = std::function<PointEstimate(std::int64_t stamp_ns, const std::vector<sim::PointObservation>&)>;

using evaluation::BlockNees;

struct PointResult {
  evaluation::Metrics metrics;
  std::vector<BlockNees> nees;  // per frame; nothing is aligned
};

// Runs the filter on the remaining frames of the world. Throws what the filter throws, and std::invalid_argument for an
// estimate that is not finite.
PointResult Judge(sim::PointWorld world, const PointFilter& filter, const evaluation::JudgeOptions& options = {});

// The same, before evaluation.
struct PointPlay {
  std::vector<sim::PointFrame> frames;
  Truth truth;
  evaluation::EstimateRun estimates;  // a pose and a belief for each frame
};
PointPlay Play(sim::PointWorld& world, const PointFilter& filter);

// Errors, sigmas and NEES of each frame; nothing is aligned.
std::vector<evaluation::FrameConsistency> ConsistencyOf(const PointPlay& play);

// NEES of each of `frames`, whose covariances are the run's.
std::vector<BlockNees> NeesByBlock(const evaluation::EstimateRun& run,
                                   const std::vector<evaluation::FrameConsistency>& frames);

}  // namespace vobench
