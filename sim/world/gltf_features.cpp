#include "sim/world/gltf_features.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <utility>

#include "tools/base/files.h"
#include "tools/base/limits/structured_text.h"

namespace sim {
namespace {

using nlohmann::json;

// The JSON text of a file: all of it, or of a binary glTF its first chunk (after a header of 12 bytes and the chunk's
// of 8).
std::string JsonText(const std::filesystem::path& file) {
  constexpr std::size_t kHeads = 20;
  std::string bytes = base::ReadFile(file).value_or("");
  if (!bytes.starts_with("glTF") || bytes.size() < kHeads) return bytes;
  std::uint32_t length = 0;
  std::memcpy(&length, &bytes[12], sizeof length);
  return length > bytes.size() ? "" : bytes.substr(kHeads, length);
}

// The array of that name, or an empty one.
const json& List(const json& object, const char* key) {
  static const json none = json::array();
  const auto found = object.find(key);
  return found != object.end() && found->is_array() ? *found : none;
}

// What is seen instead of an extension that is not applied; empty: it is applied.
constexpr std::pair<std::string_view, std::string_view> kInstead[] = {
    {"KHR_texture_transform", ""},
    {"KHR_materials_emissive_strength", ""},
    {"KHR_mesh_quantization", ""},
    {"KHR_materials_pbrSpecularGlossiness", ""},
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

bool IsUnreadable(const std::string& extension) {
  return extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression" ||
         extension == "KHR_texture_basisu" || extension == "EXT_mesh_gpu_instancing";
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
    for (const json& name : List(document, key)) {
      if (name.is_string()) result.insert(name.get<std::string>());
    }
    return result;
  };
  const std::set<std::string> required = names("extensionsRequired");
  for (const std::string& name : required) {
    if (IsUnreadable(name))
      features.impossible.push_back("requires " + name + ", which is not supported: convert the file without it");
  }
  for (const std::string& name : names("extensionsUsed")) {
    if (required.contains(name) && IsUnreadable(name)) continue;
    const auto* known =
        std::find_if(std::begin(kInstead), std::end(kInstead), [&](auto& e) { return e.first == name; });
    const std::string instead(known != std::end(kInstead) ? known->second : "it is left out");
    if (!instead.empty()) features.not_rendered.push_back("uses " + name + ": " + instead);
  }
  for (std::size_t i = 0; i < List(document, "materials").size(); ++i) {
    const json::json_pointer place("/materials/" + std::to_string(i) +
                                   "/extensions/KHR_materials_emissive_strength/emissiveStrength");
    const bool has = document.contains(place) && document[place].is_number();
    features.emission_strengths.push_back(has ? document[place].get<float>() : 1.0f);
  }
  if (!List(document, "animations").empty())
    features.not_rendered.push_back("has animations: the scene is rendered as it stands without them");
  if (!List(document, "skins").empty())
    features.not_rendered.push_back("has skins: their meshes are rendered as modelled, not as posed");
  bool any_targets = false;
  for (const json& mesh : List(document, "meshes")) {
    for (const json& primitive : List(mesh, "primitives")) any_targets = any_targets || primitive.contains("targets");
  }
  if (any_targets) features.not_rendered.push_back("has morph targets: the meshes are rendered without them");
  return features;
}

}  // namespace sim
