// Tree of a YAML text: keys and values with their places. Private to tools/base/settings.
#pragma once

#include <string>
#include <vector>

#include "tools/base/settings/dialect.h"
#include "tools/base/settings/problem.h"

namespace settings {

struct Place {
  std::string file;
  int line = 0, column = 0;  // as in Problem
  std::string key = {};
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

// Reads one YAML document (of OpenCV's dialect several, where all are maps); an empty text is a null element. Appends a
// problem for each duplicate key, alias, tag (of our dialect) and key that is not a scalar, and goes on; a syntax error
// ends it with one problem. Places have the lines of the text, or are `from` where that has a key (--set).
Element ParseYaml(const std::string& text, const Place& from, std::vector<Problem>& problems,
                  Dialect dialect = Dialect::ours);

}  // namespace settings
