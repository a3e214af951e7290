#include "tools/bench/breaking/bench_file.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>

#include "source_dir.h"
#include "tests/temporary_folder.h"
#include "tools/base/files.h"
#include "tools/base/settings/settings.h"

namespace vobench::breaking {
namespace {

using testing::HasSubstr;

BenchFile Read(const std::string& text, const std::string& mode = "quick") {
  const vobench_test::TemporaryFolder folder;
  base::WriteFile(folder / "bench.yaml", text);
  return ReadBenchFile(folder / "bench.yaml", mode);
}

std::string ProblemsOf(const std::string& text) {
  try {
    Read(text);
    return "";
  } catch (const settings::Error& error) {
    return error.what();
  }
}

TEST(BenchFile, DosesAndTheirSettings) {
  const BenchFile bench = Read(
      "base: {scenario: a.yaml, set: {time.rate: 30 Hz}}\nquick: {seeds: 9, set: {time.duration: 2 s}}\nstresses:\n"
      "  - {name: e, unit: ms, mild: 2, severe: 32, scale: log, set: {sensor.exposure: $x ms}}\n"
      "  - {name: c, mild: 0, severe: 4, set: {sensor.covered: [{from: $(1 + x) s, until: $(10 / x) s}], seed: 3}}\n");
  ASSERT_EQ(bench.stresses.size(), 2u);
  EXPECT_EQ(bench.seeds, 9);
  const Stress& exposure = bench.stresses[0];
  const campaign::Changes base = {{"time.rate", "\"30 Hz\""}, {"time.duration", "\"2 s\""}};
  EXPECT_EQ(exposure.base, base);
  EXPECT_DOUBLE_EQ(exposure.At(0), 2);
  EXPECT_DOUBLE_EQ(exposure.At(0.5), 8);
  EXPECT_DOUBLE_EQ(exposure.At(1), 32);
  EXPECT_EQ(exposure.Text(8), "8.00 ms");
  const campaign::Changes at_8 = {{"sensor.exposure", "\"8 ms\""}};
  EXPECT_EQ(exposure.SettingsAt(8), at_8);
  EXPECT_DOUBLE_EQ(bench.stresses[1].At(0.5), 2);
  const auto set = bench.stresses[1].SettingsAt(2);
  EXPECT_THAT(set[0].second, testing::AllOf(HasSubstr("\"3 s\""), HasSubstr("\"5 s\"")));
  EXPECT_EQ(set[1].second, "\"3\"");
}

TEST(BenchFile, AllProblemsAtOnce) {
  const std::string problems = ProblemsOf(
      "stresses:\n  - {name: a, mild: 0, severe: 1, scale: log, set: {sensor.exposure: $x}}\n"
      "  - {name: a, scenario: s.yaml, mild: 1, severe: 1, set: {sensor.exposure: 3}}\n"
      "  - {name: b, scenario: s.yaml, mild: 1, severe: 2, set: {sensor.exposure: $(x ^ 2)}}\nattack: {seeds: 0}\n");
  for (const char* problem : {"must be above 0", "neither 'scenario' here nor 'base.scenario'", "'a' is there twice",
                              "is as mild as", "nothing depends on the dose", "$(x ^ 2)", "seeds"})
    EXPECT_THAT(problems, HasSubstr(problem));
}

TEST(BenchFile, OurOwnHasTheTwelveStresses) {
  for (const char* mode : {"quick", "full"}) {
    const BenchFile bench = ReadBenchFile(std::filesystem::path(VOBENCH_SOURCE_DIR) / "scenes/bench.yaml", mode);
    EXPECT_EQ(bench.stresses.size(), 12u);
    EXPECT_GE(bench.seeds, 8);
    EXPECT_EQ(bench.attack.size(), 8u);
  }
}

}  // namespace
}  // namespace vobench::breaking
