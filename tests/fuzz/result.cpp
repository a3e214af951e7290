// The JSON of a result folder and of a campaign's tasks: metrics.json, run.json, pictures.json, truth/scale.json,
// task.json; the same bytes as each, which their "format" tells apart.
#include "tests/fuzz/hold.h"
#include "tools/bench/campaign/results.h"
#include "tools/bench/report/metrics_json.h"
#include "tools/bench/report/pictures.h"
#include "tools/bench/report/run_json.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile metrics("metrics.json"), run("run.json"), pictures("pictures.json"), scale("truth/scale.json");
  for (fuzz::InputFile* file : {&metrics, &run, &pictures, &scale}) file->Write({data, size});
  fuzz::Hold(metrics.path().string(), [] { report::ReadMetricsJson(fuzz::Folder()); });
  fuzz::Hold(run.path().string(), [] { report::ReadRunJson(fuzz::Folder()); });
  fuzz::Hold(pictures.path().string(), [] { report::ReadPictures(fuzz::Folder()); });
  fuzz::Hold(scale.path().string(), [] { report::ReadTruthScale(fuzz::Folder()); });
  fuzz::HoldText<std::invalid_argument>([&] { campaign::RecordFromJson({reinterpret_cast<const char*>(data), size}); });
  return 0;
}
