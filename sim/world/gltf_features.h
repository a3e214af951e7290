// Unsupported features of a glTF file, by name: assimp omits them without a message.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sim {

struct GltfFeatures {
  // By material (KHR_materials_emissive_strength, which assimp 5.2 does not know)
  std::vector<float> emission_strengths;
  // The file requires it: without it the picture would be wrong, or there would be none
  std::vector<std::string> impossible;
  std::vector<std::string> not_rendered;  // is left out; what is seen instead is said
};

// Reads the JSON of a .gltf or .glb file. What cannot be read is left to the importer to complain about.
GltfFeatures ReadGltfFeatures(const std::filesystem::path& file);

}  // namespace sim
