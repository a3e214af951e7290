#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "sim/world/gltf_file.h"
#include "sim/world/gltf_material.h"
#include "sim/world/gltf_vertices.h"
#include "sim/world/mesh_builder.h"
#include "sim/world/mesh_readers.h"

namespace sim {
namespace {

using nlohmann::json;

constexpr int kDeepestNode = 1000;
constexpr int kTriangles = 4, kStrip = 5, kFan = 6;  // modes of a primitive
constexpr std::size_t kMostInstances = 1 << 20, kMostUvSets = 8;

// Appearance without an unsupported extension; empty: it is supported.
constexpr std::pair<std::string_view, std::string_view> kExtensions[] = {
    {"KHR_texture_transform", ""},
    {"KHR_materials_emissive_strength", ""},
    {"KHR_mesh_quantization", ""},
    {"KHR_materials_pbrSpecularGlossiness", ""},
    {"KHR_materials_unlit", ""},
    {"KHR_draco_mesh_compression", ""},
    {"EXT_meshopt_compression", ""},
    {"KHR_meshopt_compression", ""},
    {"EXT_texture_webp", ""},
    {"EXT_mesh_gpu_instancing", ""},
    {"KHR_texture_basisu", ""},  // a picture without another version is rejected
    {"KHR_node_visibility", ""},
    {"FB_ngon_encoding", ""},  // of polygons: the triangles are the same
    {"KHR_xmp_json_ld", ""},
    {"EXT_structural_metadata", ""},
    {"EXT_mesh_features", ""},
    {"MSFT_lod", ""},  // the finest level is the node's own
    {"KHR_lights_punctual", "the file's own lights are not used: lights are the scenario's"},
    {"KHR_materials_clearcoat", "clear coats are not rendered: the surface below is"},
    {"KHR_materials_transmission", "transmission is not rendered: the surface is opaque"},
    {"KHR_materials_volume", "volumes are not rendered: the surface is opaque"},
    {"KHR_materials_sheen", "sheen is not rendered"},
    {"KHR_materials_specular", "reflections are not rendered"},
    {"KHR_materials_diffuse_transmission", "transmission is not rendered: the surface is opaque"},
    {"KHR_materials_ior", "refraction is not rendered"},
    {"KHR_materials_dispersion", "refraction is not rendered"},
    {"KHR_materials_iridescence", "iridescence is not rendered"},
    {"KHR_materials_anisotropy", "reflections are not rendered"},
    {"KHR_materials_variants", "the default variant is rendered"},
};

// An extension that the file requires.
struct Unsupported : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class GltfReader {
 public:
  GltfReader(MeshFiles& files, MeshImport& import) : file_(files, import), import_(import), materials_(file_, import) {}

  void Read() {
    CheckExtensions();
    if (!GltfFile::Child(file_.document(), "animations").empty())
      Warn("has animations: the scene is rendered as it stands without them");
    for (const std::size_t root : Roots()) ReadNode(root, glm::dmat4(1), 0, &GltfReader::AppendInstances);
    std::set<MeshKey> shown;
    for (const Instance& instance : instances_) shown.insert(instance.mesh);
    for (const MeshKey& mesh : shown) ReadItem("meshes", mesh.first, [&] { ReadMesh(mesh); });
    AppendNodes();
    if (import_.scene.meshes.empty())
      import_.problem = std::string("has no triangles: ") +
                        (shown.empty() ? "its scene shows no mesh" : "its meshes are empty, or of points and lines");
  }

  void ReadCameras() {
    for (const std::size_t root : Roots()) ReadNode(root, glm::dmat4(1), 0, &GltfReader::AppendCamera);
  }

 private:
  void Warn(const std::string& what) { WarnOnce(import_, what); }

