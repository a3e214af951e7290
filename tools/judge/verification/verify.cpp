#include "tools/judge/verification/verify.h"

#include <cmath>

#include "tools/judge/verification/comparisons.h"

namespace verification {
namespace {

using Progress = std::function<void(std::size_t, std::size_t)>;

// arm_m: of the camera from the body, whose roughness the manifest has.
std::vector<Check> VerifyCamera(const std::filesystem::path& folder, const std::filesystem::path& manifest,
                                double arm_m, const Progress& progress) {
  Check files("files: present, readable, of one size", ""), stamps("stamps: increasing, the same in all lists", "");
  Sequence sequence = ReadSequence(folder, manifest, files, stamps);
  sequence.roughness.position = std::hypot(sequence.roughness.position, arm_m * sequence.roughness.orientation);
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

}  // namespace

std::vector<Check> Verify(const std::filesystem::path& folder, const Progress& progress) {
  const std::vector<RigCamera> rig = ReadRig(folder);
  if (rig.empty()) return VerifyCamera(folder, folder, 0, progress);
  std::vector<Check> all;
  for (std::size_t c = 0; c < rig.size(); ++c) {
    const auto part = [&](std::size_t done, std::size_t count) {
      if (progress) progress(c * count + done, rig.size() * count);
    };
    for (Check& check : VerifyCamera(folder / rig[c].name, folder, rig[c].T_BC.p_WC.norm(), part)) {
      check.Prefix(rig[c].name);
      if (check.count() > 0) all.push_back(std::move(check));
    }
  }
  for (Check& check : CheckRig(folder, rig)) all.push_back(std::move(check));
  return all;
}

}  // namespace verification
