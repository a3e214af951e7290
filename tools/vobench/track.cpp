#include "tools/bench/systems/systems.h"
#include "tools/vobench/option_table.h"

namespace vobench {

void OptionTable::AddTrack() {
  CLI::App& command =
      AddCommand("track", "Run an odometry on a sequence (TUM RGB-D, EuRoC or ICL-NUIM layout) from disk",
                 "vobench track rgbd_dataset_freiburg1_xyz -o out/xyz --camera freiburg1 --seed 3");
  command.add_option("SEQ", track.sequence, "Sequence folder, video file, camera:0, or the address of a stream")
      ->required();
  command.add_option("-o,--output", track.output, "Result folder to make")->required()->type_name("OUT");
  command.add_option("--system", track.system, "One of " + SystemList())
      ->check(CLI::IsMember(SystemNames()))
      ->type_name("NAME")
      ->capture_default_str();
  command
      .add_option("--camera", track.camera,
                  "freiburg1, freiburg2, freiburg3, icl, or a calibration file (ours, OpenCV, ROS, Kalibr, EuRoC); the "
                  "sequence's own unless told")
      ->type_name("PRESET|FILE");
  command.add_option("--settings", track.settings, "YAML file with an `odometry:` and perhaps a `prior:` section")
      ->type_name("FILE");
  AddView(command, track.view);
  AddMap(command, track.map);
  AddSeed(command, "Seed of the filter")->capture_default_str();
  AddSet(command, "odometry.filter.particles=16");
  command.callback([this] {
    track.seed = seed;
    track.overrides = ParsedOverrides();
    track.command_line = command_line;
    asked = track;
  });
}

}  // namespace vobench
