#include "tools/base/settings/settings.h"

#include <algorithm>
#include <stdexcept>

#include "tools/base/settings/state.h"

namespace settings {
namespace {

std::string Json(double value) { return FormatNumber(value); }
std::string Json(bool value) { return value ? "true" : "false"; }
std::string Json(const std::string& value) { return QuoteJson(value); }
template <std::integral T>
std::string Json(T value) {
  return std::to_string(value);
}
template <class T>
std::string Json(const std::vector<T>& values) {
  std::string text = "[";
  for (const T& value : values) text += (text.size() > 1 ? ", " : "") + Json(value);
  return text + "]";
}

// A value of the file; `path` names it in problems.
struct Value {
  State& state;
  const Element& element;
  const std::string& path;

  bool Fail(const std::string& problem) const {
    state.problems.push_back(element.place.AsProblem("'" + path + "': " + problem));
    return false;
  }
  bool Is(Element::Kind kind, const std::string& expected) const {
    return element.kind == kind || Fail("expected " + expected + ", not " + Describe(element));
  }
  bool IsScalar(const std::string& expected) const { return Is(Element::Kind::scalar, expected); }

  bool Number(Unit unit, const Range& range, double& value) const {
    std::string problem;
    return IsScalar("a number") && (ParseQuantity(element.text, unit, range, value, problem) || Fail(problem));
  }
  // Reads all items, so that each invalid one is named.
  template <class T, class Read>
  bool Items(const std::string& expected, std::vector<T>& values, const Read& read) const {
    values.clear();
    bool good = Is(Element::Kind::list, expected);
    for (const Element& item : element.items) good = read(Value{state, item, path}, values.emplace_back()) && good;
    return good;
  }
  bool Numbers(Unit unit, const Range& range, std::vector<double>& values) const {
    return Items("a list of numbers", values,
                 [&](const Value& item, double& value) { return item.Number(unit, range, value); });
  }
};

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

template <class T, class Parse>
bool Section::ReadBy(const std::string& key, T& value, const Parse& parse) {
  Request& request = Register(key);
  T read = value;
  const bool good = request.element && parse(Value{*state_, *request.element, request.path}, read);
  if (good) value = std::move(read);
  return request.Keep(Json(value), good);
}

bool Section::Read(const std::string& key, double& value, Unit unit, const Range& range) {
  return ReadBy(key, value, [&](const Value& given, double& read) { return given.Number(unit, range, read); });
}

template <std::integral T>
bool Section::Read(const std::string& key, T& value, const Range& range) {
  return ReadBy(key, value, [&](const Value& given, T& read) {
    std::string problem;
    return given.IsScalar("a whole number") &&
           (ParseInteger(given.element.text, range, read, problem) || given.Fail(problem));
  });
}
template bool Section::Read(const std::string&, int&, const Range&);
template bool Section::Read(const std::string&, std::int64_t&, const Range&);
template bool Section::Read(const std::string&, std::uint64_t&, const Range&);

bool Section::Read(const std::string& key, bool& value) {
  return ReadBy(key, value, [](const Value& given, bool& read) {
    const std::string& text = given.element.text;
    read = text == "true";
    return given.IsScalar("true or false") &&
           (read || text == "false" || given.Fail("'" + text + "' is neither true nor false"));
  });
}

bool Section::Read(const std::string& key, std::string& value) {
  return ReadBy(key, value, [](const Value& given, std::string& read) {
    read = given.element.text;
    return given.IsScalar("a text") && (!read.empty() || given.Fail("is empty"));
  });
}

bool Section::Read(const std::string& key, std::vector<double>& value, Unit unit, const Range& range) {
  return ReadBy(key, value, [&](const Value& given, auto& read) { return given.Numbers(unit, range, read); });
}

bool Section::Read(const std::string& key, std::vector<std::string>& value) {
  return ReadBy(key, value, [](const Value& given, auto& read) {
    return given.Items("a list of texts", read, [](const Value& item, std::string& text) {
      text = item.element.text;
      return item.IsScalar("a text");
    });
  });
}

bool Section::Read(const std::string& key, std::span<double> values, Unit unit, const Range& range) {
  std::vector<double> value(values.begin(), values.end());
  const bool good = ReadBy(key, value, [&](const Value& given, std::vector<double>& read) {
    return given.Numbers(unit, range, read) &&
           (read.size() == values.size() ||
            given.Fail("expected " + std::to_string(values.size()) + " numbers, not " + std::to_string(read.size())));
  });
  std::ranges::copy(value, values.begin());
  return good;
}

bool Section::ReadName(const std::string& key, const std::vector<std::string>& names, std::size_t& index) {
  if (index >= names.size())
    throw std::logic_error("settings: the default of '" + request_->path + "." + key + "' has no name");
  std::string name = names[index];
  const bool good = ReadBy(key, name, [&](const Value& given, std::string& read) {
    read = given.element.text;
    return given.IsScalar("a name") && (std::ranges::find(names, read) != names.end() ||
                                        given.Fail("'" + read + "' is not known" + Suggest(read, names)));
  });
  index = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
  return good;
}

bool Section::ReadRaw(const std::string& key, std::vector<RawYaml>& values) {
  Request& request = Register(key);
  if (const Element* element = request.element) {
    values.clear();
    const auto add = [&](const Element& item) {
      const std::string yaml = Flow(item);
      values.push_back({item.text.empty() ? yaml : item.text, yaml});
    };
    if (element->kind == Element::Kind::list) {
      std::ranges::for_each(element->items, add);
    } else {
      add(*element);
    }
  }
  std::string json;
  for (const RawYaml& value : values) json += (json.empty() ? "" : ", ") + value.yaml;
  return request.Keep("[" + json + "]", request.element != nullptr);
}

bool Section::ReadRaw(const std::string& key, std::vector<std::pair<std::string, std::string>>& entries) {
  Request& request = Register(key);
  const bool good =
      request.element && Value{*state_, *request.element, request.path}.Is(Element::Kind::map, "keys with values");
  if (good) {
    entries.clear();
    for (const Entry& entry : request.element->entries) entries.emplace_back(entry.key, Flow(entry.value));
  }
  std::string json;
  for (const auto& [name, value] : entries) json += (json.empty() ? "" : ", ") + QuoteJson(name) + ": " + value;
  return request.Keep("{" + json + "}", good);
}

Section Section::Child(const std::string& key) {
  Request& request = Register(key);
  if (request.kind == Request::Kind::absent) {
    request.kind = Request::Kind::section;
    if (request.element && request.element->kind != Element::Kind::null)
      Value{*state_, *request.element, request.path}.Is(Element::Kind::map, "a section");
  }
  return Section(state_, &request);
}

std::vector<Section> Section::List(const std::string& key, const std::string& shorthand) {
  Request& request = Register(key);
  if (request.kind == Request::Kind::absent) {
    request.kind = Request::Kind::list;
    if (request.element &&
        Value{*state_, *request.element, request.path}.Is(Element::Kind::list, "a list of sections")) {
      for (const Element& item : request.element->items) {
        auto child = std::make_unique<Request>();
        child->element = &item;
        child->place = item.place;
        child->path = request.path + "." + std::to_string(request.children.size());
        if (item.kind == Element::Kind::scalar && !shorthand.empty()) {
          child->element = &state_->made.emplace_back(
              Element{Element::Kind::map, item.place, "", {}, {{shorthand, item.place, item}}});
        } else if (item.kind != Element::Kind::map) {
          Value{*state_, item, request.path}.Fail("expected a list of sections, not of " + Describe(item));
        }
        request.children.emplace_back("", std::move(child));
      }
    }
  }
  std::vector<Section> sections;
  for (const auto& child : request.children) sections.push_back(Section(state_, child.second.get()));
  return sections;
}

const Place& Section::PlaceOf(const std::string& key) const {
  const Element* element = request_->element;
  const Place* place = &request_->place;
  if (element && element->kind == Element::Kind::map && element->Find(key)) return element->Find(key)->place;  // "a.b"
  for (const std::string& part : Split(key)) {
    element = element && element->kind == Element::Kind::map ? element->Find(part) : nullptr;
    if (element) place = &element->place;
  }
  return *place;
}

std::string Section::Where(const std::string& key) const {
  const std::string text = ToString(PlaceOf(key).AsProblem(""));
  return text.substr(0, text.rfind(": "));
}

void Section::Reject(const std::string& key, const std::string& message) {
  state_->problems.push_back(PlaceOf(key).AsProblem(message));
}

void Section::Reject(const std::vector<FieldProblem>& problems) {
  const std::string path = request_->path.empty() ? "" : request_->path + ".";
  for (const FieldProblem& problem : problems) Reject(problem.key, path + problem.key + " " + problem.message);
}

void Section::RequirePresent(const std::string& key) {
  Request& request = Register(key);
  if (request.element) return;
  request.kind = Request::Kind::absent;
  state_->problems.push_back(request_->place.AsProblem("missing key '" + request.path + "'"));
}

bool Section::Renamed(const std::string& key, const std::string& now) {
  if (!Has(key)) return false;
  Reject(key, "'" + Register(key).path + "' has a new name: '" + now + "'");
  return true;
}

bool Section::Renamed(const std::string& key, const std::string& value, const std::string& now) {
  const Element* element = Find(key);
  if (!element || element->kind != Element::Kind::scalar || element->text != value) return false;
  Reject(key, "'" + Register(key).path + "': '" + value + "' has a new name: '" + now + "'");
  return true;
}

void Section::Ignore(const std::string& key) { Register(key).kind = Request::Kind::ignored; }

void Section::IgnoreRest() { request_->ignores_rest = true; }

}  // namespace settings
