// The example of docs/consistency.md, as it stands there.
#include "tests/unit/vobench/example_in_docs.h"

// [example]
#include "tools/evaluation/anees_test.h"
#include "tools/vobench/point_bench.h"

// A filter that never looks: it knows how the motion is drawn (scenes/points.yaml) and what that leaves open.
struct DeadReckoning {
  vobench::PointEstimate At(double t) const {
    vobench::PointEstimate estimate;  // still at the origin, as far as it knows
    estimate.covariance.setIdentity();
    estimate.covariance.topLeftCorner<3, 3>() *= 0.1 * 0.1 * t * t + 0.5 * 0.5 * t * t * t / 3;
    return estimate;
  }
};

TEST(DeadReckoning, IsAsWrongAsItSays) {
  std::vector<std::vector<double>> nees(100);  // of the position, per run and frame
  for (std::size_t run = 0; run < nees.size(); ++run) {
    const sim::PointWorld world(VOBENCH_SOURCE_DIR "/scenes/points.yaml", /*seed=*/run + 1);
    const auto result = vobench::Judge(world, [](auto t_ns, const auto&) { return DeadReckoning().At(1e-9 * double(t_ns)); });
    for (const vobench::BlockNees& frame : result.nees) nees[run].push_back(frame[0]);
  }
  EXPECT_NEAR(evaluation::ShareInBand(nees, /*dof=*/3).mean, 1, 0.3);  // an honest filter fails once in 4000
}
// [example]

namespace vobench {
namespace {

TEST(ConsistencyExample, StandsInTheDocsAsItIsCompiled) {
  ExpectInDocs("tests/unit/vobench/consistency_example_test.cpp", "docs/consistency.md");
}

// What the example must reject: half the covariance.
TEST(ConsistencyExample, WouldRejectHalfTheCovariance) {
  std::vector<std::vector<double>> nees(100);
  for (std::size_t run = 0; run < nees.size(); ++run) {
    const sim::PointWorld world(VOBENCH_SOURCE_DIR "/scenes/points.yaml", run + 1);
    const auto result = Judge(world, [](auto t_ns, const auto&) {
      PointEstimate estimate = DeadReckoning().At(1e-9 * static_cast<double>(t_ns));
      estimate.covariance /= 2;
      return estimate;
    });
    for (const BlockNees& frame : result.nees) nees[run].push_back(frame[0]);
  }
  EXPECT_GT(evaluation::ShareInBand(nees, 3).mean, 1.3);
}

}  // namespace
}  // namespace vobench
