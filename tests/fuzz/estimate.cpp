// covariance.txt and frames.csv of a run folder: the same bytes as either.
#include "tests/fuzz/hold.h"
#include "tools/judge/evaluation/estimate_run.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile beliefs("beliefs/covariance.txt"), frames("frames/frames.csv");
  static const bool once = [] {
    for (const char* name : {"beliefs/estimate.txt", "frames/estimate.txt"})
      fuzz::WriteBeside(name, "1 0 0 0 0 0 0 1\n");
    return true;
  }();
  static_cast<void>(once);
  for (fuzz::InputFile* file : {&beliefs, &frames}) {
    file->Write({data, size});
    fuzz::Hold(file->path().string(), [&] { evaluation::ReadEstimateRun(file->path().parent_path()); });
  }
  return 0;
}
