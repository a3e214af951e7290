// scenario.yaml: the settings of the simulator and of the odometry.
#include "sim/scenario/scenario.h"

#include "tests/fuzz/hold.h"
#include "tools/base/settings/settings.h"
#include "tools/bench/systems/experiment.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile file("scenario.yaml");
  file.Write({data, size});
  fuzz::Hold(file.path().string(), [] { sim::LoadScenario(file.path()); });
  fuzz::Hold(file.path().string(), [] {
    settings::Document document = settings::Document::FromFile(file.path());
    settings::Section root = document.root();
    vo::Params params;
    vobench::PriorSettings prior;
    vobench::ReadOdometry(root.Child("odometry"), params);
    vobench::ReadPrior(root.Child("prior"), prior);
    root.IgnoreRest();
    document.ThrowIfBad();
    document.Resolved();
  });
  return 0;
}
