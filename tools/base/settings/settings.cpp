#include "tools/base/settings/settings.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tools/base/settings/element.h"
#include "tools/base/settings/request.h"
#include "tools/base/settings/state.h"

namespace settings {

namespace {

std::string JsonList(const std::vector<std::string>& items) {
  std::string text = "[";
  for (const std::string& item : items) text += (text.size() > 1 ? ", " : "") + item;
  return text + "]";
}

std::string JsonNumbers(const double* values, std::size_t count) {
  std::vector<std::string> items;
  for (std::size_t i = 0; i < count; ++i) items.push_back(FormatNumber(values[i]));
  return JsonList(items);
}

bool Fail(State& state, const Element& element, const std::string& path, const std::string& problem) {
  state.AddProblem(element.place, "'" + path + "': " + problem);
  return false;
}

// The scalar's text, or a problem.
const std::string* Scalar(State& state, const Element& element, const std::string& path, const std::string& expected) {
  if (element.kind == Element::Kind::scalar) return &element.text;
  Fail(state, element, path, "expected " + expected + ", not " + Describe(element));
  return nullptr;
}

bool Number(State& state, const Element& element, const std::string& key, Unit unit, const Range& range,
            double& value) {
  const std::string* text = Scalar(state, element, key, "a number");
  std::string problem;
  return text && (ParseQuantity(*text, unit, range, value, problem) || Fail(state, element, key, problem));
}

// All items, so that each bad one is named.
bool Numbers(State& state, const Element& element, const std::string& key, Unit unit, const Range& range,
             std::vector<double>& values) {
  if (element.kind != Element::Kind::list)
    return Fail(state, element, key, "expected a list of numbers, not " + Describe(element));
  bool good = true;
  for (const Element& item : element.items) {
    double value = 0;
    good = Number(state, item, key, unit, range, value) && good;
    values.push_back(value);
  }
  return good;
}

}  // namespace

bool Section::Has(const std::string& key) const { return Find(key) != nullptr; }

const Element* Section::Find(const std::string& key) const {
  const Element* element = request_->element;
  return element && element->kind == Element::Kind::map ? element->Find(key) : nullptr;
}

Request& Section::Register(const std::string& key) {
  if (Request* known = request_->Find(key)) return *known;
  auto request = std::make_unique<Request>();
  request->kind = Request::Kind::absent;
  request->element = Find(key);
  request->place = request->element ? request->element->place : request_->place;
  request->path = request_->path.empty() ? key : request_->path + "." + key;
  request_->children.emplace_back(key, std::move(request));
  return *request_->children.back().second;
}

bool Section::Read(const std::string& key, double& value, Unit unit, const Range& range) {
  Request& request = Register(key);
  const bool good = request.element && Number(*state_, *request.element, request.path, unit, range, value);
  return request.Keep(FormatNumber(value), good);
}

template <class T>
bool Section::ReadWhole(const std::string& key, T& value, const Range& range) {
  Request& request = Register(key);
  bool good = false;
  if (request.element) {
    const std::string* text = Scalar(*state_, *request.element, request.path, "a whole number");
    std::string problem;
    good =
        text && (ParseInteger(*text, range, value, problem) || Fail(*state_, *request.element, request.path, problem));
  }
  return request.Keep(std::to_string(value), good);
}

bool Section::Read(const std::string& key, int& value, const Range& range) { return ReadWhole(key, value, range); }
bool Section::Read(const std::string& key, std::int64_t& value, const Range& range) {
  return ReadWhole(key, value, range);
}
bool Section::Read(const std::string& key, std::uint64_t& value, const Range& range) {
  return ReadWhole(key, value, range);
}

bool Section::Read(const std::string& key, bool& value) {
  Request& request = Register(key);
  bool good = false;
  if (request.element) {
    const std::string* text = Scalar(*state_, *request.element, request.path, "true or false");
    good = text && (*text == "true" || *text == "false");
    if (good) value = *text == "true";
    if (text && !good) Fail(*state_, *request.element, request.path, "'" + *text + "' is neither true nor false");
  }
  return request.Keep(value ? "true" : "false", good);
}

bool Section::Read(const std::string& key, std::string& value) {
  Request& request = Register(key);
  const std::string* text = request.element ? Scalar(*state_, *request.element, request.path, "a text") : nullptr;
  const bool good = text && !text->empty();
  if (good) value = *text;
  if (text && !good) Fail(*state_, *request.element, request.path, "is empty");
  return request.Keep(QuoteJson(value), good);
}

bool Section::Read(const std::string& key, std::vector<double>& value, Unit unit, const Range& range) {
  Request& request = Register(key);
  std::vector<double> read;
  const bool good = request.element && Numbers(*state_, *request.element, request.path, unit, range, read);
  if (good) value = std::move(read);
  return request.Keep(JsonNumbers(value.data(), value.size()), good);
}

bool Section::Read(const std::string& key, std::vector<std::string>& value) {
  Request& request = Register(key);
  bool good = request.element != nullptr;
  std::vector<std::string> read;
  if (request.element && request.element->kind != Element::Kind::list) {
    good = Fail(*state_, *request.element, request.path, "expected a list of texts, not " + Describe(*request.element));
  } else if (request.element) {
    for (const Element& item : request.element->items) {
      const std::string* text = Scalar(*state_, item, key, "a text");
      good = good && text;
      read.push_back(text ? *text : "");
    }
  }
  if (good) value = std::move(read);
  std::vector<std::string> items;
  items.reserve(value.size());
  for (const std::string& text : value) items.push_back(QuoteJson(text));
  return request.Keep(JsonList(items), good);
}

bool Section::ReadNumbers(const std::string& key, double* values, std::size_t count, Unit unit, const Range& range) {
  Request& request = Register(key);
  std::vector<double> read;
  bool good = request.element && Numbers(*state_, *request.element, request.path, unit, range, read);
  if (good && read.size() != count) {
    good = Fail(*state_, *request.element, request.path,
                "expected " + std::to_string(count) + " numbers, not " + std::to_string(read.size()));
  }
  if (good) std::copy(read.begin(), read.end(), values);
  return request.Keep(JsonNumbers(values, count), good);
}

bool Section::ReadName(const std::string& key, const std::vector<std::string>& names, std::size_t& index) {
  if (index >= names.size())
    throw std::logic_error("settings: the default of '" + request_->path + "." + key + "' has no name");
  Request& request = Register(key);
  bool good = false;
  if (request.element) {
    const std::string* text = Scalar(*state_, *request.element, request.path, "a name");
    const auto at = text ? std::find(names.begin(), names.end(), *text) : names.end();
    good = at != names.end();
    if (good) index = static_cast<std::size_t>(at - names.begin());
    if (text && !good)
      Fail(*state_, *request.element, request.path, "'" + *text + "' is not known" + Suggest(*text, names));
  }
  return request.Keep(QuoteJson(names[index]), good);
}

Section Section::Child(const std::string& key) {
  Request& request = Register(key);
  if (request.kind == Request::Kind::absent) {
    request.kind = Request::Kind::section;
    if (request.element && request.element->kind != Element::Kind::map &&
        request.element->kind != Element::Kind::null) {
      Fail(*state_, *request.element, request.path, "expected a section, not " + Describe(*request.element));
    }
  }
  return Section(state_, &request);
}

std::vector<Section> Section::List(const std::string& key, const std::string& shorthand) {
  Request& request = Register(key);
  if (request.kind == Request::Kind::absent) {
    request.kind = Request::Kind::list;
    if (request.element && request.element->kind != Element::Kind::list) {
      Fail(*state_, *request.element, request.path, "expected a list of sections, not " + Describe(*request.element));
    } else if (request.element) {
      for (const Element& item : request.element->items) {
        auto child = std::make_unique<Request>();
        child->element = &item;
        child->place = item.place;
        child->path = request.path + "." + std::to_string(request.children.size());
        if (item.kind == Element::Kind::scalar && !shorthand.empty()) {
          child->element = &state_->made.emplace_back(
              Element{Element::Kind::map, item.place, "", {}, {{shorthand, item.place, item}}});
        } else if (item.kind != Element::Kind::map) {
          Fail(*state_, item, request.path, "expected a list of sections, not of " + Describe(item));
        }
        request.children.emplace_back("", std::move(child));
      }
    }
  }
  std::vector<Section> sections;
  for (const auto& child : request.children) sections.push_back(Section(state_, child.second.get()));
  return sections;
}

void Section::Reject(const std::string& key, const std::string& message) {
  const Element* element = request_->element;
  Place place = request_->place;
  std::istringstream parts(key);
  for (std::string part; element && std::getline(parts, part, '.');) {
    element = element->kind == Element::Kind::map ? element->Find(part) : nullptr;
    if (element) place = element->place;
  }
  state_->AddProblem(place, message);
}

void Section::Reject(const std::vector<FieldProblem>& problems) {
  const std::string path = request_->path.empty() ? "" : request_->path + ".";
  for (const FieldProblem& problem : problems) Reject(problem.key, path + problem.key + " " + problem.message);
}

void Section::RequirePresent(const std::string& key) {
  Request& request = Register(key);
  if (request.element) return;
  request.kind = Request::Kind::absent;
  state_->AddProblem(request_->place, "missing key '" + request.path + "'");
}

bool Section::Renamed(const std::string& key, const std::string& now) {
  if (!Has(key)) return false;
  state_->AddProblem(Register(key).place, "'" + Register(key).path + "' has a new name: '" + now + "'");
  return true;
}

bool Section::Renamed(const std::string& key, const std::string& value, const std::string& now) {
  const Element* element = Find(key);
  if (!element || element->kind != Element::Kind::scalar || element->text != value) return false;
  state_->AddProblem(Register(key).place,
                     "'" + Register(key).path + "': '" + value + "' has a new name: '" + now + "'");
  return true;
}

void Section::Ignore(const std::string& key) { Register(key).kind = Request::Kind::ignored; }

void Section::IgnoreRest() { request_->ignores_rest = true; }

Document Document::FromFile(const std::filesystem::path& path, Dialect dialect) {
  const auto fail = [&](const std::string& why) { throw Error({{path.string(), 0, 0, why, {}}}); };
  std::error_code none;  // of a name that no system takes; what opens it says why
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
  if (state->root.kind != Element::Kind::map && state->root.kind != Element::Kind::null) {
    problems.push_back({name,
                        state->root.place.line,
                        state->root.place.column,
                        "expected keys with values, not " + Describe(state->root),
                        {}});
    throw Error(std::move(problems));
  }
  if (invalid) throw Error(std::move(problems));
  state->problems = std::move(problems);
  return Document(std::move(state));
}

void Document::Override(const std::string& key, const std::string& value) {
  if (state_->reading) throw std::logic_error("settings: Override after reading has begun");
  const Place place{"--set " + key, 0, 0, key};
  std::vector<std::string> parts;
  std::istringstream stream(key);
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  if (key.empty() || key.back() == '.' || std::find(parts.begin(), parts.end(), "") != parts.end()) {
    return state_->AddProblem(place, "not a key: expected words with dots between them");
  }
  Element* element = &state_->root;
  for (const std::string& part : parts) {
    if (element->kind == Element::Kind::null) element->kind = Element::Kind::map;
    if (element->kind == Element::Kind::list) {
      std::uint64_t index = 0;
      std::string problem;
      if (!ParseInteger(part, {}, index, problem)) return state_->AddProblem(place, "in a list: " + problem);
      if (index >= element->items.size()) {
        return state_->AddProblem(place, "there is no item " + part + " in a list of " +
                                             std::to_string(element->items.size()) + " (the first is 0)");
      }
      element = &element->items[index];
    } else if (element->kind == Element::Kind::map) {
      auto at =
          std::find_if(element->entries.begin(), element->entries.end(), [&](const Entry& e) { return e.key == part; });
      if (at == element->entries.end()) {
        Element null;
        null.place = place;
        element->entries.push_back({part, place, std::move(null)});
        at = element->entries.end() - 1;
      }
      element = &at->value;
    } else {
      return state_->AddProblem(place, "'" + part + "' cannot be set inside " + Describe(*element));
    }
  }
  *element = ParseYaml(value, place, state_->problems);
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