  void CheckExtensions() {
    const auto names = [&](const char* key) {
      const json& list = GltfFile::Child(file_.document(), key);
      return list.is_array() ? list.get<std::set<std::string>>() : std::set<std::string>{};
    };
    const std::set<std::string> required = names("extensionsRequired"), used = names("extensionsUsed");
    std::string refused;
    const auto known = [](const std::string& name) {
      return std::find_if(std::begin(kExtensions), std::end(kExtensions), [&](auto& e) { return e.first == name; });
    };
    for (const std::string& name : required) {
      if (known(name) == std::end(kExtensions)) refused += (refused.empty() ? "" : ", ") + name;
    }
    if (!refused.empty())
      throw Unsupported("requires " + refused + ", which is not supported: convert the file without it");
    for (const std::string& name : used) {
      const auto* at = known(name);
      const std::string instead(at != std::end(kExtensions) ? at->second : "it is left out");
      if (!instead.empty()) Warn("uses " + name + ": " + instead);
    }
  }

  // ---------------------------------------------------------------------------------------------------- meshes

  using MeshKey = std::pair<std::size_t, std::optional<std::size_t>>;  // in the document; with the skin that poses it

  void ReadMesh(const MeshKey& key) {
    const std::size_t index = key.first;
    const json& mesh = file_.At("meshes", index);
    std::vector<unsigned>& parts = meshes_[key];
    const std::vector<glm::dmat4> joints = key.second ? JointsOf(*key.second) : std::vector<glm::dmat4>();
    for (const json& primitive : GltfFile::Child(mesh, "primitives")) {
      const int mode = primitive.value("mode", kTriangles);
      if (mode < kTriangles || mode > kFan) {
        Warn("has points or lines: they are left out");
        continue;
      }
      ImportedMesh built;
      built.name = mesh.value("name", "meshes[" + std::to_string(index) + "]");
      built.material = materials_.MaterialOf(primitive);
      ReadPrimitive(primitive, mode, joints, built);
      if (built.positions.empty()) continue;
      parts.push_back(static_cast<unsigned>(import_.scene.meshes.size()));
      import_.scene.meshes.push_back(std::move(built));
    }
  }

  void ReadPrimitive(const json& primitive, int mode, const std::vector<glm::dmat4>& joints, ImportedMesh& mesh) {
    const json& attributes = GltfFile::Child(primitive, "attributes");
    std::optional<DracoMesh> draco;
    if (const json* how = GltfFile::Extension(primitive, "KHR_draco_mesh_compression")) {
      std::map<std::string, DracoAttribute> wanted;
      for (const auto& [name, id] : GltfFile::Child(*how, "attributes").items()) {
        const json& accessor = file_.At("accessors", GltfFile::Index(attributes, name.c_str()));
        wanted[name] = {id.get<std::uint32_t>(), accessor.value("componentType", 0),
                        accessor.value("normalized", false)};
      }
      draco = DecodeDraco(file_.View(GltfFile::Index(*how, "bufferView")), wanted);
    }
    const auto table = [&](const std::string& name, std::size_t least) -> std::optional<GltfTable> {
      std::optional<GltfTable> read;
      if (draco && draco->attributes.contains(name)) {
        read = draco->attributes[name];
      } else if (attributes.contains(name)) {
        read = file_.ReadTable(GltfFile::Index(attributes, name.c_str()));
      }
      if (read && (read->columns < least || (!mesh.positions.empty() && read->count != mesh.positions.size())))
        throw std::runtime_error("the attribute " + name + " does not fit its mesh");
      return read;
    };
    const auto positions = table("POSITION", 3);
    if (!positions) return;
    const auto append = [](const GltfTable& from, std::vector<glm::vec3>& to) {
      to.reserve(from.count);
      for (std::size_t i = 0; i < from.count; ++i) to.emplace_back(from.at(i, 0), from.at(i, 1), from.at(i, 2));
    };
    append(*positions, mesh.positions);
    if (const auto normals = table("NORMAL", 3)) append(*normals, mesh.normals);
    std::vector<JointWeights> weights;
    for (const std::string set : {"_0", "_1"}) {
      if (joints.empty()) break;
      auto of = table("JOINTS" + set, 4), by = table("WEIGHTS" + set, 4);
      if (of && by) weights.push_back({std::move(*of), std::move(*by)});
    }
    if (!joints.empty()) PoseVertices(weights, joints, mesh);
    if (const auto colors = table("COLOR_0", 3)) {
      const json& accessor = file_.At("accessors", GltfFile::Index(attributes, "COLOR_0"));
      const int type = accessor.value("componentType", 0);
      const float unit = accessor.value("normalized", false) ? 1 : GltfFile::Normalised(1, type, true);
      if (unit != 1) Warn("vertex colours are whole numbers that are not normalised: they are taken as if they were");
      for (std::size_t i = 0; i < colors->count; ++i)
        mesh.colors.emplace_back(unit * colors->at(i, 0), unit * colors->at(i, 1), unit * colors->at(i, 2),
                                 colors->columns > 3 ? unit * colors->at(i, 3) : 1.0f);
    }
    for (std::size_t set = 0; set < kMostUvSets; ++set) {
      const auto uvs = table("TEXCOORD_" + std::to_string(set), 2);
      if (!uvs) continue;
      mesh.uvs.resize(set + 1);
      mesh.uvs[set].reserve(uvs->count);
      for (std::size_t i = 0; i < uvs->count; ++i) mesh.uvs[set].emplace_back(uvs->at(i, 0), 1 - uvs->at(i, 1));
    }
    std::vector<std::uint32_t> indices;
    if (draco) {
      indices = std::move(draco->indices);
      mode = kTriangles;
    } else if (primitive.contains("indices")) {
      indices = file_.ReadIndices(GltfFile::Index(primitive, "indices"));
    } else {
      indices.resize(mesh.positions.size());
      std::iota(indices.begin(), indices.end(), 0u);
    }
    AppendTriangles(indices, mode, mesh);
    const UvChoice& uv = import_.scene.materials[mesh.material].normal_map.uv;
    if (import_.scene.materials[mesh.material].normal_map.picture.empty() || uv.channel >= mesh.uvs.size()) return;
    if (const auto tangents = table("TANGENT", 4); tangents && ContradictsUvs(*tangents, mesh, uv))
      Warn("has tangents that are not those of the texture coordinates: normal maps follow the coordinates");
  }

