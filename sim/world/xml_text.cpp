#include "sim/world/xml_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "sim/world/xml_tags.h"
#include "tools/base/text.h"

namespace sim {
namespace {

bool IsDigits(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
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

// The text behind a tag, to the next one.
std::string_view TextBehind(std::string_view text, std::string_view tag) {
  const auto end = static_cast<std::size_t>(tag.data() - text.data()) + tag.size() + 1;
  const std::string_view rest = Trimmed(text.substr(std::min(end, text.size())));
  return rest.substr(0, std::min(rest.find('<'), rest.find_last_not_of(kBlanks, rest.find('<') - 1) + 1));
}

// Whether the numbers of the source with this identifier are all 0.
bool IsZero(std::string_view text, std::string_view source) {
  const std::size_t at = text.find("id=\"" + std::string(source) + "\""), array = text.find("<float_array", at);
  if (at == std::string_view::npos || array == std::string_view::npos) return false;
  return TextBehind(text, text.substr(array, text.find('>', array) - array)).find_first_of("123456789") ==
         std::string_view::npos;
}

// A morph's base geometry, by the morph's identifier: both as '#...'.
std::map<std::string, std::string_view> MorphsOf(std::string_view text, bool& any_weight) {
  std::map<std::string, std::string_view> bases;
  std::string_view controller;
  ForEachTag(text, [&](std::string_view tag) {
    if (IsTag(tag, "<controller")) controller = Attribute(tag, "id");
    if (IsTag(tag, "<morph")) bases["#" + std::string(controller)] = Attribute(tag, "source");
    if (!IsTag(tag, "<input") || Attribute(tag, "semantic") != "MORPH_WEIGHT") return;
    const std::string_view source = Attribute(tag, "source");
    any_weight = any_weight || !IsZero(text, source.substr(std::min<std::size_t>(source.size(), 1)));
  });
  return bases;
}

// Parameters of an effect, which assimp reads within a profile alone: what each names (a parameter or an image), and
// the wrapping of samplers.
struct Parameters {
  std::map<std::string, std::string_view, std::less<>> names;
  std::map<std::string, std::array<std::string_view, 2>, std::less<>> wrap;
  std::string at_hand;

  void Read(std::string_view text, std::string_view tag) {
    if (IsTag(tag, "<effect")) *this = {};
    if (IsTag(tag, "<newparam")) at_hand = Attribute(tag, "sid");
    if (tag == "</newparam") at_hand.clear();
    if (at_hand.empty()) return;
    if (tag == "<init_from" || tag == "<source" || tag == "<ref") names[at_hand] = TextBehind(text, tag);
    if (IsTag(tag, "<instance_image") && Attribute(tag, "url").size() > 1)
      names[at_hand] = Attribute(tag, "url").substr(1);
    if (tag == "<wrap_s") wrap[at_hand][0] = TextBehind(text, tag);
    if (tag == "<wrap_t") wrap[at_hand][1] = TextBehind(text, tag);
  }
  // The image at the end of the chain.
  std::string_view Image(std::string_view name) const {
    for (std::size_t steps = 0; steps <= names.size(); ++steps) {
      const auto next = names.find(name);
      if (next == names.end() || next->second.empty()) break;
      name = next->second;
    }
    return name;
  }
  // assimp's properties of a texture with this sampler; empty: it repeats.
  std::string Wrapping(std::string_view sampler) const {
    const auto at = wrap.find(sampler);
    std::string text;
    for (std::size_t i = 0; at != wrap.end() && i < 2; ++i) {
      const std::string_view mode = at->second[i];
      const std::string axis = i == 0 ? "U>" : "V>";
      if (mode == "MIRROR") text += "<mirror" + axis + "1</mirror" + axis;
      if (mode == "CLAMP" || mode == "BORDER" || mode == "NONE") text += "<wrap" + axis + "0</wrap" + axis;
    }
    return text.empty() ? "" : "<extra><technique profile=\"MAYA\">" + text + "</technique></extra>";
  }
};

}  // namespace

// The first material in assimp's order, which meshes have that name none.
constexpr std::string_view kDefaultMaterial =
    "<library_effects><effect id=\"!effect\"><profile_COMMON><technique sid=\"common\"><lambert><diffuse>"
    "<color>1 1 1 1</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>"
    "<library_materials><material id=\"!\" name=\"none\"><instance_effect url=\"#!effect\"/></material>"
    "</library_materials>";

std::string ColladaForAssimp(std::string_view text, std::vector<std::string>& warnings) {
  const UvSets sets = SetsOf(text);
  bool any_weight = false;
  const auto morphs = MorphsOf(text, any_weight);
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
  const auto replace = [&](std::string_view part, std::string_view by) {
    const auto at = static_cast<std::size_t>(part.data() - text.data());
    if (at < done) return;
    append(text.substr(done, at - done));
    append(by);
    done = at + part.size();
  };
  Parameters parameters;
  bool has_diffuse = false, has_emission = false;  // of the shader at hand
  bool is_morph = false;                           // the controller at hand
  bool has_default = false;
  ForEachTag(text, [&](std::string_view tag) {
    if (IsTag(tag, "<skew") || tag == "<skew")
      throw std::runtime_error("it has a <skew>, which is not read: export it with <matrix>, or as .glb");
    has_diffuse = has_diffuse || tag.starts_with("<diffuse");
    has_emission = has_emission || tag.starts_with("<emission");
    for (const std::string shader : {"constant", "lambert", "phong", "blinn"}) {
      if (tag.starts_with("<" + shader)) has_diffuse = has_emission = false;
      if (!tag.starts_with("</" + shader) || has_diffuse || !has_emission) continue;
      replace(tag.substr(0, 0), "<diffuse><color>0 0 0 1</color></diffuse>");  // assimp's default is 0.6
    }
    if (!has_default && (tag == "<library_visual_scenes" || IsTag(tag, "<library_visual_scenes"))) {
      replace(tag.substr(0, 0), kDefaultMaterial);
      has_default = true;
    }
    parameters.Read(text, tag);
    const auto whole = static_cast<std::size_t>(tag.data() - text.data()), end = whole + tag.size() + 1;
    const std::string_view version = IsTag(tag, "<COLLADA") ? Attribute(tag, "version") : "";
    if (version.starts_with("1.5")) replace(version, "1.4.1");
    if (tag == "<ref" || tag == "</ref" || IsTag(tag, "<instance_image"))  // COLLADA 1.5's
      replace(text.substr(whole, tag.size() + 1), "");
    if (IsTag(tag, "<controller") && morphs.contains("#" + std::string(Attribute(tag, "id"))))
      replace(text.substr(whole, text.find("</controller>", whole) + 13 - whole), "");
    const bool is_instance = IsTag(tag, "<instance_controller");
    const std::string_view controller = is_instance           ? Attribute(tag, "url")
                                        : IsTag(tag, "<skin") ? Attribute(tag, "source")
                                                              : "";
    if (const auto morph = morphs.find(std::string(controller)); morph != morphs.end()) {
      is_morph = is_instance;
      if (is_instance) replace(tag.substr(1, 19), "instance_geometry");
      replace(controller, morph->second);
    }
    if (is_morph && tag == "</instance_controller") {
      replace(tag, "</instance_geometry");
      is_morph = false;
    }
    if (!IsTag(tag, "<texture")) return;
    const std::string_view sampler = Attribute(tag, "texture"), name = Attribute(tag, "texcoord");
    const auto bound = sets.of_name.find(name);
    const std::string_view set = bound != sets.of_name.end() ? bound->second : IsDigits(name) ? name : "";
    const auto place = sets.place.find(set);
    const std::string place_text = place == sets.place.end() ? "0" : std::to_string(place->second);
    const auto name_sampler = [&] {
      if (!sampler.empty()) replace(sampler, parameters.Image(sampler));
    };
    if (sampler.data() < name.data()) name_sampler();
    if (!name.empty()) replace(name, place_text);
    if (sampler.data() > name.data()) name_sampler();
    if (!name.empty() && set.empty() && !sets.place.empty()) unbound.insert("'" + std::string(name) + "'");
    const std::string wrapping = parameters.Wrapping(sampler);
    const bool is_closed = tag.ends_with('/');
    if (!wrapping.empty())
      replace(text.substr(is_closed ? end - 2 : std::min(end, text.size()), is_closed ? 1 : 0),
              is_closed ? ">" + wrapping + "</texture" : wrapping);
  });
  append(text.substr(done));
  if (sets.has_two) warnings.push_back("a name of texture coordinates is bound to several sets: the first is used");
  if (any_weight) warnings.push_back("morph targets are left out: the base shape is drawn");
  const auto has = [&](std::string_view part) { return text.find(part) != std::string_view::npos; };
  for (const std::string wrap : {"BORDER", "NONE"})
    if (has("<wrap_s>" + wrap) || has("<wrap_t>" + wrap))
      warnings.push_back("a texture whose wrapping is " + wrap + " ends with the texels at its edge");
  if (has("=\"RGB_ZERO\"")) warnings.push_back("transparency of the kind RGB_ZERO is taken for A_ONE");
  if (has("<param ref=")) warnings.push_back("colours that are parameters (<param ref>) are not read");
  if (!unbound.empty())
    warnings.push_back("texture coordinates that are bound to no set (bind_vertex_input) are those of the first: " +
                       base::Join({unbound.begin(), unbound.end()}, ", "));
  return out;
}

namespace {

std::vector<std::string_view> NumbersOf(std::string_view list) {
  constexpr std::string_view kBetween = " \t\r\n,";
  std::vector<std::string_view> all;
  for (std::size_t at = list.find_first_not_of(kBetween); at < list.size();) {
    const std::size_t end = std::min(list.find_first_of(kBetween, at), list.size());
    all.push_back(list.substr(at, end - at));
    at = list.find_first_not_of(kBetween, end);
  }
  return all;
}

constexpr std::array<std::string_view, 5> kLists = {"<Coordinate", "<TextureCoordinate", "<Normal", "<Color",
                                                    "<ColorRGBA"};

// The tag of a list that is defined elsewhere (USE), else this one.
std::string_view Defined(std::string_view text, std::string_view tag, std::string_view node) {
  std::string_view from = tag;
  ForEachTag(Attribute(tag, "USE").empty() ? "" : text, [&](std::string_view other) {
    if (IsTag(other, node) && Attribute(other, "DEF") == Attribute(tag, "USE")) from = other;
  });
  return from;
}

// A set of faces or triangles (its tag, and what is in it) as an IndexedFaceSet where each corner has a position of its
// own: assimp knows one normal, texture coordinate and colour for each position, and no faces that are turned about.
// Empty: it has no faces.
std::string WithOwnCorners(std::string_view text, std::string_view tag, std::string_view inside) {
  struct List {
    std::string_view node, values, index, per_vertex;
    std::size_t width;
    std::vector<std::string_view> all{};
  };
  List lists[] = {{kLists[0], "point", "coordIndex", "", 3},
                  {kLists[1], "point", "texCoordIndex", "", 2},
                  {kLists[2], "vector", "normalIndex", "normalPerVertex", 3},
                  {kLists[3], "color", "colorIndex", "colorPerVertex", 3},
                  {kLists[4], "color", "colorIndex", "colorPerVertex", 4}};
  ForEachTag(inside, [&](std::string_view child) {
    for (List& list : lists) {
      if (!IsTag(child, list.node)) continue;
      list.all = NumbersOf(Attribute(Defined(text, child, list.node), std::string(list.values)));
    }
  });
  const bool is_triangles = !IsTag(tag, "<IndexedFaceSet");
  std::vector<double> corners;  // of faces, each with a -1 at its end
  const auto append = [&](double corner) {
    if (is_triangles && corners.size() % 4 == 3) corners.push_back(-1);
    corners.push_back(corner);
  };
  const auto number = [](std::string_view word) { return base::ParseNumber(word).value_or(-2); };
  for (const std::string_view word : NumbersOf(Attribute(tag, is_triangles ? "index" : "coordIndex")))
    append(number(word));
  for (std::size_t i = 0; IsTag(tag, "<TriangleSet") && i < lists[0].all.size() / 3; ++i)
    append(static_cast<double>(i));
  std::vector<std::size_t> order, face;  // of the corners: places in the list of indices, and their faces
  const std::string_view name = Attribute(tag, "DEF");
  std::string out = "<IndexedFaceSet " + (name.empty() ? "" : "DEF='" + std::string(name) + "' ") + "coordIndex='";
  for (std::size_t i = 0, first = 0, faces = 0; i <= corners.size(); ++i) {
    if (i < corners.size() && corners[i] != -1) continue;
    for (std::size_t k = first; k < i; ++k) {
      out += std::to_string(order.size()) + " ";
      order.push_back(Attribute(tag, "ccw") == "false" ? first + i - 1 - k : k);
      face.push_back(faces);
    }
    if (i > first) out += "-1 ", ++faces;
    first = i + 1;
  }
  if (order.empty()) return "";
  if (lists[0].all.empty())
    throw std::runtime_error("a set of faces has no Coordinate (CoordinateDouble and GeoCoordinate are not read)");
  out += "'>";
  for (const List& list : lists) {
    if (list.all.empty()) continue;
    const std::vector<std::string_view> own = NumbersOf(Attribute(tag, std::string(list.index)));
    const bool of_face =
        !is_triangles && !list.per_vertex.empty() && Attribute(tag, std::string(list.per_vertex)) == "false";
    out += std::string(list.node) + " " + std::string(list.values) + "='";
    for (std::size_t corner = 0; corner < order.size(); ++corner) {
      const std::size_t place = of_face ? face[corner] : order[corner];
      const double at = is_triangles || own.empty() ? (of_face ? static_cast<double>(place) : corners[place])
                        : place < own.size()        ? number(own[place])
                                                    : -1;
      if (!(at >= 0 && at < static_cast<double>(list.all.size() / list.width)))
        throw std::runtime_error("a face has an index that is not in its list (" + std::string(list.node.substr(1)) +
                                 ")");
      for (std::size_t k = 0; k < list.width; ++k)
        (out += list.all[static_cast<std::size_t>(at) * list.width + k]) += " ";
    }
    out += "'/>";
  }
  return out + "</IndexedFaceSet";
}

// An attribute of one number, or its default.
double NumberOr(std::string_view tag, const std::string& name, double value) {
  return base::ParseNumber(Attribute(tag, name)).value_or(value);
}

// A Cone as a set of faces with its apex up: assimp's is upside down.
std::string FacesOfCone(std::string_view tag) {
  constexpr int kSides = 32;
  const double radius = NumberOr(tag, "bottomRadius", 1), top = NumberOr(tag, "height", 2) / 2;
  const auto text = [](double x) { return base::Significant(x, 9) + " "; };
  std::string points = "0 " + text(top) + "0 ", sides, bottom;
  for (int i = 0; i < kSides; ++i) {
    const double turn = 2 * std::numbers::pi * i / kSides;
    points += text(radius * std::sin(turn)) + text(-top) + text(radius * std::cos(turn));
    sides += "0 " + std::to_string(i + 1) + " " + std::to_string((i + 1) % kSides + 1) + " -1 ";
    bottom += std::to_string(kSides - i) + " ";
  }
  return "<IndexedFaceSet coordIndex='" + (Attribute(tag, "side") == "false" ? "" : sides) +
         (Attribute(tag, "bottom") == "false" ? "" : bottom + "-1") + "'><Coordinate point='" + points +
         "'/></IndexedFaceSet";
}

// Whether an attribute has a number other than this one.
bool HasOther(std::string_view tag, const std::string& name, double number) {
  const std::vector<std::string_view> numbers = NumbersOf(Attribute(tag, name));
  return std::ranges::any_of(numbers, [&](std::string_view text) { return base::ParseNumber(text) != number; });
}

}  // namespace

std::string X3dForAssimp(std::string_view text, std::vector<std::string>& warnings) {
  std::string out;
  std::size_t done = 0;
  bool has_copies = false, has_files = false, has_textures = false, has_turns = false;
  double unit = 1;
  std::set<std::string> left_out;
  ForEachTag(text, [&](std::string_view tag) {
    const auto begin_of_tag = static_cast<std::size_t>(tag.data() - text.data()),
               end_of_tag = begin_of_tag + tag.size() + 1;
    const auto replace = [&](std::size_t begin, std::size_t end, std::string_view by) {
      if (begin < done) return;
      out.append(text.substr(done, begin - done)).append(by);
      done = std::min(end, text.size());
    };
    if (IsTag(tag, "<unit") && Attribute(tag, "category") == "length") unit = NumberOr(tag, "conversionFactor", 1);
    const auto is = [&](const std::string& node) { return IsTag(tag, node) || tag == node; };
    const std::string scale = base::Significant(unit, 9) + " ";
    if (unit != 1 && is("<Scene")) replace(end_of_tag, end_of_tag, "<Transform scale='" + scale + scale + scale + "'>");
    if (unit != 1 && tag == "</Scene") replace(begin_of_tag, begin_of_tag, "</Transform>");
    if (is("<Cone") || tag == "<Cone/") {
      const std::size_t end = tag.ends_with('/') ? end_of_tag - 1 : text.find('>', text.find("</Cone", end_of_tag));
      if (end < text.size()) replace(begin_of_tag, end, FacesOfCone(tag));
    }
    if (IsTag(tag, "<Disk2D") && NumberOr(tag, "innerRadius", 0) != 0)
      throw std::runtime_error("it has a Disk2D with an innerRadius, which is not read: export it as faces");
    // Without a material assimp takes another shape's.
    constexpr std::string_view kWhite = "<Material diffuseColor='1 1 1'/>";
    for (const std::string node : {"Shape", "Appearance"}) {
      if (!is("<" + node) || tag.ends_with('/') || end_of_tag < done) continue;
      const std::string_view inside =
          text.substr(end_of_tag, std::min(text.find("</" + node, end_of_tag), text.size()) - end_of_tag);
      const bool is_shape = node == "Shape";
      if (inside.find(is_shape ? "<Appearance" : "<Material") != std::string_view::npos) continue;
      if (is_shape || inside.find("Texture") == std::string_view::npos)
        replace(end_of_tag, end_of_tag,
                is_shape ? "<Appearance>" + std::string(kWhite) + "</Appearance>" : std::string(kWhite));
    }
    // On an IndexedLineSet assimp does not end.
    for (const std::string node : {"IndexedFaceSet", "IndexedTriangleSet", "TriangleSet", "IndexedLineSet"}) {
      if (!IsTag(tag, "<" + node) || tag.ends_with('/') || begin_of_tag < done) continue;
      const std::size_t end = text.find("</" + node, end_of_tag);
      if (end == std::string_view::npos) continue;
      const std::string set =
          node == "IndexedLineSet" ? "" : WithOwnCorners(text, tag, text.substr(end_of_tag, end - end_of_tag));
      replace(begin_of_tag, end + 2 + node.size() + (set.empty() ? 1 : 0), set);
    }
    for (const std::string_view node : kLists) {  // of other sets: the definition may have been replaced
      const std::string_view from = IsTag(tag, node) && begin_of_tag >= done ? Defined(text, tag, node) : tag;
      if (from == tag) continue;
      std::string copy(from.substr(0, from.size() - (from.ends_with('/') ? 1 : 0)));
      copy.replace(copy.find("DEF"), 3, "id");
      replace(begin_of_tag, begin_of_tag + tag.size(), copy + (tag.ends_with('/') ? "/" : ""));
    }
    for (const auto& [node, known] : {std::pair<std::string, const char*>{"Anchor", "Group"},
                                      {"Billboard", "Group"},
                                      {"Collision", "Group"},
                                      {"CADLayer", "Group"},
                                      {"CADAssembly", "Group"},
                                      {"CADFace", "Group"},
                                      {"CADPart", "Transform"}}) {
      if ((!is("<" + node) && tag != "</" + node) || begin_of_tag < done) continue;
      const std::size_t at = text.find(node, begin_of_tag);
      replace(at, at + node.size(), known);
    }
    for (const std::string node :
         {"LOD", "Text", "ProtoInstance", "Layer", "LayerSet", "LayoutLayer", "GeoLocation", "GeoTransform", "GeoLOD",
          "GeoElevationGrid", "HAnimHumanoid", "QuadSet", "IndexedQuadSet", "NurbsPatchSurface", "NurbsTrimmedSurface",
          "NurbsSweptSurface", "ParticleSystem"})
      if (is("<" + node)) left_out.insert(node);
    has_turns =
        has_turns || (IsTag(tag, "<TextureTransform") &&
                      (HasOther(tag, "rotation", 0) ||
                       (HasOther(tag, "scale", 1) && (HasOther(tag, "center", 0) || HasOther(tag, "translation", 0)))));
    has_files = has_files || IsTag(tag, "<Inline");
    for (const std::string_view node : {"<Shape", "<Transform", "<Group", "<Switch"})
      has_copies = has_copies || (IsTag(tag, node) && !Attribute(tag, "USE").empty());
    for (const std::string_view node : {"<PixelTexture", "<MovieTexture", "<MultiTexture"})
      has_textures = has_textures || IsTag(tag, node) || tag == node;
    for (const char* attribute : {"url", "value", "info"}) {
      const std::string_view texts = Attribute(tag, attribute);
      std::string first(texts);
      for (std::size_t at = first.find("&quot;"); at != std::string::npos; at = first.find("&quot;"))
        first.replace(at, 6, "\"");
      const std::size_t begin = first.find('"') + 1;
      if (begin == 0) continue;
      const auto at = static_cast<std::size_t>(texts.data() - text.data());
      std::string name;
      for (const char c : first.substr(begin, first.find('"', begin) - begin))
        name += c == ' ' ? "%20" : std::string(1, c);
      replace(at, at + texts.size(), name);
    }
  });
  if (has_copies) warnings.push_back("nodes that stand in several places (USE) are drawn in the first alone");
  if (has_textures) warnings.push_back("textures of other kinds than ImageTexture are left out");
  if (has_turns)
    warnings.push_back("a TextureTransform that turns, or scales and moves, a picture is not applied as it should be");
  if (!left_out.empty())
    warnings.push_back("nodes that are not read are left out, with all in them: " +
                       base::Join({left_out.begin(), left_out.end()}, ", "));
  if (has_files) warnings.push_back("files that it includes (Inline) are not read");
  return out + std::string(text.substr(done));
}

}  // namespace sim
