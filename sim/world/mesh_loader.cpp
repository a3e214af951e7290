#include "sim/world/mesh_loader.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <glm/vector_relational.hpp>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>

#include "sim/world/coincident_faces.h"
#include "sim/world/mesh_import.h"
#include "sim/world/mesh_material.h"
#include "sim/world/texture_file.h"
#include "tools/base/text.h"

namespace sim {
namespace {

namespace fs = std::filesystem;

// Whether three corners lie on a line, within the rounding of floats.
bool IsDegenerate(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::dvec3 ab = glm::dvec3(b) - glm::dvec3(a), ac = glm::dvec3(c) - glm::dvec3(a),
                   bc = glm::dvec3(c) - glm::dvec3(b);
  const double longest2 = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
  return !(glm::length(glm::cross(ab, ac)) > 1e-10 * longest2);
}

template <int n>
bool IsFinite(const glm::vec<n, float>& v) {
  return !glm::any(glm::isnan(v)) && !glm::any(glm::isinf(v));
}

template <int n>
std::string ToText(const glm::vec<n, float>& v) {
  std::ostringstream text;
  for (int i = 0; i < n; ++i) text << (i == 0 ? "(" : ", ") << v[i];
  return text.str() + ")";
}

class FileReader {
 public:
  FileReader(const MeshFile& file, const MeshDescription& description) : file_(file), description_(description) {
    world_from_file_ = glm::mat4_cast(description.orientation);
    for (int c = 0; c < 3; ++c) world_from_file_[c] *= description.scale * description.stretch[c];
    world_from_file_[3] = glm::dvec4(description.position, 1.0);
  }

  void Read() {
    std::error_code error;
    if (!fs::exists(file_.path, error)) return file_.Problem("no such file");
    if (!fs::is_regular_file(file_.path, error)) return file_.Problem("not a file");

    MeshImport import = ImportMesh(file_.path, file_.loading.folders);
    file_.scene.files.insert(import.files.begin(), import.files.end());
    if (!import.problem.empty()) return file_.Problem(import.problem);
    ImportedScene& from = import.scene;
    ReplaceMaterials(from);
    world_from_file_[3] += world_from_file_ * glm::dvec4(import.origin, 0.0);
    for (const std::string& missing : import.missing) file_.Warn("names " + missing + ", ", "which cannot be opened");
    for (const std::string& warning : import.warnings) file_.Warn("", warning);

    materials_.emplace(file_, from);
    const std::size_t problems_before = file_.loading.problems.size(), meshes_before = file_.scene.meshes.size();
    std::vector<glm::dmat4> world_from_node;
    for (const ImportedNode& node : from.nodes) {
      const glm::dmat4& parent =
          node.parent < 0 ? world_from_file_ : world_from_node[static_cast<std::size_t>(node.parent)];
      world_from_node.push_back(parent * glm::dmat4(node.transform));
      for (const unsigned mesh : node.meshes) AppendMesh(from.meshes[mesh], world_from_node.back());
    }
    if (file_.loading.problems.size() == problems_before && file_.scene.meshes.size() == meshes_before)
      file_.Problem("has no triangles" + why_none_);
    SeparateCoincidentFaces(file_.scene.meshes, meshes_before);
  }

 private:
  // Replaces materials by the scenario's: one for all, or some by name.
  void ReplaceMaterials(ImportedScene& scene) {
    const auto replace = [&](const MaterialDescription& by, const auto& is_replaced) {
      ImportedMaterial material;
      material.name = by.name;
      material.base_color = glm::vec4(by.color.value_or(glm::dvec3(1)), 1);
      if (!by.texture.empty()) material.color_map.picture = fs::absolute(by.texture).string();
      for (ImportedMesh& mesh : scene.meshes)
        if (is_replaced(scene.materials[mesh.material])) mesh.colors.clear();
      return std::ranges::count_if(scene.materials, [&](ImportedMaterial& each) {
        const bool replaced = is_replaced(each);
        if (replaced) each = material;
        return replaced;
      });
    };
    if (description_.color || !description_.texture.empty())
      replace({description_.name, description_.color, description_.texture}, [](const auto&) { return true; });
    for (const MaterialDescription& by : description_.materials) {
      if (replace(by, [&](const ImportedMaterial& material) { return material.name == by.name; }) > 0) continue;
      std::vector<std::string> names;
      for (const ImportedMaterial& material : scene.materials) names.push_back("'" + material.name + "'");
      file_.Problem("has no material '" + by.name + "', which the scenario replaces; it has " +
                    base::Join(names, ", "));
    }
  }

