#include "sim/sequence/content.h"

#include <stdexcept>

#include "sim/sequence/format.h"
#include "sim/sequence/manifest.h"
#include "sim/sequence/streams.h"

namespace sim {

void Validate(const SequenceContent& content, const Simulator& simulator) {
  if (content.first < 0 || content.last <= content.first || content.last > simulator.frame_count()) {
    throw std::invalid_argument("frames " + std::to_string(content.first) + ":" + std::to_string(content.last) +
                                " are not a range within 0:" + std::to_string(simulator.frame_count()));
  }
  const std::vector<std::string> problems = Problems(content.layout, simulator.scenario());
  std::string all;
  for (const std::string& problem : problems) all += (all.empty() ? "" : "\n") + problem;
  if (!all.empty()) throw std::invalid_argument(all);
}

std::vector<StreamFile> FrameFiles(const Simulator& simulator, const SequenceContent& content, std::int64_t index) {
  const Frame frame = simulator.Render(index);
  const FrameNames names = NamesOf(content.layout, index, frame.stamp_ns);
  std::vector<StreamFile> files;
  files.push_back({names.image, EncodePng(frame.image)});
  if (content.layout == Layout::tum) {
    for (StreamFile& file : FrameStreams(simulator, index, simulator.scenario().truth.streams)) {
      files.push_back(std::move(file));
    }
  } else {
    files.push_back({names.depth, EncodeDepthPng(simulator.Depth(index), frame.image.width, frame.image.height)});
  }
  return files;
}

std::vector<StreamFile> WholeFiles(const Simulator& simulator, const SequenceContent& content, std::int64_t whole) {
  std::vector<StampedTruth> frames;
  for (std::int64_t index = content.first; index < content.first + whole; ++index) {
    frames.push_back({index, simulator.StampNs(index), simulator.TruthAt(index)});
  }
  std::vector<StreamFile> files = Lists(content.layout, simulator.scenario(), frames);
  if (content.layout == Layout::tum) {
    for (StreamFile& file : SequenceStreams(simulator, content.first, content.first + whole,
                                            simulator.scenario().truth.streams)) {
      files.push_back(std::move(file));
    }
  }
  if (content.layout == Layout::tum && simulator.scenario().sensor.auto_exposure.on) {
    std::string lines = "# timestamp exposure gain\n";
    for (const StampedTruth& frame : frames) lines += ExposureLine(frame.stamp_ns, simulator.SettingOf(frame.index));
    files.push_back(TextFile("exposure.txt", lines));
  }
  files.push_back(TextFile("camera.yaml", CameraYaml(simulator.camera().params())));
  files.push_back(TextFile(kManifestName, Manifest(simulator, content, whole)));
  return files;
}

}  // namespace sim
