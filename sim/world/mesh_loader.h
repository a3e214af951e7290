// Loader of a mesh file into a scene.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sim/world/scene.h"

namespace sim {

// Indices of textures in the scene, by file (embedded ones: by file and their name in it); -1: unreadable.
using TextureIndices = std::map<std::string, int>;

// Warnings, grouped by kind, with the number of occurrences.
class WarningList {
 public:
  // who: the subject, which varies; what: the text common to a kind.
  void Add(const std::string& who, const std::string& what);
  // "who what", or "108 x what (first: who)", in order of their first occurrence.
  std::vector<std::string> Summed() const;

 private:
  struct Kind {
    std::string what, first;
    std::size_t count;
  };
  std::vector<Kind> kinds_;
};

// A texture of the scene that is still to be decoded.
struct PictureJob {
  int texture;                    // in Scene::textures
  std::function<Texture()> load;  // throws std::exception with its file
};

// State shared by all files of a world.
struct WorldLoading {
  Scene& scene;
  const std::vector<std::filesystem::path>& folders;        // WorldDescription::folders
  const std::vector<std::filesystem::path>& cache_folders;  // and of it, too
  MissingTextures missing_textures;
  TextureIndices textures{};
  std::vector<std::string> problems{};
  WarningList warnings{};
  std::vector<PictureJob> pictures{};
  std::map<int, std::string> cut_outs{};  // materials with alpha, and how a warning begins; empty: it is checked
};

// Decodes the pictures, and warns of cut-outs that leave nothing; parallel in the caller's task arena.
void LoadPictures(WorldLoading& loading);

// Appends the file's meshes (with the transforms of its nodes and of `description`), and the materials and textures
// that they use, to the scene; notes every problem, with its file. The scene is valid only without problems.
void AppendMeshFile(const MeshDescription& description, WorldLoading& loading);

}  // namespace sim
