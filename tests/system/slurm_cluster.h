// Slurm of one node, on the loopback interface alone: munged, slurmctld and slurmd, with their configuration in a
// temporary folder.
#pragma once

#include <string>
#include <thread>
#include <vector>

#include "tests/system/program.h"

namespace vobench::system_test {

class SlurmCluster {
 public:
  // Reason why none can run here; empty if one can.
  static std::string WhyNot();

  // Starts the daemons, waits until the node is ready and sets this process's environment for them. Throws
  // std::runtime_error with their logs.
  SlurmCluster();
  // Ends the jobs and the daemons.
  ~SlurmCluster();
  SlurmCluster(const SlurmCluster&) = delete;
  SlurmCluster& operator=(const SlurmCluster&) = delete;

  // Power loss of the node: SIGKILL for its daemon and all its processes, then state DOWN in the controller.
  void KillNode();
  // SIGKILL for the daemon alone; its jobs go on.
  void KillNodeDaemon();
  // Starts the daemon again, after either.
  void StartNode();

  std::string Log() const;

 private:
  int Start(const std::vector<std::string>& words);
  void End(int& process, int signal);
  bool Waits(const std::string& state) const;

  TemporaryFolder here_;
  int munged_ = 0, controller_ = 0, node_ = 0;
  std::jthread reaper_;  // of orphans of killed daemons
};

}  // namespace vobench::system_test
