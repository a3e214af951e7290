// A glTF 2.0 file: its document, buffers and accessors. Private to sim/world.
// Source: Khronos, "glTF 2.0 Specification", 3.6 (binary data), 4 (GLB); EXT_meshopt_compression;
// KHR_draco_mesh_compression, google.github.io/draco/spec.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/world/mesh_import.h"

namespace sim {

// A table of numbers: `columns` in each of `count` rows. Normalised integers are in [0, 1] or [-1, 1].
struct GltfTable {
  std::size_t count = 0, columns = 0;
  std::vector<float> values;
  float at(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

// glTF 1.0, which assimp reads.
struct OlderGltf {};

// A problem that names the item of the document that it is of.
struct GltfItemError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The text of an exception of the JSON library, without its number.
std::string TextOf(const nlohmann::json::exception& error);

// Calls read(). Its problems are of an item of a list, unless they name one themselves.
template <class Read>
auto ReadItem(const char* list, std::size_t index, const Read& read) {
  const std::string item = std::string(list) + "[" + std::to_string(index) + "]";
  try {
    return read();
  } catch (const GltfItemError&) {
    throw;
  } catch (const nlohmann::json::exception& error) {
    throw GltfItemError(item + " is not glTF as its schema has it: " + TextOf(error));
  } catch (const std::runtime_error& error) {
    throw GltfItemError(item + ": " + error.what());
  }
}

void WarnOnce(MeshImport& import, const std::string& what);

// Throws std::runtime_error or nlohmann::json::exception for invalid files; OlderGltf.
class GltfFile {
 public:
  // import: receives warnings.
  GltfFile(MeshFiles& files, MeshImport& import);

  const nlohmann::json& document() const { return document_; }
  // The item of a list of the document.
  const nlohmann::json& At(const char* list, std::size_t index) const;
  // An item's list or object; an empty one where it is absent.
  static const nlohmann::json& Child(const nlohmann::json& object, const char* key);
  static std::size_t Index(const nlohmann::json& object, const char* key);
  static std::vector<std::size_t> Indices(const nlohmann::json& object, const char* key);  // none where it is absent
  template <std::size_t n>
  static std::array<double, n> Numbers(const nlohmann::json& object, const char* key, std::array<double, n> otherwise) {
    const auto found = object.find(key);
    return found == object.end() ? otherwise : found->get<std::array<double, n>>();
  }
  // An extension of an object; null: it has none.
  static const nlohmann::json* Extension(const nlohmann::json& object, const char* name);

  GltfTable ReadTable(std::size_t accessor);
  std::vector<std::uint32_t> ReadIndices(std::size_t accessor);
  std::span<const std::uint8_t> View(std::size_t buffer_view);
  // The bytes of a "data:" URI; none for others.
  static std::optional<std::string> DataOf(const std::string& uri);

  // The value of a component, with glTF's normalisation of integers.
  static float Normalised(double value, int component_type, bool normalised);

 private:
  const std::string& Buffer(std::size_t index);
  std::string ReadFile(const std::string& uri);
  GltfTable TableOf(std::size_t accessor);
  template <class Store>
  void ReadComponents(std::size_t accessor, const Store& store);

  MeshFiles& files_;
  MeshImport& import_;
  nlohmann::json document_;
  std::optional<std::string> binary_;  // the second chunk of a GLB
  std::map<std::size_t, std::string> buffers_;
  std::map<std::size_t, std::vector<std::uint8_t>> decompressed_;  // by buffer view
};

// A mesh compressed by Draco (KHR_draco_mesh_compression).
struct DracoMesh {
  std::vector<std::uint32_t> indices;           // of triangles
  std::map<std::string, GltfTable> attributes;  // by glTF's name
};

struct DracoAttribute {
  std::uint32_t id;
  int component_type;  // of the accessor that it stands for
  bool normalised;
};

// Throws std::runtime_error for damaged data and for missing attributes.
DracoMesh DecodeDraco(std::span<const std::uint8_t> bytes, const std::map<std::string, DracoAttribute>& attributes);

}  // namespace sim
