// Fault injection: after one failed write the program ends with one message that names the file and the reason, or
// succeeds; no partial output has its final name; the same command again gives the bytes of an undisturbed run. A fixed
// subset of the writes; all of them: faults_slow_test.cpp.
#include <gmock/gmock.h>

#include "tests/system/faults/fault_trial.h"

namespace vobench::system_test {
namespace {

// Each command at three places, spread over all, with alternating kinds of faults.
TEST(FaultsTest, AWriteThatFailsAtSomePlaces) {
  const TemporaryFolder inputs;
  MakeFaultInputs(inputs.path());
  constexpr std::size_t kPlaces = 3;
  std::size_t turn = 0, tried = 0;
  for (const FaultCommand& command : FaultCommands()) {
    FaultTrial trial(command, inputs.path());
    const std::size_t calls = trial.calls().size();
    for (std::size_t place = 0; place < kPlaces; ++place) {
      const std::string& kind = FaultKinds()[turn++ % FaultKinds().size()];
      std::size_t number = 1 + (2 * place + 1) * calls / (2 * kPlaces);
      while (number < calls && !trial.CanHave(number, kind)) ++number;
      if (number > calls || !trial.CanHave(number, kind)) continue;
      EXPECT_EQ(trial.Problem(number, kind), "");
      ++tried;
    }
  }
  EXPECT_GE(tried, 25u);
}

// Control: with a wrong command after the failure, the fault is reported.
TEST(FaultsTest, TheFaultsAreReal) {
  const TemporaryFolder inputs;
  MakeFaultInputs(inputs.path());
  FaultCommand command = {.name = "export", .words = {"report", "out"}, .prepare = {"run"}};
  FaultTrial trial(command, inputs.path());
  EXPECT_EQ(trial.Problem(1, "ENOSPC"), "");
  command.again = {"report", "nowhere"};
  FaultTrial careless(command, inputs.path());
  EXPECT_THAT(careless.Problem(1, "ENOSPC"), testing::HasSubstr("the same command again"));
}

}  // namespace
}  // namespace vobench::system_test
