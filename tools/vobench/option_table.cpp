#include "tools/vobench/option_table.h"

#include <algorithm>
#include <memory>
#include <thread>

#include "tools/bench/systems/systems.h"
#include "tools/vobench/help_text.h"

namespace vobench {
namespace {

// A check that leaves the argument's name in the help as it is.
CLI::Validator Plain(const CLI::Validator& check) { return check.description(""); }

CLI::App& AddCommand(CLI::App& app, const std::string& name, const std::string& help, const std::string& example) {
  CLI::App& command = *app.add_subcommand(name, help);
  command.footer("Example: " + example);
  return command;
}

void AddSet(CLI::App& command, OptionTable& table, const std::string& example) {
  command.add_option("--set", table.set, "Change one setting, such as " + example + "; `vobench settings` lists them")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void AddView(CLI::App& command, bool& view) {
  command.add_flag("--view", view, "The report in a browser while it runs; its address is printed");
}

void AddMap(CLI::App& command, std::optional<std::filesystem::path>& map) {
  command.add_option("--map", map, "Also the landmarks with their covariance: docs/result_folder.md")
      ->type_name("FILE.ply");
}

void AddJobs(CLI::App& command, OptionTable& table, const std::string& help) {
  command.add_option("-j,--jobs", table.jobs, help)
      ->check(Plain(CLI::Range(1, 1024)))
      ->type_name("N")
      ->default_str("all cores");
}

void AddEngine(CLI::App& command, OptionTable& table) {
  command.add_option("--engine", table.engine, "What renders, ray_tracer or rasteriser: docs/renderers.md")
      ->check(CLI::IsMember({"ray_tracer", "rasteriser"}))
      ->type_name("NAME");
}

CLI::Option* AddSeed(CLI::App& command, OptionTable& table, const std::string& help) {
  return command.add_option("--seed", table.seed, help)->check(Plain(CLI::NonNegativeNumber))->type_name("N");
}

}  // namespace

OptionTable::OptionTable()
    : app("vobench: synthetic data for visual odometry, and the bench that tests it", "vobench"),
      jobs(static_cast<int>(std::max(1U, std::thread::hardware_concurrency()))) {
  app.formatter(std::make_shared<HelpText>());
  app.set_help_flag("-h,--help", "What you are reading, and no more");
  app.set_version_flag("--version", "vobench " VOBENCH_VERSION, "Which vobench this is");
  app.require_subcommand(1);
  app.footer(
      "`vobench COMMAND --help` tells more. Exit status: 0 done, 1 the work failed or `verify` found a disagreement, "
      "2 bad usage or input, 3 not consistent though `run --require-consistent` asked for it.");
  AddRender();
  AddTrack();
  AddEvaluate();
  AddRun();
  AddCampaign();
  AddOthers();
}

void OptionTable::AddRender() {
  CLI::App& command = AddCommand(app, "render", "Render a scenario into a sequence: images with exact truth",
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
  AddSeed(command, *this, "Seed instead of the scenario's");
  AddEngine(command, *this);
  AddJobs(command, *this, "Threads; the results do not depend on it");
  AddSet(command, *this, "camera.width=320");
}

void OptionTable::AddTrack() {
  CLI::App& command =
      AddCommand(app, "track", "Run an odometry on a sequence (TUM RGB-D, EuRoC or ICL-NUIM layout) from disk",
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
  AddSeed(command, *this, "Seed of the filter")->capture_default_str();
  AddSet(command, *this, "odometry.filter.particles=16");
}

void OptionTable::AddEvaluate() {
  CLI::App& command = AddCommand(app, "evaluate", "Hold an estimated trajectory against the truth",
                                 "vobench evaluate out/xyz/estimate.txt --truth room --align sim3");
  command.add_option("ESTIMATE", evaluate.estimate, "Trajectory in TUM format, or a run folder")->required();
  command.add_option("--truth", evaluate.truth, "Trajectory in TUM format, or a sequence folder")
      ->required()
      ->type_name("SEQ|FILE");
  CLI::Option* align =
      command
          .add_option("--align", evaluate.align, "What the estimate may be moved by before: none, se3, sim3 or first")
          ->check(CLI::IsMember({"none", "se3", "sim3", "first"}))
          ->type_name("NAME")
          ->capture_default_str();
  command
      .add_option("--compat", evaluate.compat,
                  "Print what another tool prints: tum, evo, rpg or ov, and its own options in the same quotes, such "
                  "as 'evo ape -as': docs/metrics.md")
      ->type_name("TOOL")
      ->excludes(align);
}

void OptionTable::AddRun() {
  CLI::App& command =
      AddCommand(app, "run", "Render a scenario, track it and judge the result, in memory, frame by frame",
                 "vobench run scenes/room.yaml -o out/room --system rb2pf,rbpf --runs 5");
  command.add_option("SCENARIO", run.scenario, "Scenario file (scenes/*.yaml)")->required();
  command.add_option("-o,--output", run.output, "Result folder to make; without it only the table is printed")
      ->type_name("OUT");
  command.add_option("--system", run.systems, "Systems to compare, separated by commas, of " + SystemList())
      ->delimiter(',')
      ->check(CLI::IsMember(SystemNames()))
      ->allow_extra_args(false)
      ->type_name("NAME,...")
      ->capture_default_str();
  command.add_option("--runs", run.runs, "Runs of each system, each with its own seed")
      ->check(Plain(CLI::Range(1, 10000)))
      ->type_name("N")
      ->capture_default_str();
  AddSeed(command, *this,
          "Seed of the first run's filter and prior, and of its world of points; a scene keeps its own (--set seed=N)")
      ->capture_default_str();
  command.add_flag("--bound", run.bound,
                   "Also the Cramer-Rao bound of worlds of points, and RMSE / bound; takes seconds a run");
  command.add_flag("--verdict", run.verdict,
                   "Also whether each system is consistent with its own model, check by check, in worlds of points "
                   "from a prior; 10 runs or more");
  command.add_flag("--require-consistent", run.require_consistent,
                   "As --verdict, and exit status 3 where a system is not");
  AddView(command, run.view);
  AddMap(command, run.map);
  AddEngine(command, *this);
  AddJobs(command, *this, "Threads; the results do not depend on it");
  AddSet(command, *this, "odometry.filter.particles=16");
}

void OptionTable::AddCampaign() {
  CLI::App& command =
      AddCommand(app, "campaign", "Scenarios x varied settings x systems x seeds, on this machine or a cluster",
                 "vobench campaign scenes/campaign_points.yaml -o out/points --jobs 2");
  command.add_option("FILE", campaign.file, "Campaign file (docs/campaign.md)")->required();
  command.add_option("-o,--output", campaign.output, "Folder of its results; what is done there is not done again")
      ->required()
      ->type_name("OUT");
  command.add_flag("--dry-run", campaign.dry_run, "Check everything and list the tasks, no more");
  CLI::Option* where = command.add_option("--engine", campaign.engine, "Where tasks run: local or slurm")
                           ->check(CLI::IsMember({"local", "slurm"}))
                           ->type_name("NAME")
                           ->capture_default_str();
  AddJobs(command, *this, "Processes at a time, with --engine local");
  command
      .add_option("--memory", campaign.memory_bytes,
                  "Of each process, such as 2GB (default: an equal part of what is left)")
      ->transform(Plain(CLI::AsSizeValue(false)))
      ->type_name("SIZE");
  command.add_option("--timeout", campaign.timeout_s, "Seconds that a task may take (default: as long as it likes)")
      ->check(Plain(CLI::PositiveNumber))
      ->type_name("S");
  command.add_option("--cache", campaign.cache, "Where rendered sequences are kept (default: OUT/cache)")
      ->type_name("DIR");
  command.add_flag("--update", campaign.update,
                   "Results that the file as it is now would not give may go; else an error");
  CLI::Option* task =
      command.add_option("--task", campaign.task, "Run this one task again, and say whether it comes out the same")
          ->check(Plain(CLI::NonNegativeNumber))
          ->type_name("K")
          ->excludes(where);
  CLI::Option* list =
      command.add_option("--list", campaign.list, "Run the tasks in line --part of this file, as job arrays do")
          ->type_name("FILE")
          ->excludes(task)
          ->excludes(where);
  command.add_option("--part", campaign.part, "A line of --list; the first is 0")
      ->check(Plain(CLI::NonNegativeNumber))
      ->type_name("N")
      ->needs(list);
  command.add_option("--partition", campaign.partition, "Of Slurm")->type_name("NAME");
  command.add_option("--time", campaign.time, "Of one job of Slurm, such as 2:00:00")->type_name("TIME");
  command.add_option("--tasks-per-job", campaign.tasks_per_job, "Of Slurm: tasks that one element of the array does")
      ->check(Plain(CLI::Range(1, 1000000)))
      ->type_name("N")
      ->capture_default_str();
}

void OptionTable::AddOthers() {
  CLI::App& check_command = AddCommand(app, "check", "Read a scenario and all it names, and say what is wrong with it",
                                       "vobench check scenes/room.yaml");
  check_command.add_option("SCENARIO", check.scenario, "Scenario file (scenes/*.yaml)")->required();
  AddSet(check_command, *this, "camera.width=320");

  CLI::App& settings_command = AddCommand(app, "settings", "List all settings: key, default, range, meaning",
                                          "vobench settings odometry.filter");
  settings_command.add_option("PREFIX", settings.prefix, "Only keys that begin so")->type_name("KEY");
  settings_command.add_flag("--markdown", settings.markdown, "As the tables of docs/settings.md");

  CLI::App& verify_command =
      AddCommand(app, "verify", "Hold the streams of a sequence against each other: poses, depth, flow, IMU, pictures",
                 "vobench verify room");
  verify_command.add_option("SEQ", verify.sequence, "Sequence folder")->required();

  CLI::App& export_command =
      AddCommand(app, "export", "Write a sequence in another form: a ROS 1 bag (docs/sequence_format.md)",
                 "vobench export room --bag room.bag");
  export_command.add_option("SEQ", exported.sequence, "Sequence folder")->required();
  export_command.add_option("--bag", exported.bag, "ROS 1 bag to make")->required()->type_name("FILE.bag");

  CLI::App& report_command =
      AddCommand(app, "report", "Make report.html anew from a result folder", "vobench report out/room");
  report_command.add_option("OUT", report.output, "Result folder")->required();
}

}  // namespace vobench
