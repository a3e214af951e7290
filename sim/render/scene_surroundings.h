// Surroundings of a path, by distance and ray queries of the ray tracer's scene.
#pragma once

#include <memory>

#include "sim/motion/surroundings.h"
#include "sim/render/ray_scene.h"
#include "sim/world/scene.h"

namespace sim {

// Both must outlive it; `rays` are of this scene.
std::unique_ptr<Surroundings> SurroundingsOf(const Scene& scene, const RayScene& rays);

}  // namespace sim
