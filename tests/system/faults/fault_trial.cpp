#include "tests/system/faults/fault_trial.h"

#include <algorithm>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace vobench::system_test {
namespace fs = std::filesystem;
namespace {

using Words = std::vector<std::string>;

// Text of strerror for a fault.
const char* ReasonOf(const std::string& kind) {
  if (kind == "ENOSPC") return "No space left on device";
  if (kind == "EIO") return "Input/output error";
  return "Interrupted system call";
}

std::size_t Count(const std::string& text, const std::string& words) {
  std::size_t count = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
  return count;
}

std::string Difference(const std::map<std::string, std::string>& there,
                       const std::map<std::string, std::string>& wanted) {
  std::string text;
  for (const auto& [name, bytes] : wanted) {
    if (!there.contains(name)) text += " " + name + " is missing;";
    if (there.contains(name) && there.at(name) != bytes) text += " " + name + " differs;";
  }
  for (const auto& [name, bytes] : there) {
    if (!wanted.contains(name)) text += " " + name + " is left;";
  }
  return text;
}

}  // namespace

const std::vector<std::string>& FaultKinds() {
  static const std::vector<std::string> kinds = {"ENOSPC", "EIO", "EINTR", "short"};
  return kinds;
}

FaultTrial::FaultTrial(FaultCommand command, const fs::path& inputs) : command_(std::move(command)), inputs_(inputs) {
  fs::create_directory_symlink(inputs_, here_ / "inputs");
  Prepare();
  before_ = Result();
  const Outcome outcome = Run(command_.words, 0, "");
  if (outcome.status != 0) throw std::runtime_error(command_.name + ": " + outcome.err);
  whole_ = Result();
  std::istringstream lines(ReadFile(here_ / "log"));
  std::string number;
  for (CountedCall call; lines >> number >> call.call && std::getline(lines >> std::ws, call.path);)
    calls_.push_back(call);
  if (calls_.empty()) throw std::runtime_error(command_.name + ": no write was counted");
}

void FaultTrial::Prepare() {
  fs::remove_all(here_ / "work");
  fs::create_directory(here_ / "work");
  for (const std::string& folder : command_.prepare) {
    fs::copy(inputs_ / folder, here_ / "work" / "out", fs::copy_options::recursive);
  }
}

Outcome FaultTrial::Run(const Words& words, std::size_t at, const std::string& kind) {
  WriteFile(here_ / "counter", std::string(8, '\0'));
  fs::remove(here_ / "log");
  std::string shell = "export VOBENCH_FAULT_FOLDER=" + Quoted((here_ / "work").string()) +
                      " VOBENCH_FAULT_COUNTER=" + Quoted((here_ / "counter").string()) +
                      " VOBENCH_FAULT_LOG=" + Quoted((here_ / "log").string()) +
                      " VOBENCH_FAULT_AT=" + std::to_string(at) + " VOBENCH_FAULT_KIND=" + Quoted(kind) +
                      " LD_PRELOAD=" + Quoted(VOBENCH_FAIL_WRITES) + "\n";
  if (command_.prints_into_file) shell += "exec > printed.txt\n";
  return RunVobench(words, here_ / "work", shell);
}

FaultTrial::Files FaultTrial::Result() const {
  Files files = Tree(here_ / "work");
  for (auto& [name, bytes] : files) {
    const std::string file = fs::path(name).filename().string();
    const auto& changing = command_.volatile_files;
    if (std::find(changing.begin(), changing.end(), file) != changing.end()) bytes = "";
  }
  return files;
}

bool FaultTrial::CanHave(std::size_t number, const std::string& kind) const {
  static const std::set<std::string> not_interrupted = {"rename", "renameat", "mkdir", "mkdirat", "link"};
  static const std::set<std::string> cut = {"write", "writev", "pwrite", "pwrite64", "copy_file_range", "sendfile"};
  const std::string& call = calls_.at(number - 1).call;
  if (kind == "EINTR") return !not_interrupted.contains(call);
  if (kind == "short") return cut.contains(call);
  return true;
}

std::string FaultTrial::ProblemOfMessage(const Outcome& outcome, const CountedCall& call,
                                         const std::string& kind) const {
  if (Count("\n" + outcome.err, "\nvobench: ") != 1) return "not one message";
  if (outcome.err.find("terminate called") != std::string::npos) return "it was aborted";
  const bool to_stdout = command_.prints_into_file && call.path.ends_with("printed.txt");
  const bool is_named =
      to_stdout ? outcome.err.find("standard output") != std::string::npos
                : outcome.err.find("out") != std::string::npos || outcome.err.find("map.ply") != std::string::npos;
  if (!is_named) return "no file is named";
  if (command_.names_no_reason && outcome.err.find("room on the disk") != std::string::npos) return "";
  if (outcome.err.find(ReasonOf(kind)) == std::string::npos) return "no reason is named";
  return "";
}

