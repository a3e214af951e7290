#include "sim/light/cache.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <span>
#include <stdexcept>
#include <type_traits>

#include "tools/base/files.h"

namespace sim {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kVersion = 1;  // of the file and of the computation; part of the file's name
constexpr std::array<char, 20> kMagic{"vobench baked light"};

class Hasher {
 public:
  Hasher() : state_(XXH3_createState()) { XXH3_128bits_reset(state_.get()); }
  void Bytes(const void* data, std::size_t size) { XXH3_128bits_update(state_.get(), data, size); }
  template <class T>
  void Value(const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_same_v<T, glm::vec3> ||
                  std::is_same_v<T, glm::dvec3>);
    Bytes(&value, sizeof value);
  }
  template <class... T>
  void Values(const T&... values) {
    (Value(values), ...);
  }
  template <class T>
  void Array(const std::vector<T>& values) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_same_v<T, glm::vec3> ||
                  std::is_same_v<T, glm::vec2> || std::is_same_v<T, glm::uvec3>);
    Value(values.size());
    Bytes(values.data(), values.size() * sizeof(T));
  }
  LightHash Result() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    return {hash.high64, hash.low64};
  }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> state_;
};

struct HashLight {
  Hasher& hasher;
  void operator()(const AmbientLight&) const {}  // not part of baked light
  void operator()(const SunLight& l) const { hasher.Values(l.direction, l.irradiance); }
  void operator()(const PointLight& l) const { hasher.Values(l.position, l.intensity), Lamp(l.flicker); }
  void operator()(const RectLight& l) const {
    hasher.Values(l.corner, l.side_u, l.side_v, l.radiance, l.visible);
    Lamp(l.flicker);
  }
  void Lamp(const Flicker& f) const { hasher.Values(f.frequency_hz, f.depth, f.phase); }
};

// The head of a file, all of 8 bytes.
struct Head {
  char magic[kMagic.size() + 4];
  std::uint64_t version, hash[2], triangles, layers, samples;
};
static_assert(sizeof(Head) == 24 + 6 * 8);
static_assert(sizeof(TriangleResolution) == 2 && sizeof(Flicker) == 24);

// The arrays of a file, in their order.
template <class Baked, class Function>
void ForEachArray(Baked& light, const Function& function) {
  function(light.resolutions), function(light.layers), function(light.samples);
}

template <class T>
std::size_t SizeOf(const std::vector<T>& array) {
  return array.size() * sizeof(T);
}

LightHash Checksum(const Head& head, const BakedLight& light) {
  Hasher hasher;
  hasher.Bytes(&head, sizeof head);
  ForEachArray(light, [&](const auto& array) { hasher.Bytes(array.data(), SizeOf(array)); });
  return hasher.Result();
}

Head MakeHead(const LightHash& hash, const BakedLight& light) {
  Head head{};
  std::memcpy(head.magic, kMagic.data(), kMagic.size());
  head.version = kVersion;
  head.hash[0] = hash[0], head.hash[1] = hash[1];
  head.triangles = light.resolutions.size(), head.layers = light.layers.size(), head.samples = light.samples.size();
  return head;
}

}  // namespace

LightHash HashOfLight(const Scene& scene, LightMode mode, const BakeParams& params) {
  Hasher hasher;
  hasher.Values(kVersion, mode, params.spacing_m, params.min_spacing_m, params.paths, params.lamp_rays);
  for (const Mesh& mesh : scene.meshes) {
    hasher.Array(mesh.positions), hasher.Array(mesh.normals), hasher.Array(mesh.uvs), hasher.Array(mesh.colors),
        hasher.Array(mesh.triangles);
    hasher.Value(mesh.material);
  }
  for (const Material& m : scene.materials) {
    hasher.Values(m.base_color, m.emission, m.texture, m.emission_texture, m.alpha, m.alpha_cutoff);
  }
  for (const Texture& t : scene.textures) {
    hasher.Values(t.width(), t.height(), t.content());
    std::size_t count = 0;
    for (const TextureLevel& l : t.levels())
      count += static_cast<std::size_t>(l.width) * static_cast<std::size_t>(l.height);
    hasher.Value(count);
    for (const TextureLevel& l : t.levels()) {
      for (int y = 0; y < l.height; ++y)
        hasher.Bytes(&t.texels()[l.RowBegin(y)], 4 * static_cast<std::size_t>(l.width));
    }
    hasher.Value(t.alpha().size());
    hasher.Bytes(t.alpha().data(), t.alpha().size());
  }
  for (const Light& light : scene.lights) {
    hasher.Value(light.index());
    std::visit(HashLight{hasher}, light);
  }
  hasher.Values(scene.background, scene.sky.has_value());
  if (scene.sky) {
    const Sky& sky = *scene.sky;
    hasher.Values(sky.zenith, sky.horizon, sky.ground, sky.width, sky.height, sky.turn);
    hasher.Array(sky.picture);
  }
  return hasher.Result();
}

