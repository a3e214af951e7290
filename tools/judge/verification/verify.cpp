#include "tools/judge/verification/verify.h"

#include "tools/judge/verification/motion.h"
#include "tools/judge/verification/photometric.h"
#include "tools/judge/verification/surfaces.h"

namespace verification {

std::vector<Check> Verify(const std::filesystem::path& folder,
                          const std::function<void(std::size_t, std::size_t)>& progress) {
  Check files("files: present, readable, of one size", ""), stamps("stamps: increasing, the same in all lists", "");
  const Sequence sequence = ReadSequence(folder, files, stamps);
  Frames frames(sequence, files);
  PhotometricChecks pictures(frames);
  SurfaceChecks surfaces(frames);
  for (std::size_t frame = 0; frame < frames.count(); ++frame) {
    for (const auto& [stream, list] : sequence.images) frames.Picture(stream, frame);
    pictures.Frame(frame);
    surfaces.Frame(frame);
    if (progress) progress(frame + 1, frames.count());
  }
  std::vector<Check> checks = {files, stamps};
  for (const auto& part : {CheckMotion(sequence), pictures.checks(), surfaces.checks()}) {
    checks.insert(checks.end(), part.begin(), part.end());
  }
  return checks;
}

}  // namespace verification
