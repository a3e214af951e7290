#include "tools/vobench/option_table.h"

namespace vobench {

void OptionTable::AddCampaign() {
  CLI::App& command =
      AddCommand("campaign", "Scenarios x varied settings x systems x seeds, on this machine or a cluster",
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
  AddJobs(command, "Processes at a time, with --engine local");
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
  command.callback([this] {
    campaign.jobs = jobs;
    asked = campaign;
  });
}

}  // namespace vobench
