// Tags of XML and their attributes, without entities. Private to sim/world.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace sim {

inline constexpr std::string_view kBlanks = " \t\r\n";

// Without the blanks at its beginning.
inline std::string_view Trimmed(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(kBlanks), text.size()));
}

// An attribute's value in a tag; empty: none.
inline std::string_view Attribute(std::string_view tag, const std::string& name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    std::string_view rest = Trimmed(tag.substr(at + name.size()));
    if (at == 0 || kBlanks.find(tag[at - 1]) == std::string_view::npos || !rest.starts_with('=')) continue;
    rest = Trimmed(rest.substr(1));
    if (rest.empty() || (rest[0] != '"' && rest[0] != '\'')) continue;
    return rest.substr(1, rest.find(rest[0], 1) - 1);
  }
  return {};
}

// Whether it is a tag of this name.
inline bool IsTag(std::string_view tag, std::string_view name) {
  return tag.starts_with(name) && tag.size() > name.size() && kBlanks.find(tag[name.size()]) != std::string_view::npos;
}

// Without those in comments.
template <class Call>
void ForEachTag(std::string_view text, const Call& call) {
  for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at + 1)) {
    if (text.substr(at).starts_with("<!--")) {
      at = std::min(text.find("-->", at), text.size());
    } else {
      call(text.substr(at, text.find('>', at) - at));
    }
  }
}

}  // namespace sim
