#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "sim/world/material_library.h"
#include "sim/world/mesh_builder.h"
#include "sim/world/mesh_readers.h"
#include "sim/world/texture.h"
#include "sim/world/xml_tags.h"

namespace sim {
namespace {

// Files of a zip archive, by name.
class Zip {
 public:
  explicit Zip(std::string_view bytes) : bytes_(bytes) {
    const std::size_t end = bytes.rfind("PK\5\6");
    if (end == std::string_view::npos) throw std::runtime_error("it is no zip archive, or is cut off");
    std::size_t at = Number(end + 16, 4);
    for (std::size_t left = Number(end + 10, 2); left > 0; --left) {
      const std::size_t length = Number(at + 28, 2);
      places_[std::string(Part(at + 46, length))] = at;
      at += 46 + length + Number(at + 30, 2) + Number(at + 32, 2);
    }
  }
  const std::map<std::string, std::size_t>& places() const { return places_; }

  std::string Read(const std::string& name) const {
    const auto found = places_.find(name);
    if (found == places_.end()) throw std::runtime_error("it lacks " + name);
    const std::size_t at = found->second, packed = Number(at + 20, 4), size = Number(at + 24, 4),
                      local = Number(at + 42, 4);
    const std::string_view data = Part(local + 30 + Number(local + 26, 2) + Number(local + 28, 2), packed);
    constexpr std::size_t kStored = 0, kDeflated = 8, kMostPerByte = 1032;
    if (Number(at + 10, 2) == kStored) return std::string(data);
    std::string content(size / kMostPerByte <= packed ? size : 0, '\0');
    const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> inflater(
        libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
    if (Number(at + 10, 2) != kDeflated || content.size() != size ||
        libdeflate_deflate_decompress(inflater.get(), data.data(), packed, content.data(), size, nullptr) !=
            LIBDEFLATE_SUCCESS)
      throw std::runtime_error(name + " in it cannot be unpacked");
    return content;
  }

 private:
  std::string_view Part(std::size_t at, std::size_t length) const {
    if (at > bytes_.size() || length > bytes_.size() - at) throw std::runtime_error("its archive is damaged");
    return bytes_.substr(at, length);
  }
  std::size_t Number(std::size_t at, std::size_t length) const {
    std::size_t value = 0;
    for (const char byte : Part(at, length)) value = value >> 8 | std::size_t{static_cast<std::uint8_t>(byte)} << 56;
    return value >> (64 - 8 * length);
  }

  std::string_view bytes_;
  std::map<std::string, std::size_t> places_;
};

class ThreeMfReader {
 public:
  ThreeMfReader(std::string_view bytes, MeshImport& import) : zip_(bytes), import_(import), scene_(import.scene) {}

  void Read() {
    scene_.materials.push_back({""});  // of what has none
    const std::string usual = "3D/3dmodel.model";
    std::string root;
    for (const auto& [name, place] : zip_.places()) {
      if (!name.ends_with(".model")) continue;
      if (root.empty() || name == usual) root = name;
      ReadModel(name);
    }
    if (root.empty()) throw std::runtime_error("it holds no model");
    const double unit = units_[root];
    scene_.nodes.push_back({-1, glm::mat4(glm::dmat4(glm::dmat3(unit))), {}});
    for (const auto& [object, transform] : items_[root]) Place(object, transform, 0, 0);
    if (has_others_) import_.warnings.push_back("mixed materials (composite, multiproperties) are left out: white");
  }

 private:
  using Placed = std::pair<std::string, glm::mat4>;
  // What a property of a triangle's corner names.
  struct Property {
    unsigned material = 0;
    std::int32_t uv = -1, color = -1;
  };
  struct Object {
    std::vector<unsigned> meshes;
    std::vector<Placed> components;
  };

  static double ToDouble(std::string_view text) {
    const std::optional<double> number = ToNumber(text);
    if (!number) throw std::runtime_error("'" + std::string(text.substr(0, 40)) + "' is not a number");
    return *number;
  }

  // Rows of x, y, z and the origin, as a matrix.
  static glm::mat4 Transform(std::string_view text) {
    glm::mat4 transform(1);
    for (int i = 0; i < 12 && !text.empty(); ++i)
      transform[i / 3][i % 3] = static_cast<float>(ToDouble(NextWord(text)));
    return transform;
  }

