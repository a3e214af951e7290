// Floating-point images: OpenEXR (skies and truth streams), Radiance HDR, and optical flow (.flo).
#include "sim/world/sky.h"

#include "tests/fuzz/hold.h"
#include "tools/judge/verification/files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile exr("sky.exr"), flow("flow.flo");
  for (fuzz::InputFile* file : {&exr, &flow}) file->Write({data, size});
  fuzz::Hold(exr.path().string(), [] {
    sim::SkyDescription sky;
    sky.file = exr.path();
    sim::LoadSky(sky);
  });
  fuzz::Hold(exr.path().string(), [] { verification::ReadPicture(exr.path()); });
  fuzz::Hold(flow.path().string(), [] { verification::ReadPicture(flow.path()); });
  return 0;
}