  // Of each joint of a skin: the file's space from that of the mesh.
  std::vector<glm::dmat4> JointsOf(std::size_t index) {
    const json& skin = file_.At("skins", index);
    const std::vector<std::size_t> nodes = GltfFile::Indices(skin, "joints");
    GltfTable inverses;
    if (skin.contains("inverseBindMatrices")) {
      inverses = file_.ReadTable(GltfFile::Index(skin, "inverseBindMatrices"));
      if (inverses.columns != 16 || inverses.count < nodes.size())
        throw std::runtime_error("the inverseBindMatrices of its skin are not one for each joint");
    }
    std::vector<glm::dmat4> joints;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto found = transforms_.find(nodes[i]);
      joints.push_back(found == transforms_.end() ? glm::dmat4(1) : found->second);
      glm::dmat4 inverse(1);
      for (int k = 0; k < 16 && inverses.count > 0; ++k)
        inverse[k / 4][k % 4] = inverses.at(i, static_cast<std::size_t>(k));
      joints.back() *= inverse;
    }
    return joints;
  }

  static void AppendTriangles(const std::vector<std::uint32_t>& indices, int mode, ImportedMesh& mesh) {
    const std::size_t n = indices.size(), step = mode == kTriangles ? 3 : 1;
    mesh.triangles.reserve(n / step);
    for (std::size_t i = 0; i + 2 < n; i += step) {
      if (mode == kFan) {
        mesh.triangles.emplace_back(indices[0], indices[i + 1], indices[i + 2]);
      } else {
        const bool odd = mode == kStrip && i % 2 == 1;
        mesh.triangles.emplace_back(indices[i], indices[i + (odd ? 2 : 1)], indices[i + (odd ? 1 : 2)]);
      }
    }
  }

  // ----------------------------------------------------------------------------------------------------- nodes

  struct Instance {
    glm::dmat4 transform;
    MeshKey mesh;
  };

