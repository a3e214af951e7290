#include "sim/world/gltf_features.h"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tools/base/limits/structured_text.h"

namespace sim {
namespace {

using nlohmann::json;

// The JSON text of a file: all of it, or of a binary glTF its first chunk (after a header of 12 bytes and the chunk's
// of 8).
std::string JsonText(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes;
  char head[20] = {};
  stream.read(head, sizeof head);
  if (stream && std::memcmp(head, "glTF", 4) == 0) {
    std::uint32_t length = 0;
    std::memcpy(&length, head + 12, sizeof length);
    std::error_code error;
    if (const std::uintmax_t size = std::filesystem::file_size(file, error); error || length > size) return {};
    bytes.resize(length);
    stream.read(bytes.data(), static_cast<std::streamsize>(length));
    return bytes;
  }
  stream.clear();
  stream.seekg(0);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::size_t Count(const json& document, const char* key) {
  const auto found = document.find(key);
  return found != document.end() && found->is_array() ? found->size() : 0;
}

// What an extension that is not applied would have done; those that are applied have no entry and are in kApplied.
const std::map<std::string, std::string>& LeftOut() {
  static const std::map<std::string, std::string> names{
      {"KHR_lights_punctual", "the file's own lights are not used: lights are the scenario's"},
      {"KHR_materials_clearcoat", "clear coats are not rendered: the surface below is"},
      {"KHR_materials_transmission", "transmission is not rendered: the surface is opaque"},
      {"KHR_materials_volume", "volumes are not rendered: the surface is opaque"},
      {"KHR_materials_sheen", "sheen is not rendered"},
      {"KHR_materials_specular", "reflections are not rendered"},
      {"KHR_materials_ior", "refraction is not rendered"},
      {"KHR_materials_iridescence", "iridescence is not rendered"},
      {"KHR_materials_anisotropy", "reflections are not rendered"},
      {"KHR_materials_unlit", "unlit materials are lit like all others"},
      {"KHR_materials_variants", "the default variant is rendered"},
  };
  return names;
}

const std::set<std::string>& Applied() {
  static const std::set<std::string> names{"KHR_texture_transform", "KHR_materials_emissive_strength",
                                           "KHR_mesh_quantization", "KHR_materials_pbrSpecularGlossiness"};
  return names;
}

}  // namespace

GltfFeatures ReadGltfFeatures(const std::filesystem::path& file) {
  GltfFeatures features;
  const std::string text = JsonText(file);
  if (const std::string problem = limits::JsonProblem(text); !problem.empty()) {
    features.impossible.push_back("is " + problem);
    return features;
  }
  const json document = json::parse(text, nullptr, false);
  if (!document.is_object()) return features;
  const auto names = [&](const char* key) {
    std::set<std::string> result;
    if (const auto list = document.find(key); list != document.end() && list->is_array()) {
      for (const json& name : *list) {
        if (name.is_string()) result.insert(name.get<std::string>());
      }
    }
    return result;
  };
  static const std::set<std::string> kUnreadable{"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                                 "KHR_texture_basisu", "EXT_mesh_gpu_instancing"};
  const std::set<std::string> required = names("extensionsRequired");
  for (const std::string& name : required) {
    if (kUnreadable.contains(name))
      features.impossible.push_back("requires " + name + ", which is not supported: convert the file without it");
  }
  for (const std::string& name : names("extensionsUsed")) {
    if (Applied().contains(name) || (required.contains(name) && kUnreadable.contains(name))) continue;
    const auto known = LeftOut().find(name);
    features.not_rendered.push_back("uses " + name + ": " +
                                    (known != LeftOut().end() ? known->second : "it is left out"));
  }
  for (std::size_t i = 0; i < Count(document, "materials"); ++i) {
    const json::json_pointer place("/materials/" + std::to_string(i) +
                                   "/extensions/KHR_materials_emissive_strength/emissiveStrength");
    const bool has = document.contains(place) && document[place].is_number();
    features.emission_strengths.push_back(has ? document[place].get<float>() : 1.0f);
  }
  if (Count(document, "animations") > 0)
    features.not_rendered.push_back("has animations: the scene is rendered as it stands without them");
  if (Count(document, "skins") > 0)
    features.not_rendered.push_back("has skins: their meshes are rendered as modelled, not as posed");
  if (const auto meshes = document.find("meshes"); meshes != document.end() && meshes->is_array()) {
    bool any_targets = false;
    for (const json& mesh : *meshes) {
      if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array()) continue;
      for (const json& primitive : mesh["primitives"])
        any_targets = any_targets || (primitive.is_object() && primitive.contains("targets"));
    }
    if (any_targets) features.not_rendered.push_back("has morph targets: the meshes are rendered without them");
  }
  return features;
}

}  // namespace sim
