#include "tests/system/doc_page.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <regex>
#include <sstream>

#include "source_dir.h"
#include "tests/system/program.h"

namespace vobench::system_test {
namespace fs = std::filesystem;
namespace {

// Comment before a block.
struct Directive {
  std::string file;
  bool slow = false, not_run = false;
};

struct Block {
  Directive directive;
  bool fenced = false;
  std::string language;
  std::vector<std::string> lines;
};

bool IsCommand(const std::string& line) {
  for (const char* program : {"vobench ", "tools/", "build/", "cmake ", "ctest "}) {
    if (line.starts_with(program)) return true;
  }
  return false;
}

std::string Joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

// The commands of an indented block: lines that begin with vobench, and those that a backslash continues.
std::string CommandsOf(const Block& block) {
  if (block.fenced) return block.language.empty() ? Joined(block.lines) : "";
  std::string text;
  bool goes_on = false;
  for (const std::string& line : block.lines) {
    if (!goes_on && !line.starts_with("vobench ")) continue;
    text += line + "\n";
    goes_on = line.ends_with('\\');
  }
  return text;
}

void Add(const Block& block, DocPage& page) {
  if (block.lines.empty() || block.directive.not_run) return;
  if (!block.directive.file.empty()) {
    const std::string text =
        "cat > " + Quoted(block.directive.file) + " <<'END_OF_FILE'\n" + Joined(block.lines) + "END_OF_FILE\n";
    page.quick_script += text;
    page.whole_script += text;
    return;
  }
  for (const std::string& line : block.lines) {
    if (block.language.empty() && IsCommand(line) && !line.starts_with("vobench "))
      page.problems.push_back("is not run, and does not say why: " + line);
  }
  const std::string commands = CommandsOf(block);
  if (commands.empty()) return;
  page.whole_script += commands;
  page.has_commands = page.has_commands || !block.directive.slow;
  page.has_slow_commands = page.has_slow_commands || block.directive.slow;
  if (!block.directive.slow) page.quick_script += commands;
}

// Anchor of a heading, as by GitHub.
std::string AnchorOf(const std::string& heading) {
  std::string anchor;
  for (const unsigned char c : heading) {
    if (std::isalnum(c) || c == '-' || c == '_' || c >= 0x80) anchor += static_cast<char>(std::tolower(c));
    if (c == ' ') anchor += '-';
  }
  return anchor;
}

}  // namespace

fs::path ProjectRoot() { return VOBENCH_SOURCE_DIR; }

DocPage ReadPage(const std::string& name) { return ParsePage(name, ReadFile(ProjectRoot() / name)); }

DocPage ParsePage(const std::string& name, const std::string& text) {
  DocPage page;
  page.name = name;
  Block block;
  Directive next;
  const auto finish = [&] {
    Add(block, page);
    if (!block.lines.empty()) next = {};
    block = {};
  };
  std::istringstream lines(text);
  bool fence = false;
  bool after_blank = true;
  const std::regex comment("<!-- (file: (\\S+)|slow|not run: .+) -->"), link("\\]\\(([^)\\s]+)\\)");
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (line.starts_with("```")) {
      finish();
      fence = !fence;
      if (fence) block = {next, true, line.substr(3), {}};
      if (fence) next = {};
      continue;
    }
    const bool indented = !fence && line.starts_with("    ") && (after_blank || !block.lines.empty());
    after_blank = line.empty();
    if (fence || indented) {
      if (!fence && block.lines.empty()) block = {next, false, "", {}};
      block.lines.push_back(fence ? line : line.substr(4));
      continue;
    }
    if (line.empty()) {
      if (!block.lines.empty()) block.lines.push_back("");
      continue;
    }
    finish();
    if (std::regex_match(line, match, comment)) {
      next = {};
      next.file = match[2];
      next.slow = match[1] == "slow";
      next.not_run = match[1].str().starts_with("not run: ");
    } else if (line.starts_with("<!--") && line.find("run") != std::string::npos) {
      page.problems.push_back("is no comment that the test knows: " + line);
    }
    if (line.starts_with("#")) page.anchors.push_back(AnchorOf(line.substr(line.find_first_not_of("# "))));
    for (std::sregex_iterator at(line.begin(), line.end(), link), end; at != end; ++at) page.links.push_back((*at)[1]);
  }
  finish();
  return page;
}

std::vector<std::string> PageNames() {
  std::vector<std::string> names = {"README.md", "SECURITY.md"};
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(ProjectRoot() / "docs")) {
    if (entry.path().extension() == ".md") names.push_back(fs::relative(entry.path(), ProjectRoot()).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string WhatFails(const DocPage& page, Speed speed) {
  const TemporaryFolder here;
  fs::create_directory_symlink(ProjectRoot() / "scenes", here / "scenes");
  WriteFile(here / "page.sh", "set -e\nexport PATH=" + Quoted(fs::path(Program()).parent_path().string()) +
                                  ":$PATH\nmkdir -p out\nset -x\n" +
                                  (speed == Speed::slow ? page.whole_script : page.quick_script));
  const std::string command = "cd " + Quoted(here.path().string()) + " && bash page.sh > said.txt 2>&1 < /dev/null";
  return std::system(command.c_str()) == 0 ? "" : "failed:\n" + ReadFile(here / "said.txt");
}

}  // namespace vobench::system_test