  static glm::dmat4 FromTrs(const glm::dvec3& t, const glm::dquat& r, const glm::dvec3& s) {
    glm::dmat4 m = glm::mat4_cast(glm::normalize(r));
    for (int c = 0; c < 3; ++c) m[c] *= s[c];
    m[3] = glm::dvec4(t, 1);
    return m;
  }
  static glm::dmat4 TransformOf(const json& node) {
    if (node.contains("matrix")) {
      const auto m = node["matrix"].get<std::array<double, 16>>();
      return {m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10], m[11], m[12], m[13], m[14], m[15]};
    }
    const auto t = GltfFile::Numbers<3>(node, "translation", {0, 0, 0}),
               s = GltfFile::Numbers<3>(node, "scale", {1, 1, 1});
    const auto q = GltfFile::Numbers<4>(node, "rotation", {0, 0, 0, 1});
    return FromTrs({t[0], t[1], t[2]}, {q[3], q[0], q[1], q[2]}, {s[0], s[1], s[2]});
  }

  // append(node, its transform), of all nodes; of an invisible one and its children cameras alone.
  using Append = void (GltfReader::*)(const json&, const glm::dmat4&);
  void ReadNode(std::size_t index, const glm::dmat4& parent, int depth, Append append) {
    if (depth > kDeepestNode) throw std::runtime_error("has nodes more than 1000 deep, or in a circle");
    const json& node = file_.At("nodes", index);
    const json* visibility = GltfFile::Extension(node, "KHR_node_visibility");
    if (append != &GltfReader::AppendCamera && visibility != nullptr && !visibility->value("visible", true)) return;
    glm::dmat4 transform(1);
    const auto children = ReadItem("nodes", index, [&] {
      transform = transforms_[index] = parent * TransformOf(node);
      CheckFinite(transform);
      (this->*append)(node, transform);
      return GltfFile::Indices(node, "children");
    });
    for (const std::size_t child : children) ReadNode(child, transform, depth + 1, append);
  }

  static void CheckFinite(const glm::dmat4& transform) {
    for (int i = 0; i < 16; ++i) {
      if (!(std::abs(transform[i / 4][i % 4]) <= std::numeric_limits<float>::max()))
        throw std::runtime_error("its transform is not finite, or beyond 3.4e38");
    }
  }

  void AppendCamera(const json& node, const glm::dmat4& transform) {
    if (!node.contains("camera")) return;
    const std::size_t index = GltfFile::Index(node, "camera");
    const json& camera = file_.At("cameras", index);
    const std::string own = camera.value("name", "cameras[" + std::to_string(index) + "]");
    const bool is_perspective = camera.at("type") == "perspective";
    const json& lens = GltfFile::Child(camera, "perspective");
    import_.cameras.push_back({node.value("name", own), transform, is_perspective ? lens.at("yfov").get<double>() : 0.0,
                               lens.value("aspectRatio", 0.0)});
    if (import_.cameras.size() > kMostInstances) throw std::runtime_error("has more cameras than are read");
  }

  static bool IsSkinned(const json& mesh) {
    const json& primitives = GltfFile::Child(mesh, "primitives");
    return std::any_of(primitives.begin(), primitives.end(),
                       [](const json& p) { return GltfFile::Child(p, "attributes").contains("JOINTS_0"); });
  }

  static bool Morphs(const json& node, const json& mesh) {
    const json &weights = GltfFile::Child(node.contains("weights") ? node : mesh, "weights"),
               &primitives = GltfFile::Child(mesh, "primitives");
    return std::any_of(weights.begin(), weights.end(), [](const json& w) { return w != 0.0; }) &&
           std::any_of(primitives.begin(), primitives.end(), [](const json& p) { return p.contains("targets"); });
  }

