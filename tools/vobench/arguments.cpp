#include "tools/vobench/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <set>
#include <sstream>
#include <thread>

#include "tools/vobench/systems.h"

namespace vobench {
namespace {

int DefaultJobs() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

// "key=value"
std::pair<std::string, std::string> ParseOverride(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos) {
    throw CLI::ValidationError("--set", "'" + text + "' is not key=value");
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

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

// As it could be typed again.
std::string CommandLine(int argc, char** argv) {
  std::string line = "vobench";
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool plain = !argument.empty() && argument.find_first_of(" \t\n'\"\\$`*?;&|<>(){}[]~#!") == std::string::npos;
    std::string quoted;
    for (const char c : argument) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += " " + (plain ? argument : "'" + quoted + "'");
  }
  return line;
}

// What the options are first read into, as text, where CLI11 does not know their type.
struct Raw {
  std::vector<std::string> set;
  std::string frames;
  std::uint64_t seed = 1;
  int jobs = DefaultJobs();
  std::string engine;

  Overrides overrides() const {
    Overrides all;
    if (!engine.empty()) all.emplace_back("render.engine", engine);
    for (const std::string& text : set) all.push_back(ParseOverride(text));
    return all;
  }
};

void AddSet(CLI::App& command, Raw& raw, const std::string& example) {
  command.add_option("--set", raw.set, "Change one setting, such as " + example + " (may be given again)")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void AddJobs(CLI::App& command, Raw& raw) {
  command.add_option("--jobs,-j", raw.jobs, "Threads; the results do not depend on it")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
}

void AddEngine(CLI::App& command, Raw& raw) {
  command.add_option("--engine", raw.engine, "What renders (render.engine; docs/renderers.md)")
      ->check(CLI::IsMember({"ray_tracer", "rasteriser"}))
      ->type_name("NAME");
}

CLI::Option* AddSeed(CLI::App& command, Raw& raw, const std::string& help) {
  return command.add_option("--seed", raw.seed, help)->check(CLI::NonNegativeNumber)->type_name("N");
}

CLI::App& AddCommand(CLI::App& app, const std::string& name, const std::string& help, const std::string& example) {
  CLI::App& command = *app.add_subcommand(name, help);
  command.footer("Example:\n  " + example);
  return command;
}

void AddCampaign(CLI::App& command, Raw& raw, CampaignOptions& campaign) {
  command.add_option("FILE", campaign.file, "Campaign file (docs/campaign.md)")->required();
  command.add_option("-o,--output", campaign.output, "Folder of its results; what is done there is not done again")
      ->required()
      ->type_name("OUT");
  command.add_flag("--dry-run", campaign.dry_run, "Check everything and list the tasks, no more");
  CLI::Option* engine = command.add_option("--engine", campaign.engine, "Where tasks run: local or slurm")
                            ->check(CLI::IsMember({"local", "slurm"}))
                            ->capture_default_str();
  command.add_option("--jobs,-j", raw.jobs, "Processes at a time, with --engine local")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command.add_option("--memory", campaign.memory_bytes,
                     "Of each process, such as 2GB; no more run than fit (default: an equal part of what is left)")
      ->transform(CLI::AsSizeValue(false))
      ->type_name("SIZE");
  command.add_option("--timeout", campaign.timeout_s, "Seconds that a task may take (default: as long as it likes)")
      ->check(CLI::PositiveNumber)
      ->type_name("S");
  command.add_option("--cache", campaign.cache, "Where rendered sequences are kept (default: OUT/cache)")->type_name("DIR");
  command.add_flag("--update", campaign.update,
                   "Results that the file as it is now would not give may go; without it they are an error");
  CLI::Option* task = command.add_option("--task", campaign.task, "Run this one task again, and say whether it comes out the same")
                          ->check(CLI::NonNegativeNumber)
                          ->type_name("K")
                          ->excludes(engine);
  CLI::Option* list = command.add_option("--list", campaign.list, "Run the tasks in line --part of this file, as job arrays do")
                          ->type_name("FILE")
                          ->excludes(task)
                          ->excludes(engine);
  command.add_option("--part", campaign.part, "A line of --list; the first is 0")->check(CLI::NonNegativeNumber)->needs(list);
  command.add_option("--partition", campaign.partition, "Of Slurm")->type_name("NAME");
  command.add_option("--time", campaign.time, "Of one job of Slurm, such as 2:00:00")->type_name("TIME");
  command.add_option("--tasks-per-job", campaign.tasks_per_job, "Of Slurm: tasks that one element of the array does")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
}

}  // namespace

std::variant<Command, int> ParseArguments(int argc, char** argv) {
  CLI::App app("vobench: synthetic data for visual odometry, and the bench that tests it.", "vobench");
  app.set_version_flag("--version", "vobench " VOBENCH_VERSION);
  app.require_subcommand(1);
  app.footer(
      "`vobench COMMAND --help` tells more. Exit status: 0 done, 1 the work failed or `verify` found a disagreement, 2 "
      "bad usage or input, 3 not "
      "consistent\nthough `run --require-consistent` asked for it.");
  Raw raw;

  RenderOptions render;
  CLI::App& render_command =
      AddCommand(app, "render", "Render a scenario into a sequence: images with exact truth",
                 "vobench render scenes/room.yaml -o room --frames 0:30 --set sensor.exposure='5 ms'");
  render_command.add_option("SCENARIO", render.scenario, "Scenario file (scenes/*.yaml)")->required();
  render_command.add_option("-o,--output", render.output, "Sequence folder to make")->required()->type_name("SEQ");
  render_command.add_option("--frames", raw.frames, "Only the frames A to B-1; each is the same as in the whole")
      ->type_name("A:B");
  render_command.add_option("--format", render.format, "Layout: tum (TUM RGB-D), euroc (EuRoC, ASL) or icl (ICL-NUIM)")
      ->check(CLI::IsMember({"tum", "euroc", "icl"}))
      ->capture_default_str();
  render_command.add_flag("--resume", render.resume,
                          "Go on with SEQ.partial, which an interrupted run left; the bytes are those of one run");
  render_command.add_flag("--preview", render.preview, "Also preview.mp4 and contact.jpg, for the eye");
  render_command
      .add_option("--truth", render.truth,
                  "Truth beside poses and velocities, separated by commas: depth, depth_exr, depth_kinect, distance, "
                  "normals, flow, "
                  "flow_backward, occlusion, surface_id, landmarks, acceleration, imu (docs/truth.md)")
      ->type_name("NAME,...");
  const CLI::Option* render_seed = AddSeed(render_command, raw, "Seed instead of the scenario's");
  AddEngine(render_command, raw);
  AddJobs(render_command, raw);
  AddSet(render_command, raw, "camera.width=320");

  TrackOptions track;
  CLI::App& track_command =
      AddCommand(app, "track", "Run an odometry on a sequence (TUM RGB-D, EuRoC or ICL-NUIM layout) from disk",
                 "vobench track rgbd_dataset_freiburg1_xyz -o out/xyz --camera freiburg1 --seed 3");
  track_command.add_option("SEQ", track.sequence, "Sequence folder")->required();
  track_command.add_option("-o,--output", track.output, "Result folder to make")->required()->type_name("OUT");
  track_command.add_option("--system", track.system, "One of " + SystemList())
      ->check(CLI::IsMember(SystemNames()))
      ->capture_default_str();
  track_command
      .add_option("--camera", track.camera,
                  "freiburg1, freiburg2, freiburg3, icl or a camera.yaml; the sequence's own unless told")
      ->type_name("PRESET|FILE");
  track_command
      .add_option("--settings", track.settings, "YAML file with an `odometry:` and perhaps a `prior:` section")
      ->type_name("FILE");
  AddSeed(track_command, raw, "Seed of the filter")->capture_default_str();
  AddSet(track_command, raw, "odometry.filter.particles=16");

  EvaluateOptions evaluate;
  CLI::App& evaluate_command = AddCommand(app, "evaluate", "Hold an estimated trajectory against the truth",
                                          "vobench evaluate out/xyz/estimate.txt --truth room --align sim3");
  evaluate_command.add_option("ESTIMATE", evaluate.estimate, "Trajectory in TUM format, or a run folder")->required();
  evaluate_command.add_option("--truth", evaluate.truth, "Trajectory in TUM format, or a sequence folder")
      ->required()
      ->type_name("SEQ|FILE");
  evaluate_command.add_option("--align", evaluate.align, "What the estimate may be moved by first")
      ->check(CLI::IsMember({"none", "se3", "sim3", "first"}))
      ->capture_default_str();

  RunOptions run;
  CLI::App& run_command =
      AddCommand(app, "run", "Render a scenario, track it and judge the result, in memory, frame by frame",
                 "vobench run scenes/room.yaml -o out/room --system rb2pf,rbpf --runs 5");
  run_command.add_option("SCENARIO", run.scenario, "Scenario file (scenes/*.yaml)")->required();
  run_command.add_option("-o,--output", run.output, "Result folder to make; without it only the table is printed")
      ->type_name("OUT");
  run_command.add_option("--system", run.systems, "Systems to compare, separated by commas, of " + SystemList())
      ->delimiter(',')
      ->check(CLI::IsMember(SystemNames()))
      ->allow_extra_args(false)
      ->type_name("NAME,...")
      ->capture_default_str();
  run_command.add_option("--runs", run.runs, "Runs of each system, each with its own seed")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  AddSeed(run_command, raw,
          "Seed of the first run's filter and prior, and of its world of points; a scene keeps its own (--set seed=N)")
      ->capture_default_str();
  run_command.add_flag("--bound", run.bound,
                       "Also the Cramer-Rao bound of worlds of points, and RMSE / bound; takes seconds a run");
  run_command.add_flag("--verdict", run.verdict,
                       "Also whether each system is consistent with its own model, check by check, in worlds of points "
                       "from a prior; 10 runs or more");
  run_command.add_flag("--require-consistent", run.require_consistent,
                       "As --verdict, and exit status 3 where a system is not");
  AddEngine(run_command, raw);
  AddJobs(run_command, raw);
  AddSet(run_command, raw, "odometry.filter.particles=16 or time.duration='2 s'");

  CheckOptions check;
  CLI::App& check_command = AddCommand(app, "check", "Read a scenario and all it names, and say what is wrong with it",
                                       "vobench check scenes/room.yaml");
  check_command.add_option("SCENARIO", check.scenario, "Scenario file (scenes/*.yaml)")->required();
  AddSet(check_command, raw, "camera.width=320");

  VerifyOptions verify;
  CLI::App& verify_command =
      AddCommand(app, "verify", "Hold the streams of a sequence against each other: poses, depth, flow, IMU, pictures",
                 "vobench verify room");
  verify_command.add_option("SEQ", verify.sequence, "Sequence folder")->required();

  CampaignOptions campaign;
  CLI::App& campaign_command =
      AddCommand(app, "campaign", "Scenarios x varied settings x systems x seeds, on this machine or a cluster",
                 "vobench campaign scenes/campaign_points.yaml -o out/points --jobs 2");
  AddCampaign(campaign_command, raw, campaign);

  ReportOptions report;
  CLI::App& report_command =
      AddCommand(app, "report", "Make report.html anew from a result folder", "vobench report out/room");
  report_command.add_option("OUT", report.output, "Result folder")->required();

  try {
    app.parse(argc, argv);
    const auto asked = [](const CLI::App& command) { return command.parsed(); };
    if (asked(render_command)) {
      if (!raw.frames.empty()) render.frames = ParseFrames(raw.frames);
      if (render_seed->count() > 0) render.seed = raw.seed;
      render.jobs = raw.jobs;
      render.overrides = raw.overrides();
      return render;
    }
    if (asked(track_command)) {
      track.seed = raw.seed;
      track.overrides = raw.overrides();
      track.command_line = CommandLine(argc, argv);
      return track;
    }
    if (asked(evaluate_command)) return evaluate;
    if (asked(run_command)) {
      if (std::set<std::string>(run.systems.begin(), run.systems.end()).size() != run.systems.size()) {
        throw CLI::ValidationError("--system", "names a system twice");
      }
      run.verdict = run.verdict || run.require_consistent;
      run.seed = raw.seed;
      run.jobs = raw.jobs;
      run.overrides = raw.overrides();
      run.command_line = CommandLine(argc, argv);
      return run;
    }
    if (asked(check_command)) {
      check.overrides = raw.overrides();
      return check;
    }
    if (asked(verify_command)) return verify;
    if (asked(campaign_command)) {
      campaign.jobs = raw.jobs;
      return campaign;
    }
    return report;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
}

}  // namespace vobench
