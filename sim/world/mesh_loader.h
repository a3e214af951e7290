// Loader of a mesh file into a scene.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "sim/world/scene.h"

namespace sim {

// Indices of textures in the scene, by file (embedded ones: by file and their name in it); -1: unreadable.
using TextureCache = std::map<std::string, int>;

// Appends the file's meshes (with the transforms of its nodes and of `description`), the materials and textures that
// they use, and warnings, to `scene`; appends what is wrong to `problems`, each naming its file. The scene is of use
// only when there was no problem.
void AppendMeshFile(const MeshDescription& description, Scene& scene, TextureCache& textures,
                    std::vector<std::string>& problems);

}  // namespace sim
