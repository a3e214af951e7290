// JSON of a result folder and of a campaign's tasks: metrics.json, run.json, pictures.json, truth/scale.json,
// task.json. The same bytes as each; their "format" distinguishes them.
#include "tests/fuzz/hold.h"
#include "tools/bench/campaign/results.h"
#include "tools/bench/result/metrics_json.h"
#include "tools/bench/result/pictures.h"
#include "tools/bench/result/run_json.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile metrics("metrics.json"), run("run.json"), pictures("pictures.json"), scale("truth/scale.json");
  for (fuzz::InputFile* file : {&metrics, &run, &pictures, &scale}) file->Write({data, size});
  fuzz::Hold(metrics.path().string(), [] { vobench::ReadMetricsJson(fuzz::Folder()); });
  fuzz::Hold(run.path().string(), [] { vobench::ReadRunJson(fuzz::Folder()); });
  fuzz::Hold(pictures.path().string(), [] { vobench::ReadPictures(fuzz::Folder()); });
  fuzz::Hold(scale.path().string(), [] { vobench::ReadTruthScale(fuzz::Folder()); });
  fuzz::HoldText<std::invalid_argument>([&] {
    vobench::campaign::RecordFromJson({reinterpret_cast<const char*>(data), size});
  });
  return 0;
}
