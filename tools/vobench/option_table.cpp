#include "tools/vobench/option_table.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tools/base/settings/state.h"
#include "tools/base/text.h"
#include "tools/bench/systems/systems.h"
#include "tools/bench/text.h"
#include "tools/vobench/help_text.h"

namespace vobench {
namespace {

namespace fs = std::filesystem;

// A sub-command and where its options are parsed to.
template <class Options>
struct Parsed {
  CLI::App& command;
  Options& options;
};

template <class Options>
Parsed<Options> AddCommand(OptionTable& table, const std::string& name, const std::string& help,
                           const std::string& example) {
  CLI::App& command = *table.app.add_subcommand(name, help);
  const auto options = std::make_shared<Options>();
  command.footer("Example: " + example);
  command.callback([&table, options] { table.asked = *options; });
  return {command, *options};
}

// "-o,--output SEQ": names of an option, and of its argument in the help.
template <class T>
CLI::Option* Add(CLI::App& command, const std::string& synopsis, T& value, const std::string& help) {
  const std::size_t space = synopsis.find(' ');
  CLI::Option* option = command.add_option(synopsis.substr(0, space), value, help);
  return space == std::string::npos ? option : option->type_name(synopsis.substr(space + 1));
}

// A check that leaves the argument's name in the help as it is.
CLI::Validator Plain(const CLI::Validator& check) { return check.description(""); }

// An argument of digits alone, which fits the integer it is parsed to.
CLI::Validator WholeNumber() {
  return {[](std::string& text) {
            std::uint64_t value = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
            if (error == std::errc() && end == text.data() + text.size()) return std::string();
            return "'" + text + "' is no whole number from 0 to 18446744073709551615";
          },
          ""};
}

CLI::Validator PositiveNumber() {
  return {[](std::string& text) {
            return base::ParseNumber(text).value_or(0) > 0 ? "" : "'" + text + "' is no number above 0";
          },
          ""};
}

void AddSet(CLI::App& command, Overrides& overrides, const std::string& example) {
  const auto parse = [&overrides](const std::vector<std::string>& all) {
    for (const std::string& text : all) {
      const std::size_t equals = text.find('=');
      if (equals == 0 || equals == std::string::npos) {
        throw CLI::ValidationError("--set", "'" + text + "' is not key=value");
      }
      overrides.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    }
  };
  command
      .add_option_function<std::vector<std::string>>(
          "--set", parse, "Change one setting, such as " + example + "; `vobench settings` lists them")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void AddEngine(CLI::App& command, Overrides& overrides) {
  command
      .add_option_function<std::string>(
          "--engine", [&overrides](const std::string& engine) { overrides.emplace_back("render.engine", engine); },
          "What renders, ray_tracer or rasteriser: docs/renderers.md")
      ->check(CLI::IsMember({"ray_tracer", "rasteriser"}))
      ->type_name("NAME");
}

void AddMissingTextures(CLI::App& command, Overrides& overrides) {
  const auto set = [&overrides](const std::string& what) { overrides.emplace_back("world.missing_textures", what); };
  command
      .add_option_function<std::string>("--missing-textures", set, "A texture that is not there is an error, or grey")
      ->check(CLI::IsMember({"error", "grey"}))
      ->type_name("WHAT");
}

void AddMap(CLI::App& command, std::optional<fs::path>& map) {
  Add(command, "--map FILE.ply", map, "Also the landmarks with their covariance: docs/result_folder.md");
}

void AddJobs(CLI::App& command, int& jobs, const std::string& help) {
  jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  Add(command, "-j,--jobs N", jobs, help)->check(Plain(CLI::Range(1, 1024)))->default_str("all cores");
}

template <class T>
CLI::Option* AddSeed(CLI::App& command, T& seed, const std::string& help) {
  return Add(command, "--seed N", seed, help)->check(WholeNumber());
}

void AddRender(OptionTable& table) {
  const auto [command, render] =
      AddCommand<RenderOptions>(table, "render", "Render a scenario into a sequence: images with exact truth",
                                "vobench render scenes/room.yaml -o room --frames 0:30 --truth depth,flow");
  Add(command, "SCENARIO", render.scenario, "Scenario file (scenes/*.yaml)")->required();
  Add(command, "-o,--output SEQ", render.output, "Sequence folder to make")->required();
  const auto parse_frames = [&frames = render.frames](const std::string& text) {
    std::istringstream stream(text);
    std::int64_t first = 0, last = 0;
    char colon = 0, rest = 0;
    if (!(stream >> first >> colon >> last) || colon != ':' || stream >> rest || first < 0 || last <= first) {
      throw CLI::ValidationError("--frames", "'" + text + "' is not A:B with 0 <= A < B (frames A to B-1)");
    }
    frames.emplace(first, last);
  };
  command
      .add_option_function<std::string>("--frames", parse_frames,
                                        "Only the frames A to B-1; each is the same as in the whole")
      ->type_name("A:B");
  Add(command, "--format NAME", render.format, "Layout: tum (TUM RGB-D), euroc (EuRoC, ASL) or icl (ICL-NUIM)")
      ->check(CLI::IsMember({"tum", "euroc", "icl"}))
      ->capture_default_str();
  command.add_flag("--resume", render.resume,
                   "Go on with SEQ.partial, which an interrupted run left; the bytes are those of one run");
  command.add_flag("--preview", render.preview, "Also preview.mp4 and contact.jpg, for the eye");
  Add(command, "--truth NAME,...", render.truth,
      "Truth beside poses and velocities, separated by commas: depth, depth_exr, depth_kinect, distance, normals, "
      "flow, flow_backward, occlusion, surface_id, landmarks, acceleration, imu, moving, instance, semantic, boxes, "
      "disparity (docs/truth.md)");
  AddSeed(command, render.seed, "Seed instead of the scenario's");
  AddEngine(command, render.overrides);
  AddMissingTextures(command, render.overrides);
  AddJobs(command, render.jobs, "Threads; the results do not depend on it");
  AddSet(command, render.overrides, "sensor.exposure='5 ms'");
}

void AddTrack(OptionTable& table) {
  const auto [command, track] = AddCommand<TrackOptions>(
      table, "track", "Run an odometry on a sequence (TUM RGB-D, EuRoC or ICL-NUIM layout) from disk",
      "vobench track rgbd_dataset_freiburg1_xyz -o out/xyz --camera freiburg1 --seed 3");
  Add(command, "SEQ", track.sequence, "Sequence folder, video file, camera:0, or the address of a stream")->required();
  Add(command, "-o,--output OUT", track.output, "Result folder to make")->required();
  Add(command, "--system NAME", track.system, "One of " + SystemList())
      ->check(CLI::IsMember(SystemNames()))
      ->capture_default_str();
  Add(command, "--camera PRESET|FILE", track.camera,
      "freiburg1, freiburg2, freiburg3, icl, or a calibration file (ours, OpenCV, ROS, Kalibr, EuRoC); the sequence's "
      "own by default");
  Add(command, "--settings FILE", track.settings, "YAML file with an `odometry:` and perhaps a `prior:` section");
  command.add_flag("--truth", track.truth,
                   "Also errors of matches and predictions, and lives of landmarks: docs/match_errors.md");
  AddMap(command, track.map);
  AddSeed(command, track.seed, "Seed of the filter")->capture_default_str();
  AddSet(command, track.overrides, "odometry.filter.particles=16");
}

void AddEvaluate(OptionTable& table) {
  const auto [command, evaluate] =
      AddCommand<EvaluateOptions>(table, "evaluate", "Hold an estimated trajectory against the truth",
                                  "vobench evaluate out/xyz/estimate.txt --truth room --align sim3");
  Add(command, "ESTIMATE", evaluate.estimate, "Trajectory in TUM format, or a run folder")->required();
  Add(command, "--truth SEQ|FILE", evaluate.truth, "Trajectory in TUM format, or a sequence folder")->required();
  CLI::Option* align = Add(command, "--align NAME", evaluate.align,
                           "What the estimate may be moved by before: none, se3, sim3, first or yaw")
                           ->check(CLI::IsMember({"none", "se3", "sim3", "first", "yaw"}))
                           ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--compat", [&compat = evaluate.compat](const std::string& request) { compat = ParseCompat(request); },
          "Print what another tool prints: tum, evo, rpg or ov, and its own options in the same quotes, such as 'evo "
          "ape -as': docs/metrics.md")
      ->type_name("TOOL")
      ->excludes(align);
}

void AddRun(OptionTable& table) {
  const auto [command, run] = AddCommand<RunOptions>(
      table, "run", "Render a scenario, track it and judge the result, in memory, frame by frame",
      "vobench run scenes/room.yaml -o out/room --system rb2pf,rbpf --runs 5");
  Add(command, "SCENARIO", run.scenario, "Scenario file (scenes/*.yaml)")->required();
  Add(command, "-o,--output OUT", run.output, "Result folder to make; without it only the table is printed");
  const auto parse_systems = [&systems = run.systems](const std::vector<std::string>& names) {
    if (std::set<std::string>(names.begin(), names.end()).size() != names.size()) {
      throw CLI::ValidationError("--system", "names a system twice");
    }
    systems = names;
  };
  command
      .add_option_function<std::vector<std::string>>("--system", parse_systems,
                                                     "Systems to compare, separated by commas, of " + SystemList())
      ->delimiter(',')
      ->check(CLI::IsMember(SystemNames()))
      ->allow_extra_args(false)
      ->type_name("NAME,...")
      ->default_str(run.systems.front());
  Add(command, "--runs N", run.runs, "Runs of each system, each with its own seed")
      ->check(Plain(CLI::Range(1, 10000)))
      ->capture_default_str();
  AddSeed(command, run.seed,
          "Seed of the first run's filter and prior, and of its world of points; a scene keeps its own (--set seed=N)")
      ->capture_default_str();
  command.add_flag("--bound", run.bound,
                   "Also the Cramer-Rao bound of worlds of points, and RMSE / bound; takes seconds a run");
  command.add_flag("--verdict", run.verdict,
                   "Also whether each system is consistent with its own model, check by check, in worlds of points "
                   "from a prior; 10 runs or more");
  command.add_flag_callback(
      "--require-consistent", [&run = run] { run.verdict = run.require_consistent = true; },
      "As --verdict, and exit status 3 where a system is not");
  AddMap(command, run.map);
  AddEngine(command, run.overrides);
  AddMissingTextures(command, run.overrides);
  AddJobs(command, run.jobs, "Threads; the results do not depend on it");
  AddSet(command, run.overrides, "odometry.filter.particles=16");
}

// Engine of a campaign's tasks, and its resources. Returns --engine.
CLI::Option* AddPlace(CLI::App& command, CampaignOptions& campaign) {
  CLI::Option* where = Add(command, "--engine NAME", campaign.engine, "Where tasks run: local or slurm")
                           ->check(CLI::IsMember({"local", "slurm"}))
                           ->capture_default_str();
  AddJobs(command, campaign.jobs, "Processes at a time, with --engine local");
  Add(command, "--memory SIZE", campaign.memory_bytes,
      "Of each process, such as 2GB (default: an equal part of what is left)")
      ->transform(Plain(CLI::AsSizeValue(false)));
  Add(command, "--timeout S", campaign.timeout_s, "Seconds that a task may take (default: as long as it likes)")
      ->check(PositiveNumber());
  Add(command, "--partition NAME", campaign.partition, "Of Slurm");
  Add(command, "--time TIME", campaign.time, "Of one job of Slurm, such as 2:00:00");
  Add(command, "--tasks-per-job N", campaign.tasks_per_job, "Of Slurm: tasks that one element of the array does")
      ->check(Plain(CLI::Range(1, 1000000)))
      ->capture_default_str();
  return where;
}

void AddCampaign(OptionTable& table) {
  const auto [command, campaign] = AddCommand<CampaignOptions>(
      table, "campaign", "Scenarios x varied settings x systems x seeds, on this machine or a cluster",
      "vobench campaign scenes/campaign_points.yaml -o out/points --jobs 2");
  Add(command, "FILE", campaign.file, "Campaign file (docs/campaign.md)")->required();
  Add(command, "-o,--output OUT", campaign.output, "Folder of its results; what is done there is not done again")
      ->required();
  command.add_flag("--dry-run", campaign.dry_run, "Check everything and list the tasks, no more");
  CLI::Option* where = AddPlace(command, campaign);
  Add(command, "--cache DIR", campaign.cache, "Where rendered sequences are kept (default: OUT/cache)");
  command.add_option("--redo", campaign.redo, "Results of this system go, and are done anew")->type_name("SYSTEM");
  command.add_flag("--update", campaign.update,
                   "Results that the file as it is now would not give may go; else an error");
  CLI::Option* task =
      Add(command, "--task K", campaign.task, "Run this one task again, and say whether it comes out the same")
          ->check(WholeNumber())
          ->excludes(where);
  CLI::Option* list =
      Add(command, "--list FILE", campaign.list, "Run the tasks in line --part of this file, as job arrays do")
          ->excludes(task)
          ->excludes(where);
  Add(command, "--part N", campaign.part, "A line of --list; the first is 0")->check(WholeNumber())->needs(list);
}

void AddBench(OptionTable& table) {
  const auto [command, bench] = AddCommand<BenchOptions>(
      table, "bench", "Breaking points, accuracy, consistency and time of a system on one card; or what breaks it",
      "vobench bench rb2pf -o out/card --jobs 2");
  Add(command, "SYSTEM|COMMAND", bench.system,
      "One of " + SystemList() + ", of the file's external systems, or a command with {sequence} and {trajectory}")
      ->required();
  Add(command, "-o,--output OUT", bench.output, "Folder of its results; what is done there is not done again")
      ->required();
  Add(command, "--file FILE", bench.file, "Stresses and scenarios (docs/bench.md)")->capture_default_str();
  CLI::Option* full = command.add_flag("--full", bench.full, "More doses, seeds and pixels: for a cluster");
  command
      .add_flag_callback(
          "--quick", [&full = bench.full] { full = false; }, "Small pictures, a few seconds: the default")
      ->excludes(full);
  command.add_flag("--attack", bench.attack, "Instead the mildest combination of stresses that breaks it");
  AddPlace(command, bench.campaign);
  Add(command, "--cache DIR", bench.cache, "Where rendered sequences are kept (default: OUT/cache)");
  command.add_flag("--update", bench.campaign.update,
                   "Results that the file as it is now would not give may go; else an error");
}

void AddCheck(OptionTable& table) {
  const auto [command, check] =
      AddCommand<CheckOptions>(table, "check", "Read a scenario and all it names, and say what is wrong with it",
                               "vobench check scenes/room.yaml");
  Add(command, "SCENARIO", check.scenario, "Scenario file (scenes/*.yaml)")->required();
  Add(command, "--path FILE", check.path, "Also write the camera's path, every 10 ms, in TUM's format");
  AddMissingTextures(command, check.overrides);
  AddSet(command, check.overrides, "sensor.exposure='5 ms'");
}

void AddSettings(OptionTable& table) {
  const auto [command, settings] = AddCommand<SettingsOptions>(
      table, "settings", "List all settings: key, default, range, meaning", "vobench settings odometry.filter");
  Add(command, "PREFIX KEY", settings.prefix, "Only keys that begin so");
  command.add_flag("--markdown", settings.markdown, "As the tables of docs/settings.md");
}

void AddVerify(OptionTable& table) {
  const auto [command, verify] = AddCommand<VerifyOptions>(
      table, "verify", "Hold the streams of a sequence against each other: poses, depth, flow, IMU, pictures",
      "vobench verify room");
  Add(command, "SEQ", verify.sequence, "Sequence folder")->required();
}

void AddFitCamera(OptionTable& table) {
  const auto [command, fit] = AddCommand<FitCameraOptions>(
      table, "fit-camera", "Fit the simulated sensor to a recording", "vobench fit-camera rgbd_dataset_freiburg1_xyz");
  Add(command, "SEQ", fit.sequence, "Sequence folder")->required();
}

void AddImport(OptionTable& table) {
  const auto [command, from] = AddCommand<ImportOptions>(
      table, "import",
      "Make a scenario, with a first path, of a Gazebo world, a model, or mesh files (docs/your_scene.md)",
      "vobench import warehouse.sdf -o warehouse.yaml");
  Add(command, "WORLD|FOLDER", from.from, "SDF or URDF file, mesh file, or a folder with a model or with mesh files")
      ->required();
  Add(command, "-o,--output SCENARIO", from.output, "Scenario file to make; shapes go to a folder beside it")
      ->required();
  Add(command, "--models DIR", from.models,
      "Folder where model:// is looked for (beside GAZEBO_MODEL_PATH and the like)")
      ->allow_extra_args(false);
}

void AddLook(OptionTable& table) {
  const auto [command, look] =
      AddCommand<LookOptions>(table, "look", "Draw a sheet of views of a scenario's world: path, inside, outside",
                              "vobench look scenes/room.yaml -o room.png");
  Add(command, "SCENARIO", look.scenario, "Scenario file")->required();
  Add(command, "-o,--output SHEET.png", look.output, "Picture to make")->required();
  AddMissingTextures(command, look.overrides);
  AddSet(command, look.overrides, "world.meshes.0.color='[0.5, 0.5, 0.5]'");
}

void AddExport(OptionTable& table) {
  const auto [command, exported] =
      AddCommand<ExportOptions>(table, "export", "Write a sequence in another form: a ROS 1 bag, MCAP, COCO's labels",
                                "vobench export room --bag room.bag");
  Add(command, "SEQ", exported.sequence, "Sequence folder")->required();
  Add(command, "--bag FILE.bag", exported.bag, "ROS 1 bag to make");
  Add(command, "--mcap FILE.mcap", exported.mcap, "The same as MCAP, with the messages of ROS 2");
  Add(command, "--coco FILE.json", exported.coco, "File of COCO's object detection to make, of the stream `instance`");
}

void AddReport(OptionTable& table) {
  const auto [command, report] = AddCommand<ReportOptions>(
      table, "report", "Make report.html anew from a result folder", "vobench report out/room");
  Add(command, "OUT", report.output, "Result folder")->required();
}

// A command or option that there is not, with the nearest one; empty: all are known.
std::string UnknownWord(const CLI::App& app, const std::vector<std::string>& arguments) {
  std::vector<std::string> names;
  for (const CLI::App* command : CommandsOf(app)) names.push_back(command->get_name());
  if (arguments.empty() || arguments[0].starts_with('-')) return "";
  if (std::ranges::count(names, arguments[0]) == 0)
    return "there is no command '" + arguments[0] + "'" + settings::Suggest(arguments[0], names);
  names.clear();
  const CLI::App& command = *app.get_subcommand(arguments[0]);
  for (const OptionRow& row : RowsOf(command)) std::ranges::copy(row.names, std::back_inserter(names));
  for (const std::string& argument : arguments) {
    const std::string option = argument.substr(0, argument.find('='));
    if (option.starts_with("--") && option != "--" && std::ranges::count(names, option) == 0)
      return "`" + arguments[0] + "` has no option " + option + settings::Suggest(option, names);
  }
  return "";
}

// The command line, quoted for reuse.
std::string CommandLine(int argc, char** argv) {
  std::string line = "vobench";
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool plain = !argument.empty() && argument.find_first_of(" \t\n'\"\\$`*?;&|<>(){}[]~#!") == std::string::npos;
    line += " " + (plain ? argument : QuotedForShell(argument));
  }
  return line;
}

}  // namespace

