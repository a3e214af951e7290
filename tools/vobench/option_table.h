// Purpose: every sub-command with its options, once: what is parsed, what --help, the man page and the shells'
//          completions say of it. Defaults are those of the structs in commands.h.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/vobench/commands.h"

namespace vobench {

// Not to be copied: `app` writes into the other members when it parses.
struct OptionTable {
  OptionTable();
  OptionTable(const OptionTable&) = delete;
  OptionTable& operator=(const OptionTable&) = delete;

  CLI::App app;
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

  // What is read as text first, and what several sub-commands share.
  std::vector<std::string> set;
  std::string frames;
  std::uint64_t seed = 1;
  int jobs;  // as many as the machine has cores
  std::string engine;

 private:
  void AddRender();
  void AddTrack();
  void AddEvaluate();
  void AddRun();
  void AddCampaign();
  void AddOthers();  // check, settings, verify, export, report
};

}  // namespace vobench
