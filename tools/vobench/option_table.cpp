#include "tools/vobench/option_table.h"

#include <algorithm>
#include <memory>
#include <thread>

#include "tools/vobench/help_text.h"

namespace vobench {

CLI::App& OptionTable::AddCommand(const std::string& name, const std::string& help, const std::string& example) {
  CLI::App& command = *app.add_subcommand(name, help);
  command.footer("Example: " + example);
  return command;
}

void OptionTable::AddSet(CLI::App& command, const std::string& example) {
  command.add_option("--set", set, "Change one setting, such as " + example + "; `vobench settings` lists them")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void OptionTable::AddView(CLI::App& command, bool& view) {
  command.add_flag("--view", view, "The report in a browser while it runs; its address is printed");
}

void OptionTable::AddMap(CLI::App& command, std::optional<std::filesystem::path>& map) {
  command.add_option("--map", map, "Also the landmarks with their covariance: docs/result_folder.md")
      ->type_name("FILE.ply");
}

void OptionTable::AddJobs(CLI::App& command, const std::string& help) {
  command.add_option("-j,--jobs", jobs, help)
      ->check(Plain(CLI::Range(1, 1024)))
      ->type_name("N")
      ->default_str("all cores");
}

void OptionTable::AddEngine(CLI::App& command) {
  command.add_option("--engine", engine, "What renders, ray_tracer or rasteriser: docs/renderers.md")
      ->check(CLI::IsMember({"ray_tracer", "rasteriser"}))
      ->type_name("NAME");
}

CLI::Option* OptionTable::AddSeed(CLI::App& command, const std::string& help) {
  return command.add_option("--seed", seed, help)->check(Plain(CLI::NonNegativeNumber))->type_name("N");
}

Overrides OptionTable::ParsedOverrides() const {
  Overrides all;
  if (!engine.empty()) all.emplace_back("render.engine", engine);
  for (const std::string& text : set) {
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos) {
      throw CLI::ValidationError("--set", "'" + text + "' is not key=value");
    }
    all.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  return all;
}

OptionTable::OptionTable()
    : app("vobench: synthetic data for visual odometry, and the bench that tests it", "vobench"),
      jobs(static_cast<int>(std::max(1U, std::thread::hardware_concurrency()))) {
  app.formatter(std::make_shared<HelpText>());
  app.set_help_flag("-h,--help", "Show this help and exit");
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
  AddCheck();
  AddSettings();
  AddVerify();
  AddExport();
  AddReport();
}

}  // namespace vobench