fs::path LightFile(const fs::path& folder, const LightHash& hash) {
  char name[40];
  std::snprintf(name, sizeof name, "%016llx%016llx", static_cast<unsigned long long>(hash[0]),
                static_cast<unsigned long long>(hash[1]));
  return folder / (std::string(name) + ".light");
}

void WriteLight(const fs::path& file, const LightHash& hash, const BakedLight& light) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  base::AtomicFile out(file, base::Writers::many);
  const auto write = [&](const void* data, std::size_t size) { out.Append({static_cast<const char*>(data), size}); };
  const Head head = MakeHead(hash, light);
  const LightHash checksum = Checksum(head, light);
  write(&head, sizeof head);
  ForEachArray(light, [&](const auto& array) { write(array.data(), SizeOf(array)); });
  write(checksum.data(), sizeof checksum);
  out.Commit();
}

BakedLight ReadLight(const fs::path& file, const LightHash& hash) {
  const auto bad = [&](const char* why) { return std::runtime_error(file.string() + ": " + why); };
  std::ifstream in(file, std::ios::binary);
  if (!in) throw bad("cannot be opened");
  const auto read = [&](void* data, std::size_t size) {
    in.read(static_cast<char*>(data), static_cast<std::streamsize>(size));
    if (!in) throw bad("is cut off");
  };
  const std::uint64_t size = fs::file_size(file);
  Head head{};
  read(&head, sizeof head);
  if (std::memcmp(head.magic, kMagic.data(), kMagic.size()) != 0 || head.version != kVersion)
    throw bad("is not a file of baked light");
  if (head.hash[0] != hash[0] || head.hash[1] != hash[1]) throw bad("is the light of another world");
  const std::uint64_t rest = size - sizeof head - sizeof(LightHash);
  if (size < sizeof head + sizeof(LightHash) || head.triangles > rest || head.layers > rest || head.samples > rest ||
      2 * head.triangles + 24 * head.layers + 4 * head.samples != rest) {
    throw bad("does not have the size that it says");
  }
  BakedLight light;
  light.resolutions.resize(head.triangles);
  light.layers.resize(head.layers);
  light.samples.resize(head.samples);
  ForEachArray(light, [&](auto& array) { read(array.data(), SizeOf(array)); });
  LightHash checksum{};
  read(checksum.data(), sizeof checksum);
  if (checksum != Checksum(head, light)) throw bad("is damaged: wrong checksum");
  return light;
}

BakedLight CachedLight(const Scene& scene, const RayScene& rays, LightMode mode, const BakeParams& params,
                       const std::vector<fs::path>& folders, std::vector<std::string>& warnings) {
  if (folders.empty()) return BakeLight(scene, rays, mode, params);
  const LightHash hash = HashOfLight(scene, mode, params);
  for (const fs::path& folder : folders) {
    const fs::path file = LightFile(folder, hash);
    std::error_code error;
    if (!fs::exists(file, error)) continue;
    try {
      BakedLight light = ReadLight(file, hash);
      light.has_lamps = mode == LightMode::baked;
      return light;
    } catch (const std::runtime_error& problem) {
      warnings.push_back(std::string(problem.what()) + "; the light is computed anew");
    }
  }
  BakedLight light = BakeLight(scene, rays, mode, params);
  std::string failures;
  for (const fs::path& folder : folders) {
    try {
      WriteLight(LightFile(folder, hash), hash, light);
      return light;
    } catch (const std::runtime_error& problem) {
      failures += std::string(failures.empty() ? "" : "; ") + problem.what();
    }
  }
  warnings.push_back("the baked light is not kept: " + failures);
  return light;
}

void AddLight(const Scene& scene, LightMode mode, const BakeParams& params, const std::vector<fs::path>& folders,
              RayScene& rays, std::vector<std::string>& warnings) {
  if (mode == LightMode::direct) return;
  rays.SetLight(CachedLight(scene, rays, mode, params, folders, warnings));
  for (std::string& warning : BakeWarnings(scene, rays, mode, params)) warnings.push_back(std::move(warning));
}

std::unique_ptr<RayScene> LitScene(const Scene& scene, LightMode mode, const BakeParams& params,
                                   const std::vector<fs::path>& folders, std::vector<std::string>& warnings) {
  auto rays = std::make_unique<RayScene>(scene);
  AddLight(scene, mode, params, folders, *rays, warnings);
  return rays;
}

std::vector<fs::path> CacheFolders(const fs::path& scenario_folder) {
  std::vector<fs::path> folders{scenario_folder / ".vobench-cache"};
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  if (cache != nullptr && fs::path(cache).is_absolute()) {
    folders.push_back(fs::path(cache) / "vobench");
  } else if (home != nullptr && *home != 0) {
    folders.push_back(fs::path(home) / ".cache" / "vobench");
  }
  return folders;
}

}  // namespace sim
