// Fault injection: each write of each command fails once, in each of four ways. VOBENCH_FAULTS_REPORT=FILE appends the
// figures of docs/reliability.md to FILE.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>

#include "tests/system/faults/fault_trial.h"

namespace vobench::system_test {
namespace {

class EveryFaultTest : public testing::TestWithParam<FaultCommand> {};

TEST_P(EveryFaultTest, AtEachPlace) {
  const TemporaryFolder inputs;
  MakeFaultInputs(inputs.path());
  FaultTrial trial(GetParam(), inputs.path());
  std::map<std::string, std::size_t> tried;
  std::size_t bad = 0;
  for (const std::string& kind : FaultKinds()) {
    for (std::size_t number = 1; number <= trial.calls().size(); ++number) {
      if (!trial.CanHave(number, kind)) continue;
      ++tried[kind];
      const std::string problem = trial.Problem(number, kind);
      EXPECT_EQ(problem, "");
      bad += !problem.empty();
    }
  }
  if (const char* report = std::getenv("VOBENCH_FAULTS_REPORT")) {
    std::ofstream(report, std::ios::app) << "| " << GetParam().name << " | " << trial.calls().size() << " | "
                                         << tried["ENOSPC"] << " | " << tried["EIO"] << " | " << tried["EINTR"] << " | "
                                         << tried["short"] << " | " << bad << " |\n";
  }
}

INSTANTIATE_TEST_SUITE_P(Commands, EveryFaultTest, testing::ValuesIn(FaultCommands()),
                         [](const auto& of) { return of.param.name; });

}  // namespace
}  // namespace vobench::system_test
