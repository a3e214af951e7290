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

// An attribute's value in a tag; empty: none.
std::string_view Attribute(std::string_view tag, const std::string& name) {
  for (const char quote : {'"', '\''}) {
    const std::size_t at = tag.find(' ' + name + '=' + quote);
    if (at == std::string_view::npos) continue;
    const std::string_view rest = tag.substr(at + name.size() + 3);
    return rest.substr(0, rest.find(quote));
  }
  return {};
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
  std::map<std::string, std::size_t, std::less<>> place;
};

UvSets SetsOf(std::string_view text) {
  UvSets sets;
  const auto by_number = [](std::string_view a, std::string_view b) {
    return std::pair(a.size(), a) < std::pair(b.size(), b);
  };
  std::set<std::string_view, decltype(by_number)> here;
  ForEachTag(text, [&](std::string_view tag) {
    if (tag.starts_with("<bind_vertex_input ") && Attribute(tag, "input_semantic") == "TEXCOORD")
      sets.of_name.try_emplace(std::string(Attribute(tag, "semantic")), Attribute(tag, "input_set"));
    if (tag.starts_with("<input ")) {
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
      if (c == '<') out.erase(out.find_last_not_of(" \t\r\n") + 1);
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
    const std::string_view name = tag.starts_with("<texture ") ? Attribute(tag, "texcoord") : "";
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
  if (!unbound.empty())
    warnings.push_back("texture coordinates that are bound to no set (bind_vertex_input) are those of the first: " +
                       base::Join({unbound.begin(), unbound.end()}, ", "));
  return out;
}

}  // namespace sim
