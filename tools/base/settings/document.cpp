// Settings document: reading of the file, values set beside it, and the values read as JSON.
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tools/base/settings/state.h"

namespace settings {
namespace {

// Adds a problem for each key in the file that `section` or its children did not read, with the nearest valid key.
void FindUnknownKeys(const Request& section, std::vector<Problem>& problems) {
  if (section.kind == Request::Kind::section && section.element && section.element->kind == Element::Kind::map) {
    std::vector<std::string> known;
    for (const auto& child : section.children) known.push_back(child.first);
    for (const Entry& entry : section.element->entries) {
      if (section.ignores_rest || section.Find(entry.key)) continue;
      problems.push_back(entry.place.AsProblem("unknown key '" + entry.key + "'" + Suggest(entry.key, known)));
    }
  }
  for (const auto& child : section.children) FindUnknownKeys(*child.second, problems);
}

// Indented by `depth` times two spaces.
std::string ToJson(const Request& request, int depth = 0) {
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

}  // namespace

Request* Request::Find(const std::string& key) const {
  const auto at = std::find_if(children.begin(), children.end(), [&](const auto& child) { return child.first == key; });
  return at == children.end() ? nullptr : at->second.get();
}

std::vector<std::string> Split(const std::string& dotted) {
  std::vector<std::string> parts;
  std::istringstream stream(dotted);
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  return parts;
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
  constexpr std::size_t kLongestKey = 64;  // bound on the edit distance of hostile keys
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
  std::ranges::sort(nearest, {}, &std::pair<std::size_t, std::string>::second);
  std::string text = "; known: ";
  for (const auto& [d, candidate] : nearest) text += (&candidate != &nearest.front().second ? ", " : "") + candidate;
  return text;
}

Document Document::FromFile(const std::filesystem::path& path, Dialect dialect) {
  const auto fail = [&](const std::string& why) { throw Error({{path.string(), 0, 0, why, {}}}); };
  std::error_code none;  // for an invalid name; the reason is reported when it is opened
  if (std::filesystem::is_directory(path, none)) fail("is a folder, not a file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(std::string("cannot be read: ") + std::strerror(errno ? errno : EIO));
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad()) fail("cannot be read to its end");
  return FromText(text.str(), path.string(), dialect);
}

Document Document::FromText(const std::string& text, const std::string& name, Dialect dialect) {
  auto state = std::make_shared<State>();
  std::vector<Problem> problems;
  state->root = ParseYaml(text, Place{name}, problems, dialect);
  const bool invalid = std::any_of(problems.begin(), problems.end(), [](const Problem& problem) {
    return problem.message.starts_with("not valid YAML");
  });
  const bool has_keys = state->root.kind == Element::Kind::map || state->root.kind == Element::Kind::null;
  if (!has_keys) {
    problems.push_back(Place{name, state->root.place.line, state->root.place.column}.AsProblem(
        "expected keys with values, not " + Describe(state->root)));
  }
  if (invalid || !has_keys) throw Error(std::move(problems));
  state->problems = std::move(problems);
  return Document(std::move(state));
}

void Document::Override(const std::string& key, const std::string& value) {
  if (state_->reading) throw std::logic_error("settings: Override after reading has begun");
  const Place place{"--set " + key, 0, 0, key};
  const auto refuse = [&](std::string why) { state_->problems.push_back(place.AsProblem(std::move(why))); };
  const std::vector<std::string> parts = Split(key);
  if (key.empty() || key.back() == '.' || std::find(parts.begin(), parts.end(), "") != parts.end()) {
    return refuse("not a key: expected words with dots between them");
  }
  Element* element = &state_->root;
  for (const std::string& part : parts) {
    if (element->kind == Element::Kind::null) element->kind = Element::Kind::map;
    if (element->kind == Element::Kind::list) {
      std::uint64_t index = 0;
      std::string problem;
      if (!ParseInteger(part, {}, index, problem)) return refuse("in a list: " + problem);
      if (index >= element->items.size()) {
        return refuse("there is no item " + part + " in a list of " + std::to_string(element->items.size()) +
                      " (the first is 0)");
      }
      element = &element->items[index];
    } else if (element->kind == Element::Kind::map) {
      auto at = std::ranges::find(element->entries, part, &Entry::key);
      if (at == element->entries.end()) {
        Element null;
        null.place = place;
        element->entries.push_back({part, place, std::move(null)});
        at = element->entries.end() - 1;
      }
      element = &at->value;
    } else {
      return refuse("'" + part + "' cannot be set inside " + Describe(*element));
    }
  }
  *element = ParseYaml(value, place, state_->problems);
}

std::optional<std::uint64_t> Document::Peek(const std::string& key) const {
  const Element* element = state_->root.Find(key);
  std::uint64_t value = 0;
  std::string problem;
  const bool good =
      element && element->kind == Element::Kind::scalar && ParseInteger(element->text, {}, value, problem);
  return good ? std::optional(value) : std::nullopt;
}

Section Document::root() {
  if (!state_->reading) {
    state_->reading = true;
    state_->requests.element = &state_->root;
    state_->requests.place = Place{state_->root.place.file, 0, 0};
  }
  return Section(state_, &state_->requests);
}

void Document::ThrowIfBad() const {
  std::vector<Problem> problems = state_->problems;
  FindUnknownKeys(state_->requests, problems);
  if (problems.empty()) return;
  std::stable_sort(problems.begin(), problems.end(), [](const Problem& a, const Problem& b) {
    return std::pair(a.line, a.column) < std::pair(b.line, b.column);
  });
  throw Error(std::move(problems));
}

std::string Document::Resolved() const { return ToJson(state_->requests); }

}  // namespace settings
