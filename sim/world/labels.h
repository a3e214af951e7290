// Labels of a world: which entry of the scenario each mesh belongs to, its class, and its box.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "sim/motion/pose.h"
#include "sim/world/description.h"
#include "sim/world/scene.h"

namespace sim {

// An entry of world.meshes, world.objects, or a lamp that is seen.
struct Instance {
  std::string name, category;
  std::string entry;  // in the scenario: "world.meshes.0"
  int object = -1;    // in Scene::objects; -1: it stands still
  Pose box;           // the smallest along the axes of the entry's file that holds all triangles: its middle, in W or O
  glm::dvec3 size{0};  // of it, along its axes [m]
};

struct Labels {
  std::vector<Instance> instances;     // their ids are 1, 2, ...: meshes, lamps, objects
  std::vector<std::string> classes;    // in alphabetical order; their ids are 1, 2, ...
  std::vector<std::uint32_t> of_mesh;  // instance of each mesh, 0, 1, ..., as SurfaceTracer::MeshOf counts meshes

  std::uint32_t ClassId(const Instance& instance) const;
};
Labels LabelsOf(const Scene& scene, const WorldDescription& description);

}  // namespace sim