  void AppendMesh(const ImportedMesh& in, const glm::dmat4& world_from_node) {
    if (in.positions.empty()) return;
    Mesh out;
    out.name = in.name.empty() ? "mesh " + std::to_string(file_.scene.meshes.size()) : in.name;
    const std::string label = "mesh '" + out.name + "': ";
    const glm::dmat3 linear(world_from_node);
    if (!std::isfinite(glm::determinant(linear))) return file_.Problem(label + "its node's transform is not finite");
    why_none_ = ": its nodes have a scale of 0";
    if (linear == glm::dmat3(0)) return;  // glTF 2.0, 3.5.3: it is hidden

    const bool mirrored = glm::determinant(linear) < 0;  // the front stays in front
    // Cofactors: the inverse's transpose times the determinant, also where a scale of 0 makes the mesh flat.
    const glm::dmat3 normal_transform =
        (mirrored ? -1.0 : 1.0) * glm::dmat3(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                                             glm::cross(linear[0], linear[1]));

    out.positions.reserve(in.positions.size());
    for (const glm::vec3& v : in.positions) {
      const std::size_t i = out.positions.size();
      const glm::vec3 x(world_from_node * glm::dvec4(v, 1.0));
      if (!IsFinite(x)) {
        return file_.Problem(label + "vertex " + std::to_string(i) + " is not finite: " + ToText(v));
      }
      out.positions.push_back(x);
    }
    AppendNormals(in, normal_transform, label, out);
    if (!in.colors.empty()) {
      const auto linear_of = [&](float c) { return file_.is_gltf ? c : static_cast<float>(SrgbToLinear(c)); };
      for (const glm::vec4& c : in.colors) {
        if (!IsFinite(glm::vec3(c))) {
          return file_.Problem(label + "the colour of vertex " + std::to_string(out.colors.size()) + " is not finite");
        }
        out.colors.emplace_back(linear_of(c.r), linear_of(c.g), linear_of(c.b));
      }
    }
    std::size_t degenerate = 0;
    out.triangles.reserve(in.triangles.size());
    for (glm::uvec3 t : in.triangles) {
      if (std::max({t.x, t.y, t.z}) >= in.positions.size()) {
        const std::size_t i = out.triangles.size() + degenerate;
        return file_.Problem(label + "triangle " + std::to_string(i) + " names a vertex that does not exist");
      }
      if (IsDegenerate(out.positions[t.x], out.positions[t.y], out.positions[t.z])) {
        ++degenerate;
        continue;
      }
      if (mirrored) std::swap(t.y, t.z);
      out.triangles.push_back(t);
    }
    if (degenerate > 0) {
      file_.Warn(label + std::to_string(degenerate) + " of " + std::to_string(in.triangles.size()) + " ",
                 "triangles without area are left out");
    }
    why_none_ = ": all are without area";
    if (out.triangles.empty()) return;
    const bool is_moved = description_.position != glm::dvec3(0);  // what is coarse in the file stays so
    if ((is_moved && !CheckRounding(label, in.positions, "convert it to OBJ or PLY, which are read in double")) ||
        !CheckRounding(label, out.positions, "move it near the origin with 'position'"))
      return;
    const MeshMaterial& material = materials_->Material(in.material);
    out.material = material.index;
    AppendUvs(in, material.uv, label, out);
    FoldColors(in, material.is_unlit, label, out);
    const bool has_picture = !file_.is_gltf &&
                             file_.scene.materials[static_cast<std::size_t>(out.material)].texture >= 0 &&
                             !out.uvs.empty();
    const auto is_white = [](const glm::vec3& color) { return color == glm::vec3(1); };
    if (has_picture && !std::ranges::all_of(out.colors, is_white)) {
      file_.Warn(label, "a picture takes the place of vertex colours");
      out.colors.clear();
    }
    const Material& used = file_.scene.materials[static_cast<std::size_t>(out.material)];
    if (used.alpha_cutoff > 0)
      file_.loading.cut_outs.try_emplace(out.material, file_.path.string() + ": material '" + used.name + "': ");
    file_.scene.meshes.push_back(std::move(out));
  }

  // The copy of a mesh's material that is its own.
  Material& OwnMaterial(Mesh& mesh) {
    std::vector<Material>& all = file_.scene.materials;
    all.push_back(Material(all[static_cast<std::size_t>(mesh.material)]));
    mesh.material = static_cast<int>(all.size()) - 1;
    return all.back();
  }

  // The part of vertex colours that renderers do not apply goes into the material: alpha, and the colour of what is
  // unlit.
  void FoldColors(const ImportedMesh& in, bool is_unlit, const std::string& label, Mesh& out) {
    if (in.colors.empty()) return;
    const bool cuts = file_.scene.materials[static_cast<std::size_t>(out.material)].alpha_cutoff > 0;
    const float alpha = in.colors[0].a;
    const bool same_alpha = std::ranges::all_of(in.colors, [&](const glm::vec4& c) { return c.a == alpha; });
    if (cuts && !same_alpha) file_.Warn(label, "the alpha of its vertex colours is not used");
    if (cuts && same_alpha && alpha != 1 && file_.is_gltf) OwnMaterial(out).alpha *= alpha;
    if (!is_unlit) return;
    glm::dvec3 mean(0);
    for (const glm::vec3& c : out.colors) mean += glm::dvec3(c) / static_cast<double>(out.colors.size());
    if (std::ranges::any_of(out.colors, [&](const glm::vec3& c) { return c != out.colors[0]; }))
      file_.Warn(label, "vertex colours of an unlit material are their mean");
    if (mean != glm::dvec3(1)) OwnMaterial(out).emission *= glm::vec3(mean);
    out.colors.clear();
  }

