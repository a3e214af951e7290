#include "tests/system/program.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace vobench::system_test {
namespace fs = std::filesystem;

std::string Program() { return VOBENCH_PROGRAM; }

std::string Quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

Outcome RunVobench(const std::vector<std::string>& arguments, const fs::path& where, const std::string& shell,
                   const std::string& after) {
  const TemporaryFolder output;
  std::string command = "cd " + Quoted(where.string()) + " && { " + shell + "\n" + Quoted(Program());
  for (const std::string& argument : arguments) command += " " + Quoted(argument);
  command += "\n" + after + "\n} > " + Quoted((output / "out").string()) + " 2> " + Quoted((output / "err").string()) +
             " < /dev/null";
  // std::system runs sh; ulimit and trap, which tests use, are in every shell.
  const int status = std::system(command.c_str());
  Outcome outcome;
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.out = ReadFile(output / "out");
  outcome.err = ReadFile(output / "err");
  return outcome;
}

int StartVobench(const std::vector<std::string>& arguments, const fs::path& where) {
  std::vector<std::string> words = {Program()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    if (chdir(where.c_str()) != 0 || freopen("/dev/null", "w", stderr) == nullptr ||
        freopen("/dev/null", "w", stdout) == nullptr) {
      _exit(9);
    }
    execv(pointers[0], pointers.data());
    _exit(9);
  }
  return child;
}

bool KillVobench(const std::vector<std::string>& arguments, const fs::path& where, const std::function<bool()>& now) {
  const pid_t child = StartVobench(arguments, where);
  int status = 0;
  while (!now()) {
    if (waitpid(child, &status, WNOHANG) == child) {
      if (status != 0) throw std::runtime_error("the program failed by itself");
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) != 0) throw std::runtime_error("the program failed by itself");
  return WIFSIGNALED(status);
}

std::string ReadFile(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

void WriteFile(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

std::map<std::string, std::string> Tree(const fs::path& folder) {
  std::map<std::string, std::string> tree;
  if (!fs::exists(folder)) return tree;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    tree[fs::relative(entry.path(), folder).string()] = entry.is_regular_file() ? ReadFile(entry.path()) : "";
  }
  return tree;
}

fs::path TinyScenario() { return fs::path(VOBENCH_TEST_SCENES) / "tiny.yaml"; }

}  // namespace vobench::system_test
