#include <algorithm>
#include <bit>
#include <iterator>
#include <map>
#include <new>
#include <stdexcept>
#include <string_view>

#include "sim/world/material_library.h"
#include "sim/world/mesh_builder.h"
#include "sim/world/mesh_readers.h"
#include "sim/world/texture_file.h"

namespace sim {
namespace {

constexpr std::size_t kMostValues = 1 << 27;

// Types of numbers by both names, and the value of 1 in a colour.
struct Type {
  std::string_view name, sized_name;
  std::size_t bytes;
  double white;
  double (*number_at)(const void*);
};
constexpr Type kTypes[] = {
    {"char", "int8", 1, 255, NumberAt<std::int8_t>},  {"uchar", "uint8", 1, 255, NumberAt<std::uint8_t>},
    {"short", "int16", 2, 1, NumberAt<std::int16_t>}, {"ushort", "uint16", 2, 1, NumberAt<std::uint16_t>},
    {"int", "int32", 4, 1, NumberAt<std::int32_t>},   {"uint", "uint32", 4, 1, NumberAt<std::uint32_t>},
    {"float", "float32", 4, 1, NumberAt<float>},      {"double", "float64", 8, 1, NumberAt<double>}};

const Type& TypeOf(std::string_view name) {
  const auto* type = std::ranges::find_if(kTypes, [&](auto& t) { return t.name == name || t.sized_name == name; });
  if (type == std::end(kTypes)) throw std::runtime_error("'" + std::string(name) + "' is no type");
  return *type;
}

struct Property {
  std::string name;
  const Type* type;
  const Type* count;  // of a list; null: none
};

struct Element {
  std::string name;
  std::size_t count;
  std::vector<Property> properties;
  // The place of the first property that has one of these names; -1: none.
  int Find(std::initializer_list<std::string_view> names) const {
    for (const std::string_view wanted : names) {
      for (std::size_t i = 0; i < properties.size(); ++i) {
        if (properties[i].name == wanted) return static_cast<int>(i);
      }
    }
    return -1;
  }
};

// The values of one row, by property; a list's are as many as it has.
using Row = std::vector<std::vector<double>>;

class PlyReader {
 public:
  PlyReader(MeshFiles& files, MeshImport& import)
      : import_(import), text_(files.Read(files.mesh()).value_or("")), rest_(text_) {}

  void Read() {
    ReadHeader();
    RequireFaces();
    for (const Element& element : elements_) {  // vertices may come after faces
      if (element.name == "vertex") vertex_ = PlacesOf(element);
    }
    for (const Element& element : elements_) {
      if (element.properties.empty()) continue;
      if (element.count > rest_.size()) throw std::runtime_error("the file ends too early");
      if (element.name == "vertex") {
        ReadVertices(element);
      } else if (element.name == "face") {
        ReadFaces(element);
      } else if (element.name == "tristrips") {
        ForEachRow(element, [&](const Row& row) { AppendStrips(row.at(0)); });
      } else {
        ForEachRow(element, [](const Row&) {});
      }
    }
    Build();
  }