  void AppendInstances(const json& node, const glm::dmat4& transform) {
    if (!node.contains("mesh")) return;
    const std::size_t mesh = GltfFile::Index(node, "mesh");
    if (Morphs(node, file_.At("meshes", mesh))) Warn("has morph targets: the meshes are rendered without them");
    const json* instancing = GltfFile::Extension(node, "EXT_mesh_gpu_instancing");
    if (node.contains("skin") && IsSkinned(file_.At("meshes", mesh))) {  // its node's transform does not count
      instances_.push_back({glm::dmat4(1), {mesh, GltfFile::Index(node, "skin")}});
    } else if (instancing == nullptr) {
      instances_.push_back({transform, {mesh, {}}});
    } else {
      const json& attributes = GltfFile::Child(*instancing, "attributes");
      std::map<std::string, GltfTable> tables;
      std::optional<std::size_t> count;
      for (const auto& [name, columns] : {std::pair{"TRANSLATION", 3u}, {"ROTATION", 4u}, {"SCALE", 3u}}) {
        if (!attributes.contains(name)) continue;
        const GltfTable& table = tables[name] = file_.ReadTable(GltfFile::Index(attributes, name));
        if (table.columns != columns || table.count != count.value_or(table.count))
          throw std::runtime_error(std::string("EXT_mesh_gpu_instancing: ") + name +
                                   " is of another type or count than it must be");
        count = table.count;
      }
      for (std::size_t i = 0; i < count.value_or(0); ++i) {
        const auto row = [&](const char* name, const glm::dvec4& otherwise) {
          const auto at = tables.find(name);
          if (at == tables.end()) return otherwise;
          glm::dvec4 values(0);
          for (std::size_t c = 0; c < at->second.columns; ++c) values[static_cast<int>(c)] = at->second.at(i, c);
          return values;
        };
        const glm::dvec4 q = row("ROTATION", {0, 0, 0, 1});
        instances_.push_back(
            {transform * FromTrs(row("TRANSLATION", glm::dvec4(0)), {q.w, q.x, q.y, q.z}, row("SCALE", glm::dvec4(1))),
             {mesh, {}}});
        CheckFinite(instances_.back().transform);
        if (instances_.size() > kMostInstances) break;
      }
    }
    if (instances_.size() > kMostInstances)
      throw std::runtime_error("has more placed meshes than are read: " + std::to_string(kMostInstances));
  }

  // The default scene, or all nodes that are no children.
  std::vector<std::size_t> Roots() const {
    const json& document = file_.document();
    if (document.contains("scene") || !GltfFile::Child(document, "scenes").empty()) {
      const json& scene = file_.At("scenes", document.contains("scene") ? GltfFile::Index(document, "scene") : 0);
      return GltfFile::Indices(scene, "nodes");
    }
    const json& nodes = GltfFile::Child(document, "nodes");
    std::vector<bool> is_child(nodes.size());
    for (const json& node : nodes) {
      for (const std::size_t child : GltfFile::Indices(node, "children")) {
        if (child < is_child.size()) is_child[child] = true;
      }
    }
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i) {
      if (!is_child[i]) roots.push_back(i);
    }
    return roots;
  }

  void AppendNodes() {
    std::vector<glm::dvec3> places;
    for (const Instance& instance : instances_) places.emplace_back(instance.transform[3]);
    constexpr double kFar = 1e4;
    if (std::ranges::any_of(places, [](const glm::dvec3& x) { return glm::length(x) > kFar; }))
      import_.origin = OriginFor(places);
    for (Instance& instance : instances_) {
      instance.transform[3] -= glm::dvec4(import_.origin, 0);
      import_.scene.nodes.push_back({-1, glm::mat4(instance.transform), meshes_[instance.mesh]});
    }
  }

  GltfFile file_;
  MeshImport& import_;
  GltfMaterials materials_;
  std::map<MeshKey, std::vector<unsigned>> meshes_;  // of the scene's
  std::map<std::size_t, glm::dmat4> transforms_;     // of nodes
  std::vector<Instance> instances_;
};

void ReadBy(void (GltfReader::*read)(), MeshFiles& files, MeshImport& import) {
  const auto fail = [&](const std::string& problem) { import.problem = problem; };
  try {
    (GltfReader(files, import).*read)();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const Unsupported& error) {
    fail(error.what());
  } catch (const json::exception& error) {
    fail("cannot be read: is not glTF as its schema has it: " + TextOf(error));
  } catch (const std::exception& error) {
    fail(std::string("cannot be read: ") + error.what());
  }
}

}  // namespace

void ReadGltf(MeshFiles& files, MeshImport& import) { ReadBy(&GltfReader::Read, files, import); }

void ReadGltfCameras(MeshFiles& files, MeshImport& import) { ReadBy(&GltfReader::ReadCameras, files, import); }

}  // namespace sim
