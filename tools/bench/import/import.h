// Parts of `vobench import`: conversion of another program's world, and a first path through it.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sim/world/description.h"

namespace vobench {

// A YAML list, to a nanometre.
std::string ListText(const glm::dvec3& v);

struct ImportedWorld {
  sim::WorldDescription world;                                                         // meshes and folders
  std::vector<std::string> lights = {"{type: ambient, radiance: [0.35, 0.35, 0.35]}",  // as a scenario has them
                                     "{type: sun, direction: [0.3, -1, -0.4], irradiance: [2, 2, 2]}"};
  glm::dvec3 background{0.0};
  std::vector<std::string> warnings;  // one of each kind, with how often it occurs
  std::set<std::string> planes;       // names of meshes that are ground rather than stand there
};

// The description that a folder's model.config names: the newest version that is read; empty: none.
std::filesystem::path ModelOf(const std::filesystem::path& folder);

// Visuals and lights of an SDF or URDF file at their initial poses; x, y, z of SDF are x, -z, y of W. Boxes and other
// primitives are meshes of `shapes`, stretched. model:// and package:// are looked for in `folders`, too. Colours are
// taken as sRGB. Throws std::runtime_error with all problems, "FILE:LINE: why".
// Source: SDFormat 1.0 to 1.9 as libsdformat 12 reads it.
ImportedWorld ReadSdf(const std::filesystem::path& file, const std::vector<std::filesystem::path>& folders,
                      const std::filesystem::path& shapes);

// The first pass of a material in scripts of OGRE 1.9 (files, or folders that hold *.material); none where no script
// has it. Gazebo's plain colours (Gazebo/Red) need no script.
struct OgreMaterial {
  std::optional<glm::dvec3> diffuse{};  // sRGB-coded
  std::string texture{};                // a file name; empty: none
  std::string base{};                   // the material that it inherits from and that no script has; empty: none
  bool is_emissive = false, is_scaled = false;
};
std::optional<OgreMaterial> FindOgreMaterial(const std::string& name,
                                             const std::vector<std::filesystem::path>& scripts);

// The value of a scenario's `trajectory`: hand-held where there is a free place under a roof, else a swing about the
// world's contents, from where most is visible. fov_rad: the narrower one. Throws as LoadScene does, and
// std::runtime_error where no path is free.
std::string FirstMotion(const ImportedWorld& imported, double fov_rad, double duration_s);

}  // namespace vobench