std::string FaultTrial::Problem(std::size_t number, const std::string& kind) {
  Prepare();
  const Outcome outcome = Run(command_.words, number, kind);
  const CountedCall& call = calls_.at(number - 1);
  const std::string where = command_.name + ": " + kind + " at call " + std::to_string(number) + " (" + call.call +
                            " " + fs::path(call.path).lexically_relative(here_ / "work").string() + "): ";
  const std::string said = "\n" + outcome.err;
  const Files left = Result();
  if (outcome.status == 0) {
    const std::string difference = Difference(left, whole_);
    return difference.empty() ? "" : where + "status 0, but" + difference + said;
  }
  if (outcome.status != 1) return where + "status " + std::to_string(outcome.status) + said;
  if (kind == "short" || (kind == "EINTR" && !command_.by_stdio)) return where + "fails, and need not" + said;
  if (const std::string problem = ProblemOfMessage(outcome, call, kind); !problem.empty())
    return where + problem + said;
  if (!command_.leaves_partial && !command_.prints_into_file) {
    Files but_whole = left;  // a second output, complete by then
    if (left.contains("map.ply") && left.at("map.ply") == whole_.at("map.ply")) but_whole.erase("map.ply");
    if (const std::string difference = Difference(but_whole, before_); !difference.empty())
      return where + "after it" + difference;
  }
  const bool believed = command_.leaves_partial && command_.name != "campaign" && left.contains("out");
  if (believed && !Difference(left, whole_).empty()) return where + "a folder that is not whole has the last name";
  const Outcome again = Run(command_.again, 0, "");
  if (again.status != 0) return where + "the same command again: " + again.err;
  if (const std::string difference = Difference(Result(), whole_); !difference.empty()) {
    return where + "the same command again:" + difference;
  }
  return "";
}

std::vector<FaultCommand> FaultCommands() {
  const std::string tiny = "../inputs/small.yaml";
  const Words times = {"run.json", "metrics.json", "report.html", "frames.csv"};
  const Words run = {"run", tiny, "-o", "out", "--system", "rb2pf"};
  const Words track = {"track", "../inputs/seq", "-o", "out"};
  const Words render = {"render", tiny, "-o", "out", "--frames", "0:2", "--jobs", "1"};
  const auto with = [](Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  std::vector<FaultCommand> all;
  all.push_back({.name = "render", .words = render, .again = with(render, {"--resume"}), .leaves_partial = true});
  all.push_back({.name = "render_truth_euroc",
                 .words = with(render, {"--format", "euroc", "--truth", "flow,imu"}),
                 .again = with(render, {"--format", "euroc", "--truth", "flow,imu", "--resume"}),
                 .leaves_partial = true});
  all.push_back(
      {.name = "render_preview",
       .words = with(render, {"--preview"}),
       .again = with(render, {"--preview", "--resume"}),
       .volatile_files = {"preview.mp4"},  // file differs: a codec that cannot be opened is replaced by the next one
       .leaves_partial = true,
       .names_no_reason = true,
       .by_stdio = true});
  all.push_back({.name = "run", .words = run, .volatile_files = times});
  all.push_back({.name = "run_again", .words = run, .prepare = {"run"}, .volatile_files = times});
  all.push_back({.name = "run_points",
                 .words = {"run", (TinyScenario().parent_path() / "points.yaml").string(), "-o", "out", "--runs", "2",
                           "--set", "time.duration=1 s"},
                 .volatile_files = times});
  all.push_back({.name = "run_long",  // more frames than are kept in memory
                 .words = {"run", (TinyScenario().parent_path() / "points.yaml").string(), "-o", "out", "--system",
                           "rb2pf", "--set", "time.duration=40 s"},
                 .volatile_files = times});
  all.push_back({.name = "track", .words = with(track, {"--map", "map.ply"}), .volatile_files = times});
  all.push_back({.name = "campaign",
                 .words = {"campaign", "../inputs/c.yaml", "-o", "out", "--jobs", "1"},
                 .volatile_files = {"times.json", "times.csv", "log.txt", "report.html"},
                 .leaves_partial = true});
  all.push_back({.name = "export", .words = {"export", "../inputs/seq", "--bag", "out.bag"}});
  all.push_back({.name = "export_mcap", .words = {"export", "../inputs/seq", "--mcap", "out.mcap"}});
  all.push_back({.name = "report", .words = {"report", "out"}, .prepare = {"run"}});
  all.push_back({.name = "evaluate",
                 .words = {"evaluate", "../inputs/run/estimate.txt", "--truth", "../inputs/seq", "--align", "none"},
                 .by_stdio = true,
                 .prints_into_file = true});
  return all;
}

std::string SmallScenario(const std::string& duration) {
  const std::string mesh = (TinyScenario().parent_path() / "room/parcel.obj").string();
  return "seed: 1\nworld:\n  meshes: [{file: " + mesh + R"(}]
  lights: [{type: ambient, radiance: [0.9, 0.9, 0.9]}]
camera: {width: 160, height: 120, fx: 131.25, fy: 131.25, cx: 79.5, cy: 59.5}
sensor: {exposure: 10 ms, time_samples: 1}
time: {rate: 30 Hz, duration: )" +
         duration + R"(}
trajectory:
  type: scripted
  keys:
    - {time: 0.0 s, position: [0.5, 0.4, 0.6], look_at: [0, 0.1, 0]}
    - {time: )" +
         duration + R"(, position: [0.55, 0.4, 0.6], look_at: [0, 0.1, 0]}
)";
}

void MakeFaultInputs(const fs::path& folder) {
  const auto must = [&](const Words& words) {
    const Outcome outcome = RunVobench(words, folder);
    if (outcome.status != 0) throw std::runtime_error(outcome.err);
  };
  WriteFile(folder / "small.yaml", SmallScenario("0.1 s"));
  must({"render", "small.yaml", "-o", "seq"});
  must({"track", "seq", "-o", "run"});
  WriteFile(folder / "c.yaml", "scenarios: [small.yaml]\nsystems: [rb2pf]\nseeds: [1, 2]\n");
}

}  // namespace vobench::system_test
