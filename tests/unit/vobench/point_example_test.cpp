// The example of docs/point_world.md, as it stands there: a test reads the page.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

// [example]
#include "tools/vobench/point_bench.h"

// Whatever you want to test. This one has seen nothing and says so: at the start, with a metre and a radian of doubt.
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

namespace {

namespace fs = std::filesystem;

std::string Read(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(PointExample, StandsInTheDocsAsItIsCompiled) {
  const fs::path root = VOBENCH_SOURCE_DIR;
  const std::string source = Read(root / "tests/unit/vobench/point_example_test.cpp"), mark = "// [example]\n";
  const std::size_t from = source.find(mark) + mark.size();
  const std::string example = source.substr(from, source.find(mark, from) - from);
  ASSERT_GT(example.size(), 500u);
  EXPECT_NE(Read(root / "docs/point_world.md").find("```cpp\n" + example + "```\n"), std::string::npos)
      << "docs/point_world.md must have, between ```cpp and ```:\n"
      << example;
}

}  // namespace
