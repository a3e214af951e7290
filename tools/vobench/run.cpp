#include <set>

#include "tools/bench/systems/systems.h"
#include "tools/vobench/option_table.h"

namespace vobench {

void OptionTable::AddRun() {
  CLI::App& command = AddCommand("run", "Render a scenario, track it and judge the result, in memory, frame by frame",
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
  AddSeed(command,
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
  AddEngine(command);
  AddJobs(command, "Threads; the results do not depend on it");
  AddSet(command, "odometry.filter.particles=16");
  command.callback([this] {
    if (std::set<std::string>(run.systems.begin(), run.systems.end()).size() != run.systems.size()) {
      throw CLI::ValidationError("--system", "names a system twice");
    }
    run.verdict = run.verdict || run.require_consistent;
    run.seed = seed;
    run.jobs = jobs;
    run.overrides = ParsedOverrides();
    run.command_line = command_line;
    asked = run;
  });
}

}  // namespace vobench
