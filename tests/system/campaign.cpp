#include "tests/system/campaign.h"

#include <algorithm>
#include <sstream>

namespace vobench::system_test {
namespace fs = std::filesystem;

std::map<std::string, Row> BySystem(const std::string& csv) {
  std::istringstream lines(csv);
  std::vector<std::string> header;
  std::map<std::string, Row> rows;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (const char c : line) {
      if (c == '"') quoted = !quoted;
      if (c == ',' && !quoted) fields.emplace_back();
      if (c != '"' && (c != ',' || quoted)) fields.back() += c;
    }
    if (header.empty()) {
      header = fields;
      continue;
    }
    Row row;
    for (std::size_t i = 0; i < header.size() && i < fields.size(); ++i) row[header[i]] = fields[i];
    rows[row.at("system")] = row;
  }
  return rows;
}

std::string CampaignTest::Points(const std::string& seeds) {
  const std::string scenario = (TinyScenario().parent_path() / "points.yaml").string();
  return "scenarios: [{file: " + scenario + ", set: {time.duration: 2 s}}]\n" +
         "vary: [{name: noise, key: world.points.measurement.noise, values: [0.5 px, 1 px, 2 px]}]\n" +
         "systems: [rb2pf, {name: rbpf_16, system: rbpf, set: {odometry.filter.particles: 16}}]\n" + "seeds: " + seeds +
         "\n";
}

std::string CampaignTest::Images(const fs::path& scenario) {
  return "scenarios: [{file: " + scenario.string() + ", set: {time.duration: 0.4 s}}]\n" +
         "vary: [{name: exposure, key: sensor.exposure, values: [2 ms, 10 ms]}]\nsystems: [rb2pf, rbpf]\nseeds: [1, "
         "2]\n";
}

std::vector<std::string> CampaignTest::Words(const std::string& out, const std::vector<std::string>& more) const {
  std::vector<std::string> words = {"campaign", "c.yaml", "-o", out};
  if (std::find(more.begin(), more.end(), "--jobs") == more.end()) words.insert(words.end(), {"--jobs", "2"});
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Outcome CampaignTest::Run(const std::string& text, const std::string& out, const std::vector<std::string>& more) {
  WriteFile(here_ / "c.yaml", text);
  return RunVobench(Words(out, more), here_.path());
}

void CampaignTest::MustRun(const std::string& text, const std::string& out, const std::vector<std::string>& more) {
  const Outcome outcome = Run(text, out, more);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
}

std::map<std::string, std::string> CampaignTest::Lasting(const std::string& out) const {
  std::map<std::string, std::string> files = Tree(here_ / out / "tasks");
  std::erase_if(files,
                [](const auto& file) { return file.first.ends_with("times.json") || file.first.ends_with("log.txt"); });
  for (const char* name : {"results.csv", "tables.md", "tables.tex"}) files[name] = ReadFile(here_ / out / name);
  return files;
}

std::size_t CampaignTest::Done(const std::string& out) const {
  std::size_t count = 0;
  std::error_code error;
  for (fs::directory_iterator entry(here_ / out / "tasks/00", error), end; !error && entry != end;
       entry.increment(error)) {
    count += entry->path().filename().string().front() != '.';
  }
  return count;
}

}  // namespace vobench::system_test
