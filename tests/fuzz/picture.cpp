// Images: textures (with alpha and without), frames of a sequence, truth streams. In half of the runs the chunks of a
// PNG get correct checksums, so that the input reaches the code behind their check.
#include "sim/world/image_file.h"
#include "sim/world/texture.h"
#include "tests/fuzz/hold.h"
#include "tests/fuzz/png_sums.h"
#include "tests/unit/sim/world/texture_sample.h"
#include "tools/judge/verification/files.h"
#include "vo/sequence/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile frame("frame.png");
  static const bool once = [] { return fuzz::WriteBeside("rgb.txt", "1.0 frame.png\n"), true; }();
  static_cast<void>(once);
  std::vector<std::uint8_t> bytes(data, data + size);
  if (size % 2 == 0) fuzz::MendPngSums(bytes);
  frame.Write(bytes);
  bool small = true;  // large pictures are decoded once: their pixels take the time
  for (const bool with_alpha : {false, true}) {
    fuzz::HoldText<std::runtime_error>([&] {
      const sim::DecodedImage image = sim::DecodeImage(bytes, with_alpha);
      small = std::int64_t{image.width} * image.height <= 1 << 16;
      if (small)
        sim::test::Sample(sim::Texture("picture", image.width, image.height, image.rgb, image.alpha), {0.5f, 0.5f}, 2);
    });
    if (!small) return 0;
  }
  fuzz::Hold(frame.path().string(), [] { vo::SequenceReader(fuzz::Folder()).Next(); });
  fuzz::Hold(frame.path().string(), [] { verification::ReadPicture(frame.path()); });
  return 0;
}
