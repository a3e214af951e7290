// Purpose: meshes, moving objects, lights and sky as scenarios write them: docs/scenario.md has the keys.
#pragma once

#include <filesystem>

#include "sim/world/description.h"
#include "tools/base/settings/settings.h"

namespace sim {

// Files lie in `folder`. duration_s: of the scenario, which scripts of objects must last for.
void ReadWorld(settings::Section section, const std::filesystem::path& folder, double duration_s,
               WorldDescription& world);

}  // namespace sim
