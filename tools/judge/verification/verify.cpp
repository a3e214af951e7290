#include "tools/judge/verification/verify.h"

#include "tools/judge/verification/comparisons.h"

namespace verification {

std::vector<Check> Verify(const std::filesystem::path& folder,
                          const std::function<void(std::size_t, std::size_t)>& progress) {
  Check files("files: present, readable, of one size", ""), stamps("stamps: increasing, the same in all lists", "");
  const Sequence sequence = ReadSequence(folder, files, stamps);
  Frames frames(sequence, files);
  std::vector<Check> pictures = PhotometricChecks(), surfaces = SurfaceChecks(sequence), labels = LabelChecks(sequence);
  for (std::size_t frame = 0; frame < frames.count(); ++frame) {
    for (const auto& [stream, list] : sequence.images) {
      if (stream != "boxes") frames.Picture(stream, frame);
    }
    ComparePictures(frames, frame, pictures);
    CompareSurfaces(frames, frame, surfaces);
    CompareLabels(frames, frame, labels);
    if (progress) progress(frame + 1, frames.count());
  }
  std::vector<Check> checks = {files, stamps};
  for (const auto& part : {CheckMotion(sequence), pictures, surfaces, labels}) {
    checks.insert(checks.end(), part.begin(), part.end());
  }
  return checks;
}

}  // namespace verification
