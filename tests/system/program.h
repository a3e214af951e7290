// The built program, run as by a user, and files for its tests.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace vobench::system_test {

// Path of the program.
std::string Program();

struct Outcome {
  int status = -1;  // exit status; 128 + n for an end by signal n
  std::string out;  // stdout
  std::string err;  // stderr
};

// Runs `vobench ARGUMENTS` in the folder `where`. `shell` and `after`: text before and after it in the same shell
// (limits, mounts).
Outcome RunVobench(const std::vector<std::string>& arguments, const std::filesystem::path& where,
                   const std::string& shell = "", const std::string& after = "");

// Starts the same without waiting, its output discarded. Returns the process id.
int StartVobench(const std::vector<std::string>& arguments, const std::filesystem::path& where);

// The same, ended by SIGKILL as soon as now() is true. Returns whether the signal ended it. Throws std::runtime_error
// if the program failed by itself.
bool KillVobench(const std::vector<std::string>& arguments, const std::filesystem::path& where,
                 const std::function<bool()>& now);

using vobench_test::TemporaryFolder;

std::string ReadFile(const std::filesystem::path& path);
void WriteFile(const std::filesystem::path& path, const std::string& text);

// Every entry below a folder, hidden ones too: relative path -> content ("" for folders).
std::map<std::string, std::string> Tree(const std::filesystem::path& folder);

// Argument, quoted for the shell.
std::string Quoted(const std::string& text);

// scenes/tiny.yaml in a copy of the scenes with small textures.
std::filesystem::path TinyScenario();

}  // namespace vobench::system_test
