#include <sstream>

#include "tools/vobench/option_table.h"

namespace vobench {
namespace {

// "A:B": the frames A, A+1, ..., B-1
std::pair<std::int64_t, std::int64_t> ParseFrames(const std::string& text) {
  std::istringstream stream(text);
  std::int64_t first = 0, last = 0;
  char colon = 0, rest = 0;
  if (!(stream >> first >> colon >> last) || colon != ':' || stream >> rest || first < 0 || last <= first) {
    throw CLI::ValidationError("--frames", "'" + text + "' is not A:B with 0 <= A < B (frames A to B-1)");
  }
  return {first, last};
}

}  // namespace

void OptionTable::AddRender() {
  CLI::App& command = AddCommand("render", "Render a scenario into a sequence: images with exact truth",
                                 "vobench render scenes/room.yaml -o room --frames 0:30 --set sensor.exposure='5 ms'");
  command.add_option("SCENARIO", render.scenario, "Scenario file (scenes/*.yaml)")->required();
  command.add_option("-o,--output", render.output, "Sequence folder to make")->required()->type_name("SEQ");
  command.add_option("--frames", frames, "Only the frames A to B-1; each is the same as in the whole")
      ->type_name("A:B");
  command.add_option("--format", render.format, "Layout: tum (TUM RGB-D), euroc (EuRoC, ASL) or icl (ICL-NUIM)")
      ->check(CLI::IsMember({"tum", "euroc", "icl"}))
      ->type_name("NAME")
      ->capture_default_str();
  command.add_flag("--resume", render.resume,
                   "Go on with SEQ.partial, which an interrupted run left; the bytes are those of one run");
  command.add_flag("--preview", render.preview, "Also preview.mp4 and contact.jpg, for the eye");
  command
      .add_option("--truth", render.truth,
                  "Truth beside poses and velocities, separated by commas: depth, depth_exr, depth_kinect, distance, "
                  "normals, flow, flow_backward, occlusion, surface_id, landmarks, acceleration, imu, moving "
                  "(docs/truth.md)")
      ->type_name("NAME,...");
  AddSeed(command, "Seed instead of the scenario's");
  AddEngine(command);
  AddJobs(command, "Threads; the results do not depend on it");
  AddSet(command, "camera.width=320");
  command.callback([this, &command] {
    if (!frames.empty()) render.frames = ParseFrames(frames);
    if (command.count("--seed") > 0) render.seed = seed;
    render.jobs = jobs;
    render.overrides = ParsedOverrides();
    asked = render;
  });
}

}  // namespace vobench
