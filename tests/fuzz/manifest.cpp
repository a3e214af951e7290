// manifest.json of a sequence, as read by a resumed rendering and by the verification.
#include "sim/sequence/content.h"
#include "tests/fuzz/hold.h"
#include "tools/judge/verification/check.h"
#include "tools/judge/verification/files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile file("manifest.json");
  static const std::string wanted =
      R"({"layout": "tum", "seed": 1, "frame_range": [0, 5], "frames": 5, "scenario": {"seed": 1}})";
  static const bool once = [] {
    fuzz::WriteBeside("rgb.txt", "1.0 rgb/a.png\n");
    fuzz::WriteBeside("groundtruth.txt", "1.0 0 0 0 0 0 0 1\n");
    fuzz::WriteBeside("camera.yaml", "{width: 8, height: 8, fx: 8, fy: 8, cx: 4, cy: 4}\n");
    return true;
  }();
  static_cast<void>(once);
  file.Write({data, size});
  fuzz::HoldText<std::invalid_argument>([&] {
    sim::ManifestDifferences({reinterpret_cast<const char*>(data), size}, wanted);
  });
  fuzz::Hold(file.path().string(), [] {
    verification::Check files("files", "1"), stamps("stamps", "1");
    verification::ReadSequence(fuzz::Folder(), fuzz::Folder(), files, stamps);
  });
  return 0;
}
