// One write of one command fails; what the program then says and leaves.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tests/system/program.h"

namespace vobench::system_test {

// A command that writes below the folder it runs in.
struct FaultCommand {
  std::string name;
  std::vector<std::string> words;
  std::vector<std::string> again = words;  // to go on after a failure; the same words where nothing else is said
  std::vector<std::string> prepare = {};  // the folder of inputs that is copied to "out" before; none: nothing is there
  // Files that differ from run to run (times, the command line): that they are there is all that is asked of them.
  std::vector<std::string> volatile_files = {};
  bool leaves_partial = false;    // what is done by then stays, for `again`; else everything is as before
  bool names_no_reason = false;   // a library does not say why; the message names what may be
  bool by_stdio = false;          // a library writes with stdio, for which an interrupted write has failed
  bool prints_into_file = false;  // to stdout, which is a file here
};

// A call that was counted: the number is its place.
struct CountedCall {
  std::string call;  // "write"
  std::string path;
};

class FaultTrial {
 public:
  // `inputs`: what `words` and `prepare` name, as "../inputs/...".
  FaultTrial(FaultCommand command, const std::filesystem::path& inputs);

  const std::vector<CountedCall>& calls() const { return calls_; }
  // Whether this call can have it: a rename is not interrupted, only a write is cut short.
  bool CanHave(std::size_t number, const std::string& kind) const;

  // The number-th call (from 1) has the fault. What is wrong with what follows; empty where nothing is.
  std::string Problem(std::size_t number, const std::string& kind);

 private:
  using Files = std::map<std::string, std::string>;

  void Prepare();
  Outcome Run(const std::vector<std::string>& words, std::size_t at, const std::string& kind);
  Files Result() const;  // of the command, without what changes
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
// A parcel in small pictures, 30 a second: nearly all of a short run is then its start.
std::string SmallScenario(const std::string& duration);
// What they read, made by the program: a sequence and a result.
void MakeFaultInputs(const std::filesystem::path& folder);

}  // namespace vobench::system_test
