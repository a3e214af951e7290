// Unparsed values: YAML for another reader.
#include "tools/base/settings/settings.h"
#include "tools/base/settings/state.h"

namespace settings {
namespace {

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

}  // namespace

bool Section::ReadRaw(const std::string& key, std::vector<RawYaml>& values) {
  Request& request = Register(key);
  if (request.element != nullptr) {
    values.clear();
    if (request.element->kind == Element::Kind::list) {
      for (const Element& item : request.element->items) values.push_back({item.text, Flow(item)});
    } else {
      values.push_back({request.element->text, Flow(*request.element)});
    }
    for (RawYaml& value : values) {
      if (value.text.empty()) value.text = value.yaml;
    }
  }
  std::string json;
  for (const RawYaml& value : values) json += (json.empty() ? "" : ", ") + value.yaml;
  return request.Keep("[" + json + "]", request.element != nullptr);
}

bool Section::ReadRaw(const std::string& key, std::vector<std::pair<std::string, std::string>>& entries) {
  Request& request = Register(key);
  bool good = request.element != nullptr;
  if (good && request.element->kind != Element::Kind::map) {
    state_->AddProblem(request.element->place,
                       "'" + request.path + "': expected keys with values, not " + Describe(*request.element));
    good = false;
  }
  if (good) {
    entries.clear();
    for (const Entry& entry : request.element->entries) entries.emplace_back(entry.key, Flow(entry.value));
  }
  std::string json;
  for (const auto& [name, value] : entries) json += (json.empty() ? "" : ", ") + QuoteJson(name) + ": " + value;
  return request.Keep("{" + json + "}", good);
}

}  // namespace settings