 private:
  void ReadHeader() {
    const char ending = rest_.starts_with("ply\r") && !rest_.starts_with("ply\r\n") ? '\r' : '\n';
    bool ended = false, known = false;
    while (!ended && !rest_.empty()) {
      const std::size_t end = std::min(rest_.find(ending), rest_.size());
      std::string_view line = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      const std::string_view word = NextWord(line);
      if (word == "format") {
        const std::string_view format = NextWord(line);
        is_text_ = format == "ascii";
        is_big_ = format == "binary_big_endian";
        known = is_text_ || is_big_ || format == "binary_little_endian";
      } else if (word == "element") {
        const std::string_view name = NextWord(line);
        const std::optional<double> count = ToNumber(NextWord(line));
        if (!count || !(*count >= 0 && *count <= 1e15)) throw std::runtime_error("an element without a count");
        if (name == "vertex" && std::ranges::find(elements_, name, &Element::name) != elements_.end())
          throw std::runtime_error("it has vertices twice");
        elements_.push_back({std::string(name), static_cast<std::size_t>(*count), {}});
      } else if (word == "property" && !elements_.empty()) {
        std::string_view type = NextWord(line);
        const Type* count = nullptr;
        if (type == "list") {
          count = &TypeOf(NextWord(line));
          type = NextWord(line);
        }
        const Type& of = TypeOf(type);
        elements_.back().properties.push_back({Lower(std::string(line)), &of, count});
      } else if (word == "comment" || word == "obj_info") {
        if (Lower(std::string(NextWord(line))) == "texturefile") textures_.emplace_back(line);
      }
      ended = word == "end_header";
    }
    if (!ended || !known) throw std::runtime_error("its header breaks off, or names no format");
  }

  void RequireFaces() const {
    const auto is = [](const Element& e, auto... names) { return e.count > 0 && ((e.name == names) || ...); };
    if (std::ranges::any_of(elements_, [&](const Element& e) { return is(e, "face", "tristrips"); })) return;
    const bool is_splats = std::ranges::any_of(elements_, [](const Element& e) {
      return e.Find({"f_dc_0", "packed_position"}) >= 0;
    });
    throw std::runtime_error(
        std::string(is_splats ? "it holds Gaussian splats" : "it is a point cloud, without faces") +
        "; triangles are needed: make a mesh of it first");
  }

  double Value(const Type& type) {
    if (is_text_) {
      const std::size_t begin = std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size());
      const std::size_t end = std::min(rest_.find_first_of(" \t\r\n", begin), rest_.size());
      const std::string_view word = rest_.substr(begin, end - begin);
      rest_.remove_prefix(end);
      if (word.empty()) throw std::runtime_error("the file ends too early");
      const std::optional<double> number = ToNumber(word);
      if (!number) throw std::runtime_error("'" + std::string(word) + "' is not a number");
      return *number;
    }
    if (rest_.size() < type.bytes) throw std::runtime_error("the file ends too early");
    std::array<char, 8> bytes{};
    std::copy_n(rest_.begin(), type.bytes, bytes.begin());
    if (is_big_) std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(type.bytes));
    rest_.remove_prefix(type.bytes);
    return type.number_at(bytes.data());
  }

  template <class Call>
  void ForEachRow(const Element& element, const Call& call) {
    Row row(element.properties.size());
    for (std::size_t n = 0; n < element.count; ++n) {
      for (std::size_t i = 0; i < row.size(); ++i) {
        const Property& property = element.properties[i];
        const double count = property.count ? Value(*property.count) : 1;
        if (!(count >= 0 && count <= static_cast<double>(rest_.size() + 1)) || count > kMostValues)
          throw std::runtime_error("a list has more entries than the file");
        row[i].resize(static_cast<std::size_t>(count));
        for (double& value : row[i]) value = Value(*property.type);
      }
      call(row);
    }
  }

  // The places of properties, all or none.
  template <std::size_t n>
  static std::optional<std::array<std::size_t, n>> Places(const std::array<int, n>& found) {
    std::array<std::size_t, n> places{};
    for (std::size_t i = 0; i < n; ++i) {
      if (found[i] < 0) return std::nullopt;
      places[i] = static_cast<std::size_t>(found[i]);
    }
    return places;
  }
  static std::optional<std::array<std::size_t, 3>> ColorPlaces(const Element& e) {
    return Places<3>({e.Find({"red", "r", "diffuse_red"}), e.Find({"green", "g", "diffuse_green"}),
                      e.Find({"blue", "b", "diffuse_blue"})});
  }
  void AppendColor(const Element& element, const std::array<std::size_t, 3>& at, const Row& row) {
    const double white = element.properties[at[0]].type->white;
    const auto channel = [&](std::size_t i) {
      return row[at[i]].empty() ? 0.0f : static_cast<float>(row[at[i]][0] / white);
    };
    pools_.colors.emplace_back(channel(0), channel(1), channel(2), 1.0f);
  }

