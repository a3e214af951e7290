#include "tests/system/slurm_cluster.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <thread>

namespace vobench::system_test {
namespace fs = std::filesystem;
namespace {

// Unused port of 127.0.0.1.
int FreePort() {
  const int file = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  const bool good = bind(file, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                    getsockname(file, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  close(file);
  if (!good) throw std::runtime_error("no free port");
  return ntohs(address.sin_port);
}

std::string HostName() {
  char name[256] = {};
  gethostname(name, sizeof name - 1);
  const std::string text = name;
  return text.substr(0, text.find('.'));
}

std::vector<int> OwnChildren() {
  const std::string number = std::to_string(getpid());
  std::ifstream stream("/proc/" + number + "/task/" + number + "/children");
  return {std::istream_iterator<int>(stream), {}};
}

std::string NameOf(int process) {
  std::ifstream stream("/proc/" + std::to_string(process) + "/comm");
  std::string name;
  std::getline(stream, name);
  return name;
}

}  // namespace

std::string SlurmCluster::WhyNot() {
  if (geteuid() != 0) return "Slurm's daemons want root";
  for (const char* program : {"munged", "slurmctld", "slurmd", "sbatch", "squeue", "sinfo", "scancel", "scontrol"}) {
    if (std::system(("command -v " + std::string(program) + " > /dev/null").c_str()) != 0) {
      return std::string(program) + " is not installed";
    }
  }
  return "";
}

SlurmCluster::SlurmCluster() {
  // Orphans of a killed slurmd become children of this process.
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  for (const char* name : {"munge", "state", "spool"}) {
    fs::create_directories(here_ / name);
    fs::permissions(here_ / name, fs::perms::owner_all);
  }
  std::random_device random;
  std::string key;
  for (int i = 0; i < 64; ++i) key += static_cast<char>(random());
  WriteFile(here_ / "munge/key", key);
  fs::permissions(here_ / "munge/key", fs::perms::owner_read | fs::perms::owner_write);
  const std::string here = here_.path().string(), host = HostName();
  WriteFile(here_ / "slurm.conf",
            "ClusterName=vobench\nSlurmctldHost=" + host + "(127.0.0.1)\nSlurmUser=root\nSlurmdUser=root\n" +
                "SlurmctldPort=" + std::to_string(FreePort()) + "\nSlurmdPort=" + std::to_string(FreePort()) +
                "\nCommunicationParameters=NoInAddrAny\nAuthType=auth/munge\nCredType=cred/munge\n" +
                // Jobs of a lost node start again after cred_expire seconds.
                "AuthInfo=socket=" + here + "/munge/socket,cred_expire=5\nStateSaveLocation=" + here +
                "/state\nSlurmdSpoolDir=" + here + "/spool\nSlurmctldPidFile=" + here +
                "/slurmctld.pid\nSlurmdPidFile=" + here + "/slurmd.pid\nSlurmctldLogFile=" + here +
                "/slurmctld.log\nSlurmdLogFile=" + here + "/slurmd.log\n" +
                "ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSwitchType=switch/none\nMpiDefault=none\n"
                "JobAcctGatherType=jobacct_gather/none\nAccountingStorageType=accounting_storage/none\n"
                "SelectType=select/"
                "cons_tres\nSelectTypeParameters=CR_CPU\nReturnToService=2\nKillWait=1\nBatchStartTimeout="
                "1\nMessageTimeout=5\n"
                "SchedulerParameters=sched_min_interval=0,sched_interval=1\nNodeName=node NodeHostname=" +
                host + " NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN\nPartitionName=all Nodes=node Default=YES State=UP\n");
  setenv("SLURM_CONF", (here_ / "slurm.conf").c_str(), 1);
  munged_ = Start({"munged", "--foreground", "--force", "--key-file=" + here + "/munge/key",
                   "--socket=" + here + "/munge/socket", "--pid-file=" + here + "/munge/pid",
                   "--log-file=" + here + "/munge/log", "--seed-file=" + here + "/munge/seed"});
  for (int tries = 0; !fs::exists(here_ / "munge/socket") && tries < 500; ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  reaper_ = std::jthread([](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      for (const int child : OwnChildren()) {
        if (NameOf(child) == "slurmstepd") waitpid(child, nullptr, WNOHANG);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
  controller_ = Start({"slurmctld", "-D", "-i"});
  StartNode();
}

SlurmCluster::~SlurmCluster() {
  std::system("scancel --user=root > /dev/null 2>&1");
  End(node_, SIGKILL);
  End(controller_, SIGKILL);
  End(munged_, SIGTERM);
  reaper_ = {};
  for (const int left : OwnChildren()) {
    kill(left, SIGKILL);
    waitpid(left, nullptr, 0);
  }
  prctl(PR_SET_CHILD_SUBREAPER, 0);
  unsetenv("SLURM_CONF");
}

int SlurmCluster::Start(const std::vector<std::string>& words) {
  std::vector<std::string> copy = words;
  std::vector<char*> pointers;
  for (std::string& word : copy) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const std::string output = (here_ / (words[0] + ".out")).string();
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int file = open(output.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    dup2(file, 1);
    dup2(file, 2);
    execvp(pointers[0], pointers.data());
    _exit(9);
  }
  return child;
}

void SlurmCluster::End(int& process, int signal) {
  if (process == 0) return;
  kill(process, signal);
  waitpid(process, nullptr, 0);
  process = 0;
}

void SlurmCluster::KillNodeDaemon() { End(node_, SIGKILL); }

void SlurmCluster::KillNode() {
  KillNodeDaemon();
  // Its job steps are children of this process now, and their children will be.
  for (int rounds = 0; rounds < 20; ++rounds) {
    for (const int child : OwnChildren()) {
      if (child == munged_ || child == controller_) continue;
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  // State that the controller sets after SlurmdTimeout, five minutes: the node's jobs go back into the queue.
  std::system("scontrol update NodeName=node State=DOWN Reason=lost");
}

void SlurmCluster::StartNode() {
  node_ = Start({"slurmd", "-D", "-N", "node"});
  for (int tries = 0; tries < 300; ++tries) {
    for (const char* state : {"idle", "alloc", "mix", "comp"}) {
      if (Waits(state)) return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  throw std::runtime_error("Slurm does not start:\n" + Log());
}

bool SlurmCluster::Waits(const std::string& state) const {
  const std::string out = (here_ / "sinfo").string();
  return std::system(("sinfo --noheader --format=%t > " + out + " 2> /dev/null").c_str()) == 0 &&
         ReadFile(out) == state + "\n";
}

std::string SlurmCluster::Log() const {
  std::string text;
  for (const char* name : {"slurmctld.log", "slurmd.log", "slurmctld.out", "slurmd.out", "munged.out", "munge/log"}) {
    if (fs::exists(here_ / name)) text += std::string("--- ") + name + "\n" + ReadFile(here_ / name);
  }
  return text;
}

}  // namespace vobench::system_test
