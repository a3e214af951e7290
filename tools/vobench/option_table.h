// Command line: every sub-command with its options, once. What is parsed, what --help, the man page and bash's
// completion say of it. Defaults are those of the option structs; each sub-command is added by the file of its name.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tools/bench/campaign/options.h"
#include "tools/bench/run/commands.h"

namespace vobench {

using Command = std::variant<RenderOptions, TrackOptions, EvaluateOptions, RunOptions, CheckOptions, ReportOptions,
                             VerifyOptions, CampaignOptions, ExportOptions, SettingsOptions>;

// A check that leaves the argument's name in the help as it is.
inline CLI::Validator Plain(const CLI::Validator& check) { return check.description(""); }

// Not to be copied: `app` writes into the other members when it parses.
struct OptionTable {
  OptionTable();
  OptionTable(const OptionTable&) = delete;
  OptionTable& operator=(const OptionTable&) = delete;

  CLI::App app;
  std::string command_line;      // for the record
  std::optional<Command> asked;  // once it is parsed

 private:
  void AddRender();
  void AddTrack();
  void AddEvaluate();
  void AddRun();
  void AddCampaign();
  void AddCheck();
  void AddVerify();
  void AddExport();
  void AddReport();
  void AddSettings();

  // Options that several sub-commands share.
  CLI::App& AddCommand(const std::string& name, const std::string& help, const std::string& example);
  void AddSet(CLI::App& command, const std::string& example);
  static void AddView(CLI::App& command, bool& view);
  static void AddMap(CLI::App& command, std::optional<std::filesystem::path>& map);
  void AddJobs(CLI::App& command, const std::string& help);
  void AddEngine(CLI::App& command);
  CLI::Option* AddSeed(CLI::App& command, const std::string& help);
  Overrides ParsedOverrides() const;  // of --set and --engine. Throws CLI::ValidationError

  RenderOptions render;
  TrackOptions track;
  EvaluateOptions evaluate;
  RunOptions run;
  CheckOptions check;
  VerifyOptions verify;
  CampaignOptions campaign;
  ReportOptions report;
  ExportOptions exported;
  SettingsOptions settings;

  // Read as text first, or shared.
  std::vector<std::string> set;
  std::string frames, compat, engine;
  std::uint64_t seed = 1;
  int jobs;  // as many as the machine has cores
};

}  // namespace vobench
