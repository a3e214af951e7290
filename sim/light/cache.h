// Cache of baked light on disk. Private to sim.
//
// A file's name is the hash of all that its content depends on: geometry, materials, pictures, lights, sky, settings
// and the version of the computation. Inside: the word "vobench baked light", that hash, sizes, data, and a checksum of
// all that. Written under a temporary name and renamed: no half files, also when several programs write the same.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sim/light/bake.h"

namespace sim {

using LightHash = std::array<std::uint64_t, 2>;

// 128-bit XXH3 (Collet), which is not cryptographic.
LightHash HashOfLight(const Scene& scene, LightMode mode, const BakeParams& params);

std::filesystem::path LightFile(const std::filesystem::path& folder, const LightHash& hash);

// Throws std::runtime_error naming the file when it cannot be written or is not a valid cache file of this hash.
void WriteLight(const std::filesystem::path& file, const LightHash& hash, const BakedLight& light);
BakedLight ReadLight(const std::filesystem::path& file, const LightHash& hash);

// Read from the first folder that has it; else computed, and written to the first writable folder. A damaged file is a
// warning, and is computed and written again. No folder: always computed.
BakedLight CachedLight(const Scene& scene, const RayScene& rays, LightMode mode, const BakeParams& params,
                       const std::vector<std::filesystem::path>& folders, std::vector<std::string>& warnings);

// Sets the light of CachedLight in the ray tracer's tables; nothing where `mode` is direct. Appends BakeWarnings too.
// Parallel in the caller's task arena.
void AddLight(const Scene& scene, LightMode mode, const BakeParams& params,
              const std::vector<std::filesystem::path>& folders, RayScene& rays, std::vector<std::string>& warnings);
// New scene tables with that light.
std::unique_ptr<RayScene> LitScene(const Scene& scene, LightMode mode, const BakeParams& params,
                                   const std::vector<std::filesystem::path>& folders,
                                   std::vector<std::string>& warnings);

// Cache folders of a scenario, best first: in `.vobench-cache` beside it, or in vobench/ of the user's cache folder
// ($XDG_CACHE_HOME, or ~/.cache).
std::vector<std::filesystem::path> CacheFolders(const std::filesystem::path& scenario_folder);

}  // namespace sim
