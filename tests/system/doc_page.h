// Page of the docs: the commands in its code blocks, and the files that it shows.
// HTML comments before a block:
// <!-- file: NAME -->      the block is this file, written for the commands that follow
// <!-- slow -->            the commands take more than seconds: run by the slow tests
// <!-- not run: WHY -->    the commands are not run, for this reason
// A fenced block without a language is run whole; of an indented one, the lines that begin with `vobench`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vobench::system_test {

enum class Speed { quick, slow };

struct DocPage {
  std::string name;  // README.md, docs/scenario.md, ...
  // Shell text, in the order of the page; it also writes the files.
  std::string quick_script, whole_script;
  bool has_commands = false, has_slow_commands = false;
  std::vector<std::string> problems;  // commands neither run nor marked `not run`, unknown comments
  std::vector<std::string> links;     // targets as written
  std::vector<std::string> anchors;   // of its headings
};

std::filesystem::path ProjectRoot();
DocPage ParsePage(const std::string& name, const std::string& text);
DocPage ReadPage(const std::string& name);
// README.md, SECURITY.md, docs/*.md and docs/notes/*.md.
std::vector<std::string> PageNames();

// Runs the page's commands, up to the first that fails, in an empty folder with a link to the scenes. Returns the
// output of the shell, or "" if all succeed.
std::string WhatFails(const DocPage& page, Speed speed);

}  // namespace vobench::system_test
