// The built program, run as by a user, and what spoils its inputs.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace vobench::system_test {

// Where the program is.
std::string Program();

struct Outcome {
  int status = -1;  // exit status; 128 + n when signal n ended it
  std::string out;  // what it wrote to stdout ...
  std::string err;  // ... and to stderr
};

// Runs `vobench ARGUMENTS` in the folder `where`. `shell` is put before it in the same shell (limits, mounts), `after`
// behind.
Outcome RunVobench(const std::vector<std::string>& arguments, const std::filesystem::path& where,
                   const std::string& shell = "", const std::string& after = "");

// Starts the same without waiting, its output thrown away. Returns the process's number.
int StartVobench(const std::vector<std::string>& arguments, const std::filesystem::path& where);

// The same, ended by SIGKILL as soon as `now` says so. Whether it was at work until then; throws std::runtime_error
// where it failed by itself.
bool KillVobench(const std::vector<std::string>& arguments, const std::filesystem::path& where,
                 const std::function<bool()>& now);

using vobench_test::TemporaryFolder;

std::string ReadFile(const std::filesystem::path& path);
void WriteFile(const std::filesystem::path& path, const std::string& text);

// Every entry below a folder, hidden ones too: relative path -> content ("" for folders).
std::map<std::string, std::string> Tree(const std::filesystem::path& folder);

// One argument for the shell.
std::string Quoted(const std::string& text);

// scenes/tiny.yaml in a copy of the scenes with small textures.
std::filesystem::path TinyScenario();

}  // namespace vobench::system_test