  // "#RRGGBB", and perhaps alpha, which is not used.
  static glm::vec4 Color(std::string_view text) {
    glm::vec4 color(1);
    for (std::size_t i = 0; i < 3 && text.size() >= 7; ++i)
      color[static_cast<int>(i)] =
          static_cast<float>(std::stoul("0" + std::string(text.substr(1 + 2 * i, 2)), nullptr, 16)) / 255.0f;
    return color;
  }

  void ReadModel(const std::string& name) {
    const std::string text = zip_.Read(name);
    // A part of the archive with an identifier in it.
    const auto key = [&](std::string_view tag, const char* id) {
      const std::string_view path = Attribute(tag, "p:path");
      return (path.empty() ? name : std::string(path.substr(path.starts_with('/')))) + "#" +
             std::string(Attribute(tag, id));
    };
    std::string group, object, pid, pindex;
    std::size_t first = 0;                                // vertex of the object
    std::map<std::pair<unsigned, bool>, Polygons> parts;  // by material, and whether its corners have colours
    ForEachTag(text, [&](std::string_view tag) {
      const std::size_t begin = tag.starts_with("</") ? 2 : 1;
      const std::size_t end = std::min(tag.find_first_of(" \t\r\n/>", begin), tag.size());
      const std::string_view prefixed = tag.substr(begin, end - begin), kind = prefixed.substr(prefixed.find(':') + 1);
      if (begin == 2) {
        if (kind == "object") EndObject(object, parts);
      } else if (kind == "model") {
        const std::map<std::string_view, double> units = {
            {"micron", 1e-6}, {"centimeter", 0.01}, {"inch", 0.0254}, {"foot", 0.3048}, {"meter", 1}};
        const auto unit = units.find(Attribute(tag, "unit"));
        units_[name] = unit == units.end() ? 0.001 : unit->second;
      } else if (kind == "basematerials" || kind == "colorgroup" || kind == "texture2dgroup") {
        group = key(tag, "id");
        if (kind == "texture2dgroup") pictured_[group] = pictures_[key(tag, "texid")];
      } else if (kind == "base") {
        const glm::vec4 coded = Color(Attribute(tag, "displaycolor"));
        glm::vec4 linear(1);
        for (int i = 0; i < 3; ++i) linear[i] = static_cast<float>(SrgbToLinear(coded[i]));
        groups_[group].push_back({static_cast<unsigned>(scene_.materials.size())});
        scene_.materials.push_back({std::string(Attribute(tag, "name")), "", linear});
      } else if (kind == "color") {
        groups_[group].push_back({0, -1, static_cast<std::int32_t>(pools_.colors.size())});
        pools_.colors.push_back(Color(Attribute(tag, "color")));
      } else if (kind == "texture2d") {
        pictures_[key(tag, "id")] = AddPicture(tag);
      } else if (kind == "tex2coord") {
        groups_[group].push_back({pictured_[group], static_cast<std::int32_t>(pools_.uvs.size()), -1});
        pools_.uvs.emplace_back(ToDouble(Attribute(tag, "u")), ToDouble(Attribute(tag, "v")));
      } else if (kind == "object") {
        object = key(tag, "id"), pid = Attribute(tag, "pid"), pindex = Attribute(tag, "pindex");
        first = pools_.positions.size();
        parts.clear();
      } else if (kind == "vertex") {
        pools_.positions.emplace_back(ToDouble(Attribute(tag, "x")), ToDouble(Attribute(tag, "y")),
                                      ToDouble(Attribute(tag, "z")));
      } else if (kind == "triangle") {
        const std::string_view own = Attribute(tag, "p1"), of = Attribute(tag, "pid");
        const auto properties = groups_.find(name + "#" + std::string(of.empty() ? pid : of));
        has_others_ = has_others_ || (properties == groups_.end() && !(of.empty() && pid.empty()));
        std::array<Property, 3> corners;
        for (std::size_t i = 0; i < 3; ++i) {
          const std::string_view at = Attribute(tag, i == 0   ? "p1"
                                                     : i == 1 ? "p2"
                                                              : "p3"),
                                 index = !at.empty()    ? at
                                         : !own.empty() ? own
                                                        : std::string_view(pindex);
          const double n = index.empty() || properties == groups_.end() ? -1 : ToDouble(index);
          if (n >= 0 && n < static_cast<double>(properties->second.size()))
            corners[i] = properties->second[static_cast<std::size_t>(n)];
        }
        Polygons& part = parts[{corners[0].material, corners[0].color >= 0}];
        part.sizes.push_back(3);
        for (std::size_t i = 0; i < 3; ++i) {
          const double v = ToDouble(Attribute(tag, i == 0 ? "v1" : i == 1 ? "v2" : "v3"));
          if (!(v >= 0 && v < static_cast<double>(pools_.positions.size() - first)))
            throw std::runtime_error("a triangle names a vertex that does not exist");
          part.corners.push_back(
              {static_cast<std::int32_t>(first + static_cast<std::size_t>(v)), corners[i].uv, -1, corners[i].color});
        }
      } else if (kind == "component") {
        objects_[object].components.emplace_back(key(tag, "objectid"), Transform(Attribute(tag, "transform")));
      } else if (kind == "item") {
        items_[name].emplace_back(key(tag, "objectid"), Transform(Attribute(tag, "transform")));
      }
    });
  }

