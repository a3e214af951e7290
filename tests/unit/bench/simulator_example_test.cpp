// The example of docs/your_odometry.md, as it stands there.
#include "tests/unit/bench/example_in_docs.h"

// [example]
#include "sim/scenario/scenario.h"
#include "sim/simulator.h"
#include "tools/judge/evaluation/summary.h"

// Whatever you want to test. This one answers the identity pose.
struct MyOdometry {
  evaluation::StampedPose Track(std::int64_t stamp_ns, const sim::Image&) { return {.stamp_ns = stamp_ns}; }
};

TEST(MyOdometry, MovesLessThanTheCamera) {
  sim::Simulator simulator(sim::LoadScenario(VOBENCH_SOURCE_DIR "/scenes/tiny.yaml", {{"time.duration", "0.3 s"}}), 2);
  MyOdometry mine;
  evaluation::EstimateRun run;
  evaluation::Trajectory truth;
  while (const auto frame = simulator.Next()) {
    run.trajectory.push_back(mine.Track(frame->stamp_ns, frame->image));
    const auto [p, q] = std::pair(frame->truth.p_WC, frame->truth.q_WC);
    truth.push_back({frame->stamp_ns, {p.x, p.y, p.z}, {q.w, q.x, q.y, q.z}});
  }
  const evaluation::Metrics metrics = evaluation::Judge(run, truth, std::nullopt);
  EXPECT_LT(metrics.errors.first.position.max, metrics.path_length_m);
}
// [example]

namespace vobench {
namespace {

TEST(SimulatorExample, StandsInTheDocsAsItIsCompiled) {
  ExpectInDocs("tests/unit/bench/simulator_example_test.cpp", "docs/your_odometry.md");
}

}  // namespace
}  // namespace vobench