  // Of a vertex' properties.
  struct Vertex {
    std::optional<std::array<std::size_t, 3>> xyz, normal, color;
    std::optional<std::array<std::size_t, 2>> uv;
  };
  static Vertex PlacesOf(const Element& e) {
    return {Places<3>({e.Find({"x"}), e.Find({"y"}), e.Find({"z"})}),
            Places<3>({e.Find({"nx", "normal_x"}), e.Find({"ny", "normal_y"}), e.Find({"nz", "normal_z"})}),
            ColorPlaces(e),
            Places<2>({e.Find({"s", "u", "texture_u", "texture_s", "tu", "texcoord_u", "u0", "uv_0"}),
                       e.Find({"t", "v", "texture_v", "texture_t", "tv", "texcoord_v", "v0", "uv_1"})})};
  }

  void ReadVertices(const Element& e) {
    if (!vertex_.xyz) throw std::runtime_error("its vertices have no x, y, z");
    ForEachRow(e, [&](const Row& row) {
      const auto& [xyz, normal, color, uv] = vertex_;
      const auto number = [&](std::size_t at) {
        if (row[at].size() != 1) throw std::runtime_error("a coordinate is a list");
        return row[at][0];
      };
      const auto single = [&](std::size_t at) { return static_cast<float>(number(at)); };
      pools_.positions.emplace_back(number((*xyz)[0]), number((*xyz)[1]), number((*xyz)[2]));
      if (normal) pools_.normals.emplace_back(single((*normal)[0]), single((*normal)[1]), single((*normal)[2]));
      if (uv) pools_.uvs.emplace_back(single((*uv)[0]), single((*uv)[1]));
      if (color) AppendColor(e, *color, row);
    });
  }

  // A corner at a vertex.
  Corner At(double vertex) const {
    if (!(vertex >= 0 && vertex < 2147483647.0))
      throw std::runtime_error("a face names vertex " + std::to_string(vertex));
    const auto i = static_cast<std::int32_t>(vertex);
    return {i, vertex_.uv ? i : -1, vertex_.normal ? i : -1, vertex_.color ? i : -1};
  }

