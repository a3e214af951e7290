// A page of the docs as a test sees it: the commands in its code blocks, and the files that it shows.
// Before a block may stand, as a comment that readers do not see:
// <!-- file: NAME -->      the block is this file; it is there for the commands that follow
// <!-- slow -->            its commands take more than seconds: they run in the slow tests
// <!-- not run: WHY -->    its commands are not run, and why
// A fenced block without a language is run whole; of an indented one, the lines that begin with `vobench`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vobench::system_test {

enum class Speed { quick, slow };

struct DocPage {
  std::string name;  // README.md, docs/scenario.md, ...
  // Shell text, in the order of the page: files are written by it, too.
  std::string quick_script, whole_script;
  bool has_commands = false, has_slow_commands = false;
  std::vector<std::string> problems;  // commands that can be run by nobody and do not say why, unknown comments
  std::vector<std::string> links;     // targets, as they are written
  std::vector<std::string> anchors;   // of its headings
};

std::filesystem::path ProjectRoot();
DocPage ParsePage(const std::string& name, const std::string& text);
DocPage ReadPage(const std::string& name);
// README.md, SECURITY.md, docs/*.md and docs/notes/*.md.
std::vector<std::string> PageNames();

// Runs the page's commands in an empty folder beside a link to the scenes, as a reader would, until one fails. Nothing where all
// work, else what the shell said.
std::string WhatFails(const DocPage& page, Speed speed);

}  // namespace vobench::system_test
