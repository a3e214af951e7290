#include "sim/world/gltf_material.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sim {
namespace {

using nlohmann::json;

constexpr const char* kBasis =
    "KHR_texture_basisu: Basis textures (KTX2) are not read: convert them to PNG, JPEG or WebP";

}  // namespace

ImportedMap GltfMaterials::ImageOf(const json& texture) {
  const json *webp = GltfFile::Extension(texture, "EXT_texture_webp"),
             *basis = GltfFile::Extension(texture, "KHR_texture_basisu");
  const json& from = webp != nullptr && webp->contains("source") ? *webp : texture;
  if (!from.contains("source")) {
    if (basis != nullptr) throw std::runtime_error(kBasis);
    WarnOnce(import_, "a texture has no picture of a known kind: it is left out");
    return {};
  }
  const std::size_t index = GltfFile::Index(from, "source");
  const auto [name, is_new] = images_.try_emplace(index);
  if (!is_new) return name->second;
  const json& image = file_.At("images", index);
  if (image.value("mimeType", "") == "image/ktx2") throw std::runtime_error(kBasis);
  if (image.contains("bufferView")) {
    const auto view = file_.View(GltfFile::Index(image, "bufferView"));
    return name->second = Embed({reinterpret_cast<const char*>(view.data()), view.size()});
  }
  const std::string uri = image.value("uri", "");
  if (uri.empty()) return name->second = ImportedMap{"images[" + std::to_string(index) + "]"};  // no such file
  if (const std::optional<std::string> data = GltfFile::DataOf(uri)) return name->second = Embed(*data);
  return name->second = ImportedMap{uri};
}

ImportedMap GltfMaterials::Embed(std::string_view bytes) {
  std::vector<ImportedPicture>& pictures = import_.scene.pictures;
  const std::size_t index = pictures.size();
  pictures.push_back({0, 0, {bytes.begin(), bytes.end()}});
  return {"*" + std::to_string(index), static_cast<int>(index)};
}

ImportedMap GltfMaterials::MapOf(const json& object, const char* key) {
  const auto info = object.find(key);
  if (info == object.end()) return {};
  const json& texture = file_.At("textures", GltfFile::Index(*info, "index"));
  ImportedMap map = ImageOf(texture);
  if (map.picture.empty()) return map;
  map.uv.channel = static_cast<unsigned>(std::max(info->value("texCoord", 0), 0));
  if (const json* t = GltfFile::Extension(*info, "KHR_texture_transform")) {
    // uv' = offset + rotation * scale * uv, where v points down.
    const auto offset = GltfFile::Numbers<2>(*t, "offset", {0, 0}), scale = GltfFile::Numbers<2>(*t, "scale", {1, 1});
    const double angle = t->value("rotation", 0.0), c = std::cos(angle), s = std::sin(angle);
    map.uv.channel = static_cast<unsigned>(std::max(t->value("texCoord", static_cast<int>(map.uv.channel)), 0));
    map.uv.transform = glm::mat3x2(c * scale[0], -s * scale[0], s * scale[1], c * scale[1], offset[0], offset[1]);
  }
  if (!texture.contains("sampler")) return map;
  const json& sampler = file_.At("samplers", GltfFile::Index(texture, "sampler"));
  constexpr int kClamp = 33071, kMirror = 33648, kNearest = 9728;
  for (const std::size_t axis : {0u, 1u}) {
    const int wrap = sampler.value(axis == 0 ? "wrapS" : "wrapT", 0);
    map.uv.wrap[axis] = wrap == kClamp ? UvWrap::clamp : wrap == kMirror ? UvWrap::mirror : UvWrap::repeat;
  }
  if (sampler.value("magFilter", 0) == kNearest)
    WarnOnce(import_, "a sampler asks for the nearest texel: it is interpolated");
  return map;
}

ImportedMaterial GltfMaterials::Read(const json& in) {
  ImportedMaterial out{in.value("name", "")};
  const json& plain = GltfFile::Child(in, "pbrMetallicRoughness");
  const json* gloss = GltfFile::Extension(in, "KHR_materials_pbrSpecularGlossiness");
  auto color = GltfFile::Numbers<4>(gloss ? *gloss : plain, gloss ? "diffuseFactor" : "baseColorFactor", {1, 1, 1, 1});
  out.color_map = MapOf(gloss ? *gloss : plain, gloss ? "diffuseTexture" : "baseColorTexture");
  if (gloss != nullptr) {
    out.roughness = static_cast<float>(1 - gloss->value("glossinessFactor", 1.0));
    if (gloss->contains("specularGlossinessTexture"))
      WarnOnce(import_, "specular-glossiness textures are not used: their factors are");
  } else {
    out.metallic = static_cast<float>(plain.value("metallicFactor", 1.0));
    out.roughness = static_cast<float>(plain.value("roughnessFactor", 1.0));
    out.gloss_map = MapOf(plain, "metallicRoughnessTexture");
  }
  out.alpha_mode = in.value("alphaMode", "OPAQUE");
  if (out.alpha_mode == "OPAQUE") color[3] = 1;
  out.alpha_cutoff = static_cast<float>(in.value("alphaCutoff", 0.5));
  out.base_color = glm::vec4(color[0], color[1], color[2], color[3]);
  auto glow = GltfFile::Numbers<3>(in, "emissiveFactor", {0, 0, 0});
  if (const json* strength = GltfFile::Extension(in, "KHR_materials_emissive_strength"))
    for (double& c : glow) c *= strength->value("emissiveStrength", 1.0);
  out.emission = glm::vec3(glow[0], glow[1], glow[2]);
  out.emission_map = MapOf(in, "emissiveTexture");
  out.normal_map = MapOf(in, "normalTexture");
  out.normal_scale = static_cast<float>(GltfFile::Child(in, "normalTexture").value("scale", 1.0));
  out.unlit = GltfFile::Extension(in, "KHR_materials_unlit") != nullptr;
  return out;
}

unsigned GltfMaterials::MaterialOf(const json& primitive) {
  const std::optional<std::size_t> index =
      primitive.contains("material") ? std::optional(GltfFile::Index(primitive, "material")) : std::nullopt;
  std::vector<ImportedMaterial>& materials = import_.scene.materials;
  const auto [at, is_new] = material_of_.try_emplace(index, static_cast<unsigned>(materials.size()));
  if (!is_new) return at->second;
  const json in = index ? file_.At("materials", *index) : json::object();
  materials.push_back(index ? ReadItem("materials", *index, [&] { return Read(in); }) : Read(in));
  return at->second;
}

}  // namespace sim