OptionTable::OptionTable()
    : app("vobench: synthetic data for visual odometry, and the bench that tests it", "vobench") {
  app.formatter_fn([](const CLI::App* command, std::string, CLI::AppFormatMode) { return HelpText(*command); });
  app.set_help_flag("-h,--help", "Show this help and exit");
  app.set_version_flag("--version", "vobench " VOBENCH_VERSION, "Which vobench this is");
  app.failure_message([](const CLI::App* command, const CLI::Error& e) {
    return "vobench: " + CLI::FailureMessage::simple(command, e);
  });
  app.require_subcommand(1);
  app.footer(
      "`vobench COMMAND --help` has more. Exit status: 0 done, 1 the work failed or `verify` found a disagreement, "
      "2 bad usage or input, 3 not consistent though `run --require-consistent` asked for it.");
  for (const auto add : {AddRender, AddTrack, AddEvaluate, AddRun, AddCampaign, AddBench, AddCheck, AddSettings,
                         AddVerify, AddExport, AddReport, AddFitCamera, AddImport, AddLook}) {
    add(*this);
  }
}

std::variant<Command, int> ParseArguments(int argc, char** argv) {
  OptionTable table;
  try {
    table.app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (const std::string unknown = UnknownWord(table.app, {argv + 1, argv + argc}); !unknown.empty()) {
      std::fprintf(stderr, "vobench: %s\n", unknown.c_str());
      return 2;
    }
    return table.app.exit(error) == 0 ? 0 : 2;
  }
  const auto record = [&](auto& options) {
    if constexpr (requires { options.command_line; }) options.command_line = CommandLine(argc, argv);
  };
  std::visit(record, *table.asked);
  return *std::move(table.asked);
}

}  // namespace vobench
