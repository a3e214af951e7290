// Purpose: orbits, half spheres, turns on the spot and dollies as scenarios write them; the speed of a path.
#pragma once

#include "sim/motion/description.h"
#include "tools/base/settings/settings.h"

namespace sim {

enum class PathKind { orbit, half_sphere, rpy, dolly };

// docs/scenario.md has the keys. With `speed` the path is flown as much faster or slower as that needs.
PathMotion ReadPath(settings::Section& section, PathKind kind);

// `speed`: by how much faster a script must be flown so that this is its mean speed; 1 where it is not there.
double ReadPace(settings::Section& section, const ScriptedMotion& motion);

}  // namespace sim