  // Coordinates are floats, which are coarse far from the origin. Warns when the rounding is 1e-5 of the mesh's size,
  // and rejects it at 1e-3.
  bool CheckRounding(const std::string& label, const std::vector<glm::vec3>& positions, const char* remedy) {
    glm::vec3 low = positions[0], high = low;
    for (const glm::vec3& x : positions) low = glm::min(low, x), high = glm::max(high, x);
    const glm::vec3 far = glm::max(glm::abs(low), glm::abs(high));
    const double rounding = 0x1p-24 * std::max({far.x, far.y, far.z}),
                 size = glm::length(glm::dvec3(high) - glm::dvec3(low));
    if (rounding <= 1e-5 * size) return true;
    const glm::dvec3 middle = 0.5 * (glm::dvec3(low) + glm::dvec3(high));
    std::ostringstream text;
    text << label << "it lies near (" << middle.x << ", " << middle.y << ", " << middle.z << "), where numbers are "
         << rounding << " coarse, but is only " << size << " large: " << remedy;
    if (rounding > 1e-3 * size) {
      file_.Problem(text.str());
      return false;
    }
    file_.Warn(text.str(), "");
    return true;
  }

  void AppendNormals(const ImportedMesh& in, const glm::dmat3& transform, const std::string& label, Mesh& out) {
    out.normals.reserve(in.normals.size());
    for (const glm::vec3& v : in.normals) {
      const glm::dvec3 n = transform * glm::dvec3(v);
      const double length = glm::length(n);
      if (!(length > 0) || !std::isfinite(length)) {
        file_.Warn(label + "the normal of vertex " + std::to_string(out.normals.size()) + " is " + ToText(v) + "; ",
                   "flat normals are used");
        out.normals.clear();
        return;
      }
      out.normals.emplace_back(n / length);
    }
  }

  void AppendUvs(const ImportedMesh& in, const UvChoice& choice, const std::string& label, Mesh& out) {
    const Material& material = file_.scene.materials[static_cast<std::size_t>(out.material)];
    const int texture = material.texture >= 0
                            ? material.texture
                            : std::max({material.emission_texture, material.normal_map, material.gloss_texture});
    if (texture < 0) return;
    const auto has = [&](std::size_t set) { return set < in.uvs.size() && !in.uvs[set].empty(); };
    const std::size_t set = !has(choice.channel) && !file_.is_gltf && in.uvs.size() == 1 ? 0 : choice.channel;
    if (!has(set)) {
      const std::string& name = file_.scene.textures[static_cast<std::size_t>(texture)].name();
      file_.Warn(label + "no texture coordinates for texture " + name + "; ", "the base colour is used");
      Material& plain = OwnMaterial(out);
      plain.texture = plain.emission_texture = plain.normal_map = plain.gloss_texture = -1;
      return;
    }
    for (const glm::vec2& uv : in.uvs[set]) {
      if (!IsFinite(uv)) {
        return file_.Problem(label + "the texture coordinate of vertex " + std::to_string(out.uvs.size()) +
                             " is not finite: " + ToText(uv));
      }
      out.uvs.emplace_back(choice.transform * glm::dvec3(uv.x, 1.0 - static_cast<double>(uv.y), 1.0));  // v down
    }
    if (choice.wrap[0] == UvWrap::repeat && choice.wrap[1] == UvWrap::repeat) return;
    LoadPictures(file_.loading);  // its size counts
    const Texture& picture = file_.scene.textures[static_cast<std::size_t>(texture)];
    for (const int axis : {0, 1}) {
      if (!WrapUvs(out, axis, choice.wrap[static_cast<std::size_t>(axis)],
                   axis == 0 ? picture.width() : picture.height()))
        file_.Warn(label, "a mirrored texture comes more than 100 times: it is repeated as it is");
    }
  }

  const MeshFile& file_;
  const MeshDescription& description_;
  glm::dmat4 world_from_file_{1.0};
  std::optional<MeshMaterialReader> materials_;
  std::string why_none_;  // of triangles
};

}  // namespace

void WarningList::Add(const std::string& who, const std::string& what) {
  const auto known = std::ranges::find(kinds_, what, &Kind::what);
  if (known == kinds_.end() || what.empty()) {
    kinds_.push_back({what, who, 1});
  } else {
    ++known->count;
  }
}

std::vector<std::string> WarningList::Summed() const {
  std::vector<std::string> texts;
  for (const Kind& kind : kinds_) {
    texts.push_back(kind.count == 1
                        ? kind.first + kind.what
                        : std::to_string(kind.count) + " × " + kind.what + " (first: " + kind.first + "...)");
  }
  return texts;
}

void AppendMeshFile(const MeshDescription& description, WorldLoading& loading) {
  const std::string extension = LowerExtension(description.file);
  const MeshFile file{description.file, extension, extension == ".gltf" || extension == ".glb",
                      loading.scene,    loading,   description.place};
  FileReader(file, description).Read();
}

}  // namespace sim
