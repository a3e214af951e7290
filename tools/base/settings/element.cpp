#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <utility>

#include "tools/base/settings/state.h"
#include "tools/base/text.h"

namespace settings {
namespace {

// Builds the tree from the parser's events. Aliases are rejected: expanding them can take exponential space.
class Builder : public YAML::EventHandler {
 public:
  Builder(Place from, Dialect dialect, std::vector<Problem>& problems)
      : from_(std::move(from)), dialect_(dialect), problems_(problems) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { Add(MakeElement(Element::Kind::null, mark)); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    AddProblem(PlaceOf(mark), "aliases (*name) are not supported: write the value out");
    Add(MakeElement(Element::Kind::null, mark));
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, const std::string& value) override {
    CheckTag(mark, tag);
    Element element = MakeElement(Element::Kind::scalar, mark);
    element.text = value;
    const bool plain = tag == "?" || tag.empty();
    if (plain && (value.empty() || value == "~" || value == "null")) element.kind = Element::Kind::null;
    Add(std::move(element));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    CheckTag(mark, tag);
    open_.push_back({MakeElement(Element::Kind::list, mark), {}, false});
  }
  void OnSequenceEnd() override { Close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, YAML::EmitterStyle::value) override {
    CheckTag(mark, tag);
    open_.push_back({MakeElement(Element::Kind::map, mark), {}, false});
  }
  void OnMapEnd() override { Close(); }

  Place PlaceOf(const YAML::Mark& mark) const {
    return from_.key.empty() && mark.line >= 0 ? Place{from_.file, mark.line + 1, mark.column + 1} : from_;
  }

  Element TakeRoot() { return std::move(root_); }

  // Joins a second document: keys appended by cv::FileStorage, where both are maps; or the empty document that ends a
  // message of ROS: once, as yaml-cpp (0.7) finds empty ones endlessly in some malformed texts.
  bool Join(Builder& next) {
    if (next.root_.kind == Element::Kind::null) return !std::exchange(has_empty_, true);
    if (root_.kind != Element::Kind::map || next.root_.kind != Element::Kind::map) return false;
    for (Entry& entry : next.root_.entries) {
      if (!root_.Find(entry.key)) root_.entries.push_back(std::move(entry));
    }
    return true;
  }

 private:
  struct Open {
    Element element;
    Element key;  // of a map: the key that waits for its value
    bool has_key = false;
  };

  Element MakeElement(Element::Kind kind, const YAML::Mark& mark) const {
    Element element;
    element.kind = kind;
    element.place = PlaceOf(mark);
    return element;
  }
  void AddProblem(const Place& place, std::string message) { problems_.push_back(place.AsProblem(std::move(message))); }
  void CheckTag(const YAML::Mark& mark, const std::string& tag) {
    if (dialect_ == Dialect::opencv || tag == "?" || tag == "!" || tag.empty()) return;
    AddProblem(PlaceOf(mark), "tags (" + tag + ") are not supported");
  }
  void Close() {
    Element element = std::move(open_.back().element);
    open_.pop_back();
    Add(std::move(element));
  }
  void Add(Element element) {
    if (open_.empty()) {
      root_ = std::move(element);
      return;
    }
    Open& parent = open_.back();
    if (parent.element.kind == Element::Kind::list) {
      parent.element.items.push_back(std::move(element));
    } else if (!parent.has_key) {
      if (element.kind != Element::Kind::scalar)
        AddProblem(element.place, "a key must be a plain word, not " + Describe(element));
      parent.key = std::move(element);
      parent.has_key = true;
    } else {
      parent.has_key = false;
      if (element.kind == Element::Kind::null) element.place = parent.key.place;  // the parser's mark is after the line
      if (parent.key.kind != Element::Kind::scalar) return;
      if (const Element* first = parent.element.Find(parent.key.text)) {
        std::string message = "duplicate key '" + parent.key.text + "'";
        if (first->place.line > 0) message += ", given already on line " + std::to_string(first->place.line);
        AddProblem(parent.key.place, std::move(message));
        return;
      }
      parent.element.entries.push_back({std::move(parent.key.text), parent.key.place, std::move(element)});
    }
  }

  Place from_;
  Dialect dialect_;
  std::vector<Problem>& problems_;
  std::vector<Open> open_;
  Element root_;
  bool has_empty_ = false;  // an empty document after the first
};

}  // namespace

const Element* Element::Find(const std::string& key) const {
  const auto at = std::ranges::find(entries, key, &Entry::key);
  return at == entries.end() ? nullptr : &at->value;
}

std::string Describe(const Element& element) {
  switch (element.kind) {
    case Element::Kind::null:
      return "nothing";
    case Element::Kind::scalar:
      return "'" + (element.text.size() > 80 ? element.text.substr(0, 77) + "..." : element.text) + "'";
    case Element::Kind::list:
      return "a list";
    case Element::Kind::map:
      return "a section";
  }
  return "nothing";
}

std::string Flow(const Element& element) {
  std::string text;
  switch (element.kind) {
    case Element::Kind::null:
      return "null";
    case Element::Kind::scalar:
      return QuoteJson(element.text);
    case Element::Kind::list:
      for (const Element& item : element.items) text += (text.empty() ? "" : ", ") + Flow(item);
      return "[" + text + "]";
    case Element::Kind::map:
      for (const Entry& entry : element.entries) {
        text += (text.empty() ? "" : ", ") + QuoteJson(entry.key) + ": " + Flow(entry.value);
      }
      return "{" + text + "}";
  }
  return text;
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

Element ParseYaml(const std::string& text, const Place& from, std::vector<Problem>& problems, Dialect dialect) {
  Builder builder(from, dialect, problems);
  const auto fail = [&](const std::string& message, const YAML::Mark& mark = YAML::Mark::null_mark()) {
    problems.push_back(builder.PlaceOf(mark).AsProblem(message));
  };
  try {
    const std::string unmarked(base::WithoutMark(text));
    const bool directive = dialect == Dialect::opencv && unmarked.starts_with('%');
    std::istringstream stream(directive ? "#" + unmarked.substr(1) : unmarked);
    YAML::Parser parser(stream);
    bool more = parser.HandleNextDocument(builder);
    while (more) {
      Builder rest(from, dialect, problems);
      more = parser.HandleNextDocument(rest);
      if (!more || (dialect == Dialect::opencv && builder.Join(rest))) continue;
      fail("holds more than one YAML document");
      break;
    }
  } catch (const YAML::DeepRecursion&) {
    fail("not valid YAML: nested too deeply");
  } catch (const YAML::Exception& error) {
    fail("not valid YAML: " + error.msg, error.mark);
  }
  Element root = builder.TakeRoot();
  if (root.place.file.empty()) root.place = from;
  return root;
}

}  // namespace settings
