// A real Slurm of one node, on the loopback interface alone: munged, slurmctld and slurmd with a configuration
// of their own in a temporary folder.
#pragma once

#include <string>
#include <thread>
#include <vector>

#include "tests/system/program.h"

namespace vobench::system_test {

class SlurmCluster {
 public:
  // Why there can be none here; empty: there can.
  static std::string WhyNot();

  // Starts the daemons and waits until the node is idle; from now on this process's environment points to them. Throws
  // std::runtime_error with their last words.
  SlurmCluster();
  // Ends the jobs and the daemons.
  ~SlurmCluster();
  SlurmCluster(const SlurmCluster&) = delete;
  SlurmCluster& operator=(const SlurmCluster&) = delete;

  // As if the node lost power: its daemon and all that runs there, with SIGKILL; and the controller notices.
  void KillNode();
  // The daemon alone: what runs there goes on.
  void KillNodeDaemon();
  // After either.
  void StartNode();

  std::string Log() const;

 private:
  int Start(const std::vector<std::string>& words);
  void End(int& process, int signal);
  bool Waits(const std::string& state) const;

  TemporaryFolder here_;
  int munged_ = 0, controller_ = 0, node_ = 0;
  std::jthread reaper_;  // of what killed daemons leave behind
};

}  // namespace vobench::system_test