  void EndObject(const std::string& name, const std::map<std::pair<unsigned, bool>, Polygons>& parts) {
    for (const auto& [of, part] : parts) {
      objects_[name].meshes.push_back(static_cast<unsigned>(scene_.meshes.size()));
      scene_.meshes.emplace_back().material = of.first;
      AppendPolygons(part, pools_, glm::dvec3(0), scene_.meshes.back());
    }
  }

  // The material of a picture in the archive.
  unsigned AddPicture(std::string_view tag) {
    const std::string_view path = Attribute(tag, "path");
    const std::string content = zip_.Read(std::string(path.substr(path.starts_with('/'))));
    ImportedMaterial material{std::string(path)};
    material.color_map.picture = path;
    material.color_map.embedded = static_cast<int>(scene_.pictures.size());
    for (const std::size_t axis : {0u, 1u}) {
      const std::string_view style = Attribute(tag, axis == 0 ? "tilestyleu" : "tilestylev");
      material.color_map.uv.wrap[axis] = style == "mirror"                     ? UvWrap::mirror
                                         : style == "clamp" || style == "none" ? UvWrap::clamp
                                                                               : UvWrap::repeat;
    }
    scene_.pictures.push_back({static_cast<unsigned>(content.size()), 0, {content.begin(), content.end()}});
    scene_.materials.push_back(material);
    return static_cast<unsigned>(scene_.materials.size()) - 1;
  }

  void Place(const std::string& name, const glm::mat4& transform, int parent, int depth) {
    constexpr int kDeepest = 100;
    constexpr std::size_t kMost = 1 << 20;
    const auto object = objects_.find(name);
    if (object == objects_.end()) return;
    if (depth > kDeepest || scene_.nodes.size() > kMost)
      throw std::runtime_error("its components are too many or deep");
    const auto node = static_cast<int>(scene_.nodes.size());
    scene_.nodes.push_back({parent, transform, object->second.meshes});
    for (const auto& [part, placed] : object->second.components) Place(part, placed, node, depth + 1);
  }

  Zip zip_;
  MeshImport& import_;
  ImportedScene& scene_;
  PolygonPools pools_;
  bool has_others_ = false;
  std::map<std::string, std::vector<Property>> groups_;
  std::map<std::string, unsigned> pictures_, pictured_;  // materials of pictures, and of groups of their coordinates
  std::map<std::string, Object> objects_;
  std::map<std::string, std::vector<Placed>> items_;  // of each model
  std::map<std::string, double> units_;               // [m]
};

}  // namespace

void Read3mf(MeshFiles& files, MeshImport& import) {
  const std::string bytes = files.Read(files.mesh()).value_or("");
  try {
    ThreeMfReader(bytes, import).Read();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    import.problem = std::string("cannot be read: ") + error.what();
  }
}

}  // namespace sim
