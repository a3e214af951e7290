#include "sim/world/imported_scene.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace sim {
namespace {

constexpr std::uint64_t kMostVertices = 1 << 27;  // and corners of faces
constexpr std::uint64_t kMostNodes = 1 << 20;     // and meshes, materials
constexpr std::uint64_t kMostPictureBytes = std::uint64_t{1} << 32;

std::runtime_error Broken() { return std::runtime_error("the importer's answer is broken off"); }

// One function per type, Pass, describes both directions.
class Writer {
 public:
  static constexpr bool kReads = false;
  explicit Writer(const ByteSink& sink) : sink_(sink) {}
  // Long lists are not copied.
  void Copy(void* from, std::size_t size) {
    const std::span bytes(static_cast<const std::uint8_t*>(from), size);
    if (size >= kLong) {
      Flush();
      return sink_(bytes);
    }
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    if (bytes_.size() >= kLong) Flush();
  }
  void Flush() {
    sink_(bytes_);
    bytes_.clear();
  }
  void CheckCount(std::uint64_t /*count*/, std::size_t /*least*/) const {}

 private:
  static constexpr std::size_t kLong = 1 << 16;

  const ByteSink& sink_;
  std::vector<std::uint8_t> bytes_;
};

class Reader {
 public:
  static constexpr bool kReads = true;
  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  void Copy(void* to, std::size_t size) {
    if (size > bytes_.size()) throw Broken();
    if (size > 0) std::memcpy(to, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
  }
  // Of things that take `least` bytes each.
  void CheckCount(std::uint64_t count, std::size_t least) const {
    if (count > bytes_.size() / least) throw Broken();
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

template <class Io, class T>
void Pass(Io& io, T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  io.Copy(&value, sizeof value);
}

template <class Io, class List>
void PassList(Io& io, List& list) {
  using T = typename List::value_type;
  constexpr bool is_plain = std::is_trivially_copyable_v<T>;
  std::uint64_t count = list.size();
  Pass(io, count);
  io.CheckCount(count, is_plain ? sizeof(T) : 1);
  if (Io::kReads) list.resize(count);
  if constexpr (is_plain) {
    io.Copy(list.data(), count * sizeof(T));
  } else {
    for (T& value : list) Pass(io, value);
  }
}
template <class Io>
void Pass(Io& io, std::string& text) {
  PassList(io, text);
}
template <class Io, class T>
void Pass(Io& io, std::vector<T>& list) {
  PassList(io, list);
}
template <class Io, class T>
void Pass(Io& io, std::set<T>& set) {
  std::vector<std::string> texts(set.begin(), set.end());
  PassList(io, texts);
  if (Io::kReads) set.insert(texts.begin(), texts.end());
}

template <class Io, class... T>
void PassAll(Io& io, T&... values) {
  (Pass(io, values), ...);
}
template <class Io>
void Pass(Io& io, ImportedMap& map) {
  PassAll(io, map.picture, map.embedded, map.uv);
}
template <class Io>
void Pass(Io& io, ImportedMaterial& m) {
  PassAll(io, m.name, m.folder, m.base_color, m.emission, m.metallic, m.roughness, m.normal_scale, m.opacity,
          m.alpha_mode, m.alpha_cutoff, m.unlit, m.has_bumps, m.color_map, m.opacity_map, m.emission_map, m.normal_map,
          m.gloss_map);
}
template <class Io>
void Pass(Io& io, ImportedPicture& picture) {
  PassAll(io, picture.width, picture.height, picture.bytes);
}
template <class Io>
void Pass(Io& io, ImportedMesh& mesh) {
  PassAll(io, mesh.name, mesh.material, mesh.positions, mesh.normals, mesh.colors, mesh.uvs, mesh.triangles);
}
template <class Io>
void Pass(Io& io, ImportedCamera& camera) {
  PassAll(io, camera.name, camera.transform, camera.yfov_rad, camera.aspect);
}
template <class Io>
void Pass(Io& io, ImportedNode& node) {
  PassAll(io, node.parent, node.transform, node.meshes);
}
template <class Io>
void Pass(Io& io, MeshImport& import) {
  PassAll(io, import.problem, import.files, import.missing, import.warnings, import.origin, import.cameras);
  ImportedScene& scene = import.scene;
  PassAll(io, scene.nodes, scene.meshes, scene.materials, scene.pictures);
}

// Whether all indices and lengths are valid, so that a loader need not check them.
bool IsWhole(const ImportedScene& scene) {
  const auto fits = [](const auto& values, const ImportedMesh& mesh) {
    return values.empty() || values.size() == mesh.positions.size();
  };
  for (const ImportedMesh& mesh : scene.meshes) {
    if (mesh.material >= scene.materials.size() || !fits(mesh.normals, mesh) || !fits(mesh.colors, mesh)) return false;
    if (!std::ranges::all_of(mesh.uvs, [&](const auto& uvs) { return fits(uvs, mesh); })) return false;
  }
  const auto count = static_cast<int>(scene.nodes.size());
  for (int i = 0; i < count; ++i) {
    const ImportedNode& node = scene.nodes[static_cast<std::size_t>(i)];
    if (node.parent < -1 || node.parent >= i) return false;
    if (std::ranges::any_of(node.meshes, [&](unsigned mesh) { return mesh >= scene.meshes.size(); })) return false;
  }
  for (const ImportedMaterial& m : scene.materials) {
    for (const ImportedMap* map : {&m.color_map, &m.opacity_map, &m.emission_map, &m.normal_map, &m.gloss_map})
      if (map->embedded < -1 || map->embedded >= static_cast<std::int64_t>(scene.pictures.size())) return false;
  }
  return true;
}

}  // namespace

std::string MeshCounts::Problem() const {
  const auto too_many = [](const char* what, std::uint64_t most) {
    return std::string("has more ") + what + " than are read: " + std::to_string(most);
  };
  if (vertices > kMostVertices) return too_many("vertices", kMostVertices);
  if (corners > kMostVertices) return too_many("corners of faces", kMostVertices);
  if (nodes > kMostNodes) return too_many("nodes", kMostNodes);
  if (meshes > kMostNodes || materials > kMostNodes) return too_many("meshes or materials", kMostNodes);
  if (picture_bytes > kMostPictureBytes) return too_many("bytes of textures", kMostPictureBytes);
  return "";
}

MeshCounts CountsOf(const ImportedScene& scene) {
  MeshCounts counts;
  for (const ImportedMesh& mesh : scene.meshes) {
    counts.vertices += mesh.positions.size();
    counts.corners += 3 * mesh.triangles.size();
  }
  counts.nodes = scene.nodes.size(), counts.meshes = scene.meshes.size(), counts.materials = scene.materials.size();
  for (const ImportedPicture& picture : scene.pictures) counts.picture_bytes += picture.bytes.size();
  return counts;
}

void WriteBytes(const MeshImport& import, const ByteSink& sink) {
  Writer out(sink);
  Pass(out, const_cast<MeshImport&>(import));  // a writer changes nothing
  out.Flush();
}

MeshImport ImportFromBytes(std::span<const std::uint8_t> bytes) {
  Reader in(bytes);
  MeshImport import;
  Pass(in, import);
  if (!IsWhole(import.scene)) throw Broken();
  return import;
}

}  // namespace sim
