#include "tools/bench/tracking/map_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "tools/base/files.h"
#include "tools/bench/errors.h"
#include "tools/bench/result/output_folder.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

bool IsIn(const fs::path& inner, const fs::path& outer) {
  return *fs::weakly_canonical(inner).lexically_relative(fs::weakly_canonical(CleanPath(outer))).begin() != "..";
}

}  // namespace

void RequireMapPath(const fs::path& file, const std::optional<fs::path>& result) {
  if (file.extension() != ".ply") throw BadInput(fmt::format("--map {}: the name must end in .ply", file.string()));
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder)) {
    throw BadInput(fmt::format("--map {}: there is no folder {}; make it first", file.string(), folder.string()));
  }
  if (result && IsIn(folder, *result)) {
    throw BadInput(fmt::format("--map {}: is in {}, which the result replaces; choose another folder", file.string(),
                               result->string()));
  }
}

fs::path MapPathOf(const fs::path& file, const RunEntry& run, bool several) {
  if (!several) return file;
  fs::path path = file;
  path.replace_filename(fmt::format("{}_{}_seed_{}.ply", file.stem().string(), run.system, run.seed));
  return path;
}

std::string MapText(const std::vector<vo::MapPoint>& map) {
  const auto known = std::count_if(map.begin(), map.end(), [](const vo::MapPoint& p) { return p.moments.has_value(); });
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\n"
      "comment vobench: landmarks in W [m]; cov_ab [m^2] is the covariance of x, y, z\n"
      "comment {} more landmarks are left out: not yet known to lie in front\n"
      "element vertex {}\n",
      static_cast<std::ptrdiff_t>(map.size()) - known, known);
  for (const char* property : {"x", "y", "z"}) text += fmt::format("property double {}\n", property);
  for (const char* property : {"red", "green", "blue"}) text += fmt::format("property uchar {}\n", property);
  for (const char* property : {"cov_xx", "cov_xy", "cov_xz", "cov_yy", "cov_yz", "cov_zz", "inverse_depth",
                               "inverse_depth_sigma", "relative_sigma"}) {
    text += fmt::format("property double {}\n", property);
  }
  // PLY has no whole numbers of 64 bits; a double holds those up to 2^53.
  const bool is_small =
      std::all_of(map.begin(), map.end(), [](const vo::MapPoint& p) { return std::in_range<std::int32_t>(p.id); });
  text += fmt::format("property {} id\nproperty uchar permanent\nend_header\n", is_small ? "int" : "double");
  for (const vo::MapPoint& point : map) {
    if (!point.moments) continue;
    const Eigen::Vector3d& X = point.moments->mean;
    const Eigen::Matrix3d& P = point.moments->covariance;
    text += fmt::format(
        "{:.9g} {:.9g} {:.9g} {} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {} {}\n", X.x(), X.y(),
        X.z(), point.permanent ? "30 110 200" : "230 140 30", P(0, 0), P(0, 1), P(0, 2), P(1, 1), P(1, 2), P(2, 2),
        point.inverse_depth, point.inverse_depth_sigma, point.relative_sigma, point.id, point.permanent ? 1 : 0);
  }
  return text;
}

void WriteMap(const fs::path& file, const std::vector<vo::MapPoint>& map) { base::WriteFile(file, MapText(map)); }

}  // namespace vobench
