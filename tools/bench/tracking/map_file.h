// Landmark map as a PLY file: position, colour (permanent blue, others orange), covariance, inverse depth.
// Source: G. Turk, "The PLY polygon file format" (ascii 1.0); docs/result_folder.md. Units m, m^2, 1/m; frame W.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/result/run_json.h"
#include "vo/base/result.h"

namespace vobench {

// Throws BadInput where the name does not end in .ply, its folder is not there, or is (in) the folder that the result
// replaces: before the work, not after it.
void RequireMapPath(const std::filesystem::path& file, const std::optional<std::filesystem::path>& result);

// `map.ply` itself, or `map_SYSTEM_seed_N.ply` where several runs leave a map each.
std::filesystem::path MapPathOf(const std::filesystem::path& file, const RunEntry& run, bool several);

// The landmarks that have moments; how many have none is a comment in the header.
std::string MapText(const std::vector<vo::MapPoint>& map);

// Throws std::runtime_error where it cannot be written whole.
void WriteMap(const std::filesystem::path& file, const std::vector<vo::MapPoint>& map);

}  // namespace vobench
