// The example of docs/point_world.md, as it stands there: a test reads the page.
#include "tests/unit/bench/example_in_docs.h"

// [example]
#include "tools/bench/points/point_bench.h"

// The filter under test. This one measures nothing: it stays at the start, with a standard deviation of 1 m and 1 rad.
struct MyFilter {
  vobench::PointEstimate Track(std::int64_t, const std::vector<sim::PointObservation>&) {
    vobench::PointEstimate estimate;
    estimate.covariance.setIdentity();
    return estimate;
  }
};

TEST(MyFilter, KeepsToTwoMetresInARoomOfPoints) {
  MyFilter filter;
  sim::PointWorld world(VOBENCH_SOURCE_DIR "/scenes/points_room.yaml", /*seed=*/1);
  const auto result = vobench::Judge(world, [&](auto stamp, const auto& seen) { return filter.Track(stamp, seen); });
  EXPECT_LT(result.metrics.errors.none.position.rmse, 2);  // [m]
}
// [example]

namespace vobench {
namespace {

TEST(PointExample, StandsInTheDocsAsItIsCompiled) {
  ExpectInDocs("tests/unit/bench/point_example_test.cpp", "docs/point_world.md");
  ExpectInDocs("tests/system/outside/own_filter_test.cpp", "docs/consistency.md");
}

}  // namespace
}  // namespace vobench
