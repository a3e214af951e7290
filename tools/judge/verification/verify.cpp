#include "tools/judge/verification/verify.h"

#include <memory>

#include "tools/judge/verification/comparisons.h"

namespace verification {
namespace {

using Progress = std::function<void(std::size_t, std::size_t)>;

std::vector<Check> VerifyCamera(Part& part, const Progress& progress) {
  const Sequence& sequence = part.sequence;
  Frames& frames = part.frames;
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
  std::vector<Check> checks = {part.files, part.stamps};
  for (const auto& of : {CheckMotion(sequence), pictures, surfaces, labels})
    checks.insert(checks.end(), of.begin(), of.end());
  return checks;
}

}  // namespace

std::vector<Check> Verify(const std::filesystem::path& folder, const Progress& progress) {
  const std::vector<RigCamera> rig = ReadRig(folder);
  if (rig.empty()) return VerifyCamera(*std::make_unique<Part>(folder, folder), progress);
  std::vector<Check> all;
  std::vector<std::unique_ptr<Part>> parts;
  for (std::size_t c = 0; c < rig.size(); ++c) {
    Part& part = *parts.emplace_back(std::make_unique<Part>(folder / rig[c].name, folder, rig[c].T_BC.p_WC.norm()));
    const auto of_all = [&](std::size_t done, std::size_t count) {
      if (progress) progress(c * count + done, rig.size() * count);
    };
    for (Check& check : VerifyCamera(part, of_all)) {
      check.Prefix(rig[c].name);
      if (check.count() > 0) all.push_back(std::move(check));
    }
  }
  for (Check& check : CheckRig(folder, rig, parts)) all.push_back(std::move(check));
  return all;
}

}  // namespace verification
