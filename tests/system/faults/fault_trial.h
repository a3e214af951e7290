// Fault injection: one write of one command fails; checks of the message and of the files left.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tests/system/program.h"

namespace vobench::system_test {

// Command that writes below its working folder.
struct FaultCommand {
  std::string name;
  std::vector<std::string> words;
  std::vector<std::string> again = words;  // command after a failure; default: the same
  std::vector<std::string> prepare = {};   // folder of inputs, copied to "out" before; none: no such folder
  // Files that differ from run to run (times, the command line): only their existence is checked.
  std::vector<std::string> volatile_files = {};
  bool leaves_partial = false;    // finished work stays, for `again`; else the folder is as before
  bool names_no_reason = false;   // a library gives no reason; the message has a possible one
  bool by_stdio = false;          // a library writes with stdio, for which an interrupted write has failed
  bool prints_into_file = false;  // output to stdout, redirected to a file
};

// Counted call; its number is its position, from 1.
struct CountedCall {
  std::string call;  // "write"
  std::string path;
};

class FaultTrial {
 public:
  // `inputs`: folder of the inputs, "../inputs" in `words`; has the folders of `prepare`.
  FaultTrial(FaultCommand command, const std::filesystem::path& inputs);

  const std::vector<CountedCall>& calls() const { return calls_; }
  // Whether the fault exists for this call: no EINTR for a rename, a short write for writes only.
  bool CanHave(std::size_t number, const std::string& kind) const;

  // Runs the command with the fault in the number-th call (from 1). Returns what is wrong afterwards, or "".
  std::string Problem(std::size_t number, const std::string& kind);

 private:
  using Files = std::map<std::string, std::string>;

  void Prepare();
  Outcome Run(const std::vector<std::string>& words, std::size_t at, const std::string& kind);
  Files Result() const;  // files of the command, volatile ones without content
  std::string ProblemOfMessage(const Outcome& outcome, const CountedCall& call, const std::string& kind) const;

  FaultCommand command_;
  std::filesystem::path inputs_;
  TemporaryFolder here_;
  Files before_, whole_;
  std::vector<CountedCall> calls_;
};

const std::vector<std::string>& FaultKinds();  // ENOSPC, EIO, EINTR, short

// render, run, track, campaign, export, report, evaluate on the smallest inputs.
std::vector<FaultCommand> FaultCommands();
// Parcel in small images at 30 Hz: a short run is nearly all start-up.
std::string SmallScenario(const std::string& duration);
// Inputs of the commands, made by the program: a sequence and a result.
void MakeFaultInputs(const std::filesystem::path& folder);

}  // namespace vobench::system_test
