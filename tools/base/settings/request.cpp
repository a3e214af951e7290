#include "tools/base/settings/request.h"

#include <algorithm>
#include <cstdio>

namespace settings {

Request* Request::Find(const std::string& key) const {
  const auto at = std::find_if(children.begin(), children.end(), [&](const auto& child) { return child.first == key; });
  return at == children.end() ? nullptr : at->second.get();
}

std::size_t EditDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

std::string Suggest(const std::string& given, const std::vector<std::string>& known) {
  if (known.empty()) return "; none is known here";
  constexpr std::size_t kLongestKey = 64;  // a hostile key is not measured
  std::vector<std::pair<std::size_t, std::string>> nearest;
  for (const std::string& candidate : known) {
    const bool begins = !given.empty() && (candidate.starts_with(given) || given.starts_with(candidate));
    nearest.emplace_back(begins                       ? 1
                         : given.size() > kLongestKey ? kLongestKey
                                                      : EditDistance(given, candidate),
                         candidate);
  }
  std::stable_sort(nearest.begin(), nearest.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
  const auto& [distance, best] = nearest.front();
  if (distance <= std::max<std::size_t>(2, best.size() / 3) && distance < best.size())
    return "; did you mean '" + best + "'?";
  std::string text = "; known: ";
  for (const auto& [d, candidate] : nearest) text += (&candidate != &nearest.front().second ? ", " : "") + candidate;
  return text;
}

void FindUnknownKeys(const Request& section, std::vector<Problem>& problems) {
  if (section.kind == Request::Kind::section && section.element && section.element->kind == Element::Kind::map) {
    std::vector<std::string> known;
    for (const auto& child : section.children) known.push_back(child.first);
    for (const Entry& entry : section.element->entries) {
      if (section.ignores_rest || section.Find(entry.key)) continue;
      problems.push_back({entry.place.file, entry.place.line, entry.place.column,
                          "unknown key '" + entry.key + "'" + Suggest(entry.key, known), entry.place.key});
    }
  }
  for (const auto& child : section.children) FindUnknownKeys(*child.second, problems);
}

std::string QuoteJson(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(byte));
      quoted += code;
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string ToJson(const Request& request, int depth) {
  if (request.kind == Request::Kind::value) return request.json;
  const bool list = request.kind == Request::Kind::list;
  const std::string indent(static_cast<std::size_t>(2 * depth + 2), ' ');
  std::string body;
  for (const auto& [key, child] : request.children) {
    if (child->kind == Request::Kind::absent || child->kind == Request::Kind::ignored) continue;
    body += (body.empty() ? "\n" : ",\n") + indent + (list ? "" : QuoteJson(key) + ": ") + ToJson(*child, depth + 1);
  }
  if (!body.empty()) body += "\n" + indent.substr(2);
  return (list ? "[" : "{") + body + (list ? "]" : "}");
}

}  // namespace settings
