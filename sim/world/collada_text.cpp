#include "sim/world/collada_text.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "tools/base/text.h"

namespace sim {
namespace {

bool IsDigits(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
}

constexpr std::string_view kBlanks = " \t\r\n";

// Without the blanks at its beginning.
std::string_view Trimmed(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(kBlanks), text.size()));
}

// An attribute's value in a tag; empty: none.
std::string_view Attribute(std::string_view tag, const std::string& name) {
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
bool IsTag(std::string_view tag, std::string_view name) {
  return tag.starts_with(name) && tag.size() > name.size() && kBlanks.find(tag[name.size()]) != std::string_view::npos;
}

template <class Call>
void ForEachTag(std::string_view text, const Call& call) {
  for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at + 1)) {
    call(text.substr(at, text.find('>', at) - at));
  }
}

// Texture coordinate sets: that of each bound name, and the place of each among those of its polygons, where they have
// several.
struct UvSets {
  std::map<std::string, std::string, std::less<>> of_name;
  bool has_two = false;  // of one name, in different instances
  std::map<std::string, std::size_t, std::less<>> place;
};

UvSets SetsOf(std::string_view text) {
  UvSets sets;
  const auto by_number = [](std::string_view a, std::string_view b) {
    return std::pair(a.size(), a) < std::pair(b.size(), b);
  };
  std::set<std::string_view, decltype(by_number)> here;
  ForEachTag(text, [&](std::string_view tag) {
    if (IsTag(tag, "<bind_vertex_input") && Attribute(tag, "input_semantic") == "TEXCOORD") {
      const std::string_view set = Attribute(tag, "input_set");
      const auto [known, is_new] = sets.of_name.try_emplace(std::string(Attribute(tag, "semantic")), set);
      sets.has_two = sets.has_two || (!is_new && known->second != set);
    }
    if (IsTag(tag, "<input")) {
      const std::string_view set = Attribute(tag, "set");
      if (Attribute(tag, "semantic") == "TEXCOORD") here.insert(set.empty() ? "0" : set);
      return;
    }
    std::size_t place = 0;
    for (const std::string_view set : here) {
      if (here.size() > 1) sets.place.try_emplace(std::string(set), place++);
    }
    here.clear();
  });
  return sets;
}

}  // namespace

std::string ColladaForAssimp(std::string_view text, std::vector<std::string>& warnings) {
  const UvSets sets = SetsOf(text);
  std::set<std::string> unbound;
  std::string out;
  out.reserve(text.size());
  bool skips = false;
  const auto append = [&](std::string_view part) {
    for (const char c : part) {
      if (c == '<') out.erase(out.find_last_not_of(kBlanks) + 1);
      skips = c == '>' || (skips && std::isspace(static_cast<unsigned char>(c)) != 0);
      if (!skips || c == '>') out += c;
    }
  };
  std::size_t done = 0;
  bool has_diffuse = false, has_emission = false;  // of the shader at hand
  ForEachTag(text, [&](std::string_view tag) {
    has_diffuse = has_diffuse || tag.starts_with("<diffuse");
    has_emission = has_emission || tag.starts_with("<emission");
    for (const std::string shader : {"constant", "lambert", "phong", "blinn"}) {
      if (tag.starts_with("<" + shader)) has_diffuse = has_emission = false;
      if (!tag.starts_with("</" + shader) || has_diffuse || !has_emission) continue;
      const auto at = static_cast<std::size_t>(tag.data() - text.data());
      append(text.substr(done, at - done));
      append("<diffuse><color>0 0 0 1</color></diffuse>");  // assimp's default is 0.6
      done = at;
    }
    const std::string_view name = IsTag(tag, "<texture") ? Attribute(tag, "texcoord") : "";
    if (name.empty()) return;
    const auto at = static_cast<std::size_t>(name.data() - text.data());
    const auto bound = sets.of_name.find(name);
    const std::string_view set = bound != sets.of_name.end() ? bound->second : IsDigits(name) ? name : "";
    const auto place = sets.place.find(set);
    append(text.substr(done, at - done));
    append(place == sets.place.end() ? "0" : std::to_string(place->second));
    done = at + name.size();
    if (set.empty() && !sets.place.empty()) unbound.insert("'" + std::string(name) + "'");
  });
  append(text.substr(done));
  if (sets.has_two) warnings.push_back("a name of texture coordinates is bound to several sets: the first is used");
  const auto has = [&](std::string_view part) { return text.find(part) != std::string_view::npos; };
  for (const std::string wrap : {"CLAMP", "MIRROR", "BORDER", "NONE"})
    if (has("<wrap_s>" + wrap) || has("<wrap_t>" + wrap))
      warnings.push_back("a texture whose wrapping is " + wrap + " repeats");
  if (has("=\"RGB_ZERO\"")) warnings.push_back("transparency of the kind RGB_ZERO is taken for A_ONE");
  if (has("<param ref=")) warnings.push_back("colours that are parameters (<param ref>) are not read");
  if (!unbound.empty())
    warnings.push_back("texture coordinates that are bound to no set (bind_vertex_input) are those of the first: " +
                       base::Join({unbound.begin(), unbound.end()}, ", "));
  return out;
}

}  // namespace sim
