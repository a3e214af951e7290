// Materials and textures of a mesh file. Private to sim/world.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/world/image_file.h"
#include "sim/world/imported_scene.h"
#include "sim/world/mesh_loader.h"
#include "sim/world/scene.h"
#include "sim/world/texture_file.h"

namespace sim {

// A mesh file and the destination of its content.
struct MeshFile {
  std::filesystem::path path;
  std::string extension;  // for example ".obj"
  bool is_gltf;
  Scene& scene;
  WorldLoading& loading;
  std::string place;  // in the scenario, for problems

  // who: the subject, which varies; what: the text common to a kind.
  void Warn(const std::string& who, const std::string& what) const {
    loading.warnings.Add(path.string() + ": " + who, what);
  }
  void Problem(const std::string& what) const {
    loading.problems.push_back((place.empty() ? "" : place + ": ") + path.string() + ": " + what);
  }
};

struct MeshMaterial {
  int index = -1;  // in Scene::materials
  UvChoice uv;
  bool is_unlit = false;  // its emission is glTF's base colour
};

class MeshMaterialReader {
 public:
  MeshMaterialReader(const MeshFile& file, const ImportedScene& from)
      : file_(file), from_(from), materials_(from.materials.size()), meshes_of_(from.materials.size()) {
    for (const ImportedMesh& mesh : from.meshes) meshes_of_[mesh.material].push_back(&mesh);
  }

  // Adds the file's material to the scene at its first use.
  const MeshMaterial& Material(unsigned index);

 private:
  // A picture's use in a material.
  struct Use {
    const ImportedMap& map;
    const char* what;  // for example "normal "
    Texture::Content content = Texture::Content::color;
    bool with_alpha = false;
    const ImportedMap* mask = nullptr;  // the picture of its opacity
  };

  MeshMaterial Read(const ImportedMaterial& in);
  bool IsSamePlace(const ImportedMaterial& in, const UvChoice& a, const UvChoice& b) const;
  void ReadAlpha(const ImportedMaterial& in, sim::Material& material);
  int ReadTexture(const ImportedMaterial& in, const Use& use, std::vector<UvChoice>& uvs);
  int TextureIndex(const ImportedMaterial& in, const Use& use);
  // Of a picture in the mesh file: the mesh's path and its name.
  TextureFile FileOf(const ImportedMaterial& in, const ImportedMap& map) const;
  // Reader of a picture, and how a problem with it begins; empty: it is bad.
  using Source = std::function<ImportedPicture()>;
  Source Find(const ImportedMaterial& in, const ImportedMap& map, const TextureFile& found, std::string& problem);

  const MeshFile& file_;
  const ImportedScene& from_;
  std::vector<MeshMaterial> materials_;                      // by the file's index; index -1: not used yet
  std::vector<std::vector<const ImportedMesh*>> meshes_of_;  // the same
};

}  // namespace sim