  void ReadFaces(const Element& e) {
    const int list = e.Find({"vertex_indices", "vertex_index"}), wedge = e.Find({"texcoord"}),
              number = e.Find({"texnumber"});
    const auto color = vertex_.color ? std::nullopt : ColorPlaces(e);
    if (e.Find({"material_index"}) >= 0)
      import_.warnings.push_back("materials of its faces (material_index) are not read: they are white");
    if (e.Find({"color"}) >= 0) import_.warnings.push_back("colours of its faces' corners (color) are not read");
    if (list < 0 && e.count > 0) throw std::runtime_error("its faces have no list vertex_indices or vertex_index");
    ForEachRow(e, [&](const Row& row) {
      const std::vector<double>& vertices = row[static_cast<std::size_t>(list)];
      if (vertices.size() < 3) return;
      const std::vector<double> none, &uvs = wedge < 0 ? none : row[static_cast<std::size_t>(wedge)];
      const std::size_t each = uvs.size() / vertices.size();  // u v, or u v w
      const bool has_wedge = each >= 2 && uvs.size() == each * vertices.size();
      const std::vector<double>& texture = number < 0 ? none : row[static_cast<std::size_t>(number)];
      if (color) AppendColor(e, *color, row);
      // Faces with and without coordinates of their own are parts, as are those of different textures.
      const int of = texture.empty() ? 0 : texture[0] >= 0 ? static_cast<int>(std::min(texture[0], 1e6)) : -1;
      Polygons& part = parts_[{of, wedge >= 0 && !has_wedge}];
      part.sizes.push_back(static_cast<std::uint32_t>(vertices.size()));
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        Corner& corner = part.corners.emplace_back(At(vertices[i]));
        if (has_wedge) {
          corner[1] = UvIndex(static_cast<float>(uvs[each * i]), static_cast<float>(uvs[each * i + 1]));
        }
        if (color) corner[3] = static_cast<std::int32_t>(pools_.colors.size()) - 1;
      }
    });
  }

  // Equal coordinates of corners share an index, so that their vertices are shared.
  std::int32_t UvIndex(float u, float v) {
    const auto [at, is_new] = uv_index_.try_emplace({u, v}, static_cast<std::int32_t>(pools_.uvs.size()));
    if (is_new) pools_.uvs.emplace_back(u, v);
    return at->second;
  }

  // Triangle strips, each terminated by -1.
  void AppendStrips(const std::vector<double>& indices) {
    Polygons& part = parts_[{0, false}];
    std::size_t first = 0;
    for (std::size_t i = 0; i < indices.size(); ++i) {
      if (indices[i] < 0) {
        first = i + 1;
      } else if (i >= first + 2) {
        const bool odd = (i - first) % 2 == 1;
        for (const std::size_t k : {i - 2, odd ? i : i - 1, odd ? i - 1 : i}) part.corners.push_back(At(indices[k]));
        part.sizes.push_back(3);
      }
    }
  }

  void Build() {
    Box used;
    for (const auto& [key, part] : parts_) {
      if (const std::string problem = IndexProblem(part, pools_); !problem.empty()) throw std::runtime_error(problem);
      used.Add(part, pools_);
    }
    import_.origin = OriginFor(used);
    ScaleColors(pools_, import_.warnings);
    auto& [nodes, meshes, materials, pictures] = import_.scene;
    std::size_t without_uv = 0, without_texture = 0;
    for (const auto& [key, part] : parts_) {
      ImportedMesh& mesh = meshes.emplace_back();
      const auto texture = static_cast<std::size_t>(key.first);
      mesh.material = static_cast<unsigned>(materials.size());
      ImportedMaterial& material =
          materials.emplace_back(ImportedMaterial{texture < textures_.size() ? textures_[texture] : ""});
      const bool has_uv = !part.corners.empty() && part.corners[0][1] >= 0;
      if (has_uv) material.color_map.picture = material.name;
      if (!material.name.empty() && !has_uv) without_uv += part.sizes.size();
      if (!textures_.empty() && texture >= textures_.size()) without_texture += part.sizes.size();
      AppendPolygons(part, pools_, import_.origin, mesh);
    }
    nodes.push_back(NodeOfAll(meshes));
    if (without_uv > 0)
      import_.warnings.push_back(
          std::to_string(without_uv) + " of its faces have a picture (TextureFile) but no " +
          "texture coordinates that are known (s t, u v, texture_u ..., texcoord): it is left out");
    if (without_texture > 0)
      import_.warnings.push_back(std::to_string(without_texture) + " of its faces name a picture (texnumber) that is " +
                                 "not one of its " + std::to_string(textures_.size()) + ": they have none");
  }

  MeshImport& import_;
  std::string text_;
  std::string_view rest_;  // what has not been read
  bool is_text_ = false, is_big_ = false;
  std::vector<Element> elements_;
  std::vector<std::string> textures_;
  PolygonPools pools_;
  Vertex vertex_;
  std::map<std::pair<float, float>, std::int32_t> uv_index_;
  std::map<std::pair<int, bool>, Polygons> parts_;  // by texture, and whether corners lack coordinates
};

}  // namespace

void ReadPly(MeshFiles& files, MeshImport& import) {
  try {
    PlyReader(files, import).Read();
  } catch (const std::runtime_error& error) {
    import.problem = std::string("cannot be read: ") + error.what();
  }
}

}  // namespace sim
