// Fixture with small campaigns in a temporary folder.
#pragma once

#include <gmock/gmock.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/system/program.h"

namespace vobench::system_test {

// Lines of results.csv by system, fields by column.
using Row = std::map<std::string, std::string>;
std::map<std::string, Row> BySystem(const std::string& csv);

class CampaignTest : public testing::Test {
 protected:
  // 3 x 2 x 5 tasks on points, each some tens of milliseconds.
  static std::string Points(const std::string& seeds = "1..5");
  // 2 exposures x 2 systems x 2 seeds on the first 12 frames of scenes/tiny.yaml.
  static std::string Images(const std::filesystem::path& scenario = TinyScenario());

  // Writes `text` to c.yaml and runs `vobench campaign c.yaml -o OUT ...`.
  Outcome Run(const std::string& text, const std::string& out, const std::vector<std::string>& more = {});
  std::vector<std::string> Words(const std::string& out, const std::vector<std::string>& more = {}) const;
  // The same; must succeed.
  void MustRun(const std::string& text, const std::string& out, const std::vector<std::string>& more = {});

  std::string Results(const std::string& out) const { return ReadFile(here_ / out / "results.csv"); }
  // All files of all tasks and the tables, except times and logs.
  std::map<std::string, std::string> Lasting(const std::string& out) const;
  std::size_t Done(const std::string& out) const;  // tasks that have a folder

  TemporaryFolder here_;
};

}  // namespace vobench::system_test
