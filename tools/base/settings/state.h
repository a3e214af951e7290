// State of a document while it is read: tree of the YAML text, and registry of the keys that were read. Private to
// tools/base/settings.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tools/base/settings/settings.h"

namespace settings {

struct Place {
  std::string file;
  int line = 0, column = 0;  // as in Problem
  std::string key = {};

  Problem AsProblem(std::string message) const { return {file, line, column, std::move(message), key}; }
};

struct Entry;

struct Element {
  enum class Kind { null, scalar, list, map };
  Kind kind = Kind::null;
  Place place;
  std::string text;            // of a scalar
  std::vector<Element> items;  // of a list
  std::vector<Entry> entries;  // of a map, in the order of the file

  const Element* Find(const std::string& key) const;  // of a map; null when there is none
};

struct Entry {
  std::string key;
  Place place;  // of the key
  Element value;
};

// "a list", "a section", ...: for messages.
std::string Describe(const Element& element);
// On one line, as YAML and JSON.
std::string Flow(const Element& element);
std::string QuoteJson(const std::string& text);

// Reads one YAML document (of OpenCV's dialect several, where all are maps); an empty text is a null element. Appends a
// problem for each duplicate key, alias, tag (of our dialect) and key that is not a scalar, and goes on; a syntax error
// ends it with one problem. Places have the lines of the text, or are `from` where that has a key (--set).
Element ParseYaml(const std::string& text, const Place& from, std::vector<Problem>& problems,
                  Dialect dialect = Dialect::ours);

struct Request {
  enum class Kind { section, list, value, absent, ignored };  // absent: required but not there, or without a default
  Kind kind = Kind::section;
  const Element* element = nullptr;                                        // in the file; null when it is not there
  Place place;                                                             // for error messages
  std::string path;                                                        // dotted; empty for the root
  std::string json;                                                        // of a value
  bool ignores_rest = false;                                               // of a section
  std::vector<std::pair<std::string, std::unique_ptr<Request>>> children;  // of a list: without keys

  Request* Find(const std::string& key) const;
  // Records a value that was read; returns `good`.
  bool Keep(std::string text, bool good) {
    kind = Kind::value;
    json = std::move(text);
    return good;
  }
};

struct State {
  Element root;
  Request requests;
  bool reading = false;
  std::vector<Problem> problems;
  std::deque<Element> made;  // sections that the file writes as a single word
};

// "a.b.c" as a, b, c.
std::vector<std::string> Split(const std::string& dotted);

// The number of insertions, deletions, replacements and swaps of neighbours that make b of a.
std::size_t EditDistance(const std::string& a, const std::string& b);
// "; did you mean 'x'?", or else "; known: a, b, c", the nearest first.
std::string Suggest(const std::string& given, const std::vector<std::string>& known);

}  // namespace settings
