// Registry of the keys that were read, with their values. Private to tools/base/settings.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tools/base/settings/element.h"

namespace settings {

struct Request {
  enum class Kind { section, list, value, absent, ignored };  // absent: required but not there, or without a default
  Kind kind = Kind::section;
  const Element* element = nullptr;                                        // in the file; null when it is not there
  Place place;                                                             // where to complain
  std::string path;                                                        // dotted; empty for the root
  std::string json;                                                        // of a value
  bool ignores_rest = false;                                               // of a section
  std::vector<std::pair<std::string, std::unique_ptr<Request>>> children;  // of a list: without keys

  Request* Find(const std::string& key) const;
  // A value was given out; returns `good`.
  bool Keep(std::string text, bool good) {
    kind = Kind::value;
    json = std::move(text);
    return good;
  }
};

// Each key in the file that `section` or those below were not asked for, with the nearest that was.
void FindUnknownKeys(const Request& section, std::vector<Problem>& problems);

// Indented by `depth` times two spaces.
std::string ToJson(const Request& request, int depth = 0);
std::string QuoteJson(const std::string& text);

// The number of insertions, deletions, replacements and swaps of neighbours that make b of a.
std::size_t EditDistance(const std::string& a, const std::string& b);
// "; did you mean 'x'?", or else "; known: a, b, c", the nearest first.
std::string Suggest(const std::string& given, const std::vector<std::string>& known);

}  // namespace settings
