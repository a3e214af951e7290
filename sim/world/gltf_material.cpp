#include "sim/world/gltf_material.h"

#include <assimp/GltfMaterial.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "sim/world/mesh_builder.h"

namespace sim {
namespace {

using nlohmann::json;

constexpr const char* kBasis =
    "KHR_texture_basisu: Basis textures (KTX2) are not read: convert them to PNG, JPEG or WebP";

}  // namespace

void WarnOnce(MeshImport& import, const std::string& what) {
  if (std::ranges::find(import.warnings, what) == import.warnings.end()) import.warnings.push_back(what);
}

std::string GltfMaterials::ImageOf(const json& texture) {
  const json *webp = GltfFile::Extension(texture, "EXT_texture_webp"),
             *basis = GltfFile::Extension(texture, "KHR_texture_basisu");
  const json& from = webp != nullptr && webp->contains("source") ? *webp : texture;
  if (!from.contains("source")) {
    if (basis != nullptr) throw std::runtime_error(kBasis);
    WarnOnce(import_, "a texture has no picture of a known kind: it is left out");
    return "";
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
  const std::string uri = image.at("uri").get<std::string>();
  if (const std::optional<std::string> data = GltfFile::DataOf(uri)) return name->second = Embed(*data);
  return name->second = uri;
}

std::string GltfMaterials::Embed(std::string_view bytes) {
  auto* texture = new aiTexture;  // a file of mWidth bytes
  textures_.push_back(texture);
  texture->mWidth = static_cast<unsigned>(bytes.size());
  texture->pcData = new aiTexel[bytes.size() / sizeof(aiTexel) + 1];
  std::memcpy(static_cast<void*>(texture->pcData), bytes.data(), bytes.size());
  return "*" + std::to_string(textures_.size() - 1);
}

void GltfMaterials::SetTexture(aiMaterial& material, const json& object, const char* key, aiTextureType type) {
  const auto info = object.find(key);
  if (info == object.end()) return;
  const json& texture = file_.At("textures", GltfFile::Index(*info, "index"));
  const std::string image = ImageOf(texture);
  if (image.empty()) return;
  SetText(material, image, AI_MATKEY_TEXTURE(type, 0));
  int set = info->value("texCoord", 0);
  if (const json* t = GltfFile::Extension(*info, "KHR_texture_transform")) {
    // uv' = offset + rotation * scale * uv, where v points down.
    const auto offset = GltfFile::Numbers<2>(*t, "offset", {0, 0}), scale = GltfFile::Numbers<2>(*t, "scale", {1, 1});
    const double angle = t->value("rotation", 0.0), c = std::cos(angle), s = std::sin(angle);
    set = t->value("texCoord", set);
    SetUvTransform(material, type,
                   glm::dmat3x2(c * scale[0], -s * scale[0], s * scale[1], c * scale[1], offset[0], offset[1]));
  } else {
    SetUvTransform(material, type, glm::dmat3x2(1, 0, 0, 1, 0, 0));
  }
  material.AddProperty(&set, 1, AI_MATKEY_UVWSRC(type, 0));
  if (!texture.contains("sampler")) return;
  const json& sampler = file_.At("samplers", GltfFile::Index(texture, "sampler"));
  constexpr int kClamp = 33071, kMirror = 33648, kNearest = 9728;
  for (const bool v : {false, true}) {
    const int wrap = sampler.value(v ? "wrapT" : "wrapS", 0);
    const int mode = wrap == kClamp    ? aiTextureMapMode_Clamp
                     : wrap == kMirror ? aiTextureMapMode_Mirror
                                       : aiTextureMapMode_Wrap;
    material.AddProperty(&mode, 1, v ? "$tex.mapmodev" : "$tex.mapmodeu", type, 0);
  }
  if (sampler.value("magFilter", 0) == kNearest)
    WarnOnce(import_, "a sampler asks for the nearest texel: it is interpolated");
}

void GltfMaterials::ReadMaterial(const json& in) {
  auto* out = new aiMaterial;
  materials_.push_back(out);
  SetText(*out, in.value("name", ""), AI_MATKEY_NAME);
  const json& plain = GltfFile::Child(in, "pbrMetallicRoughness");
  const json* gloss = GltfFile::Extension(in, "KHR_materials_pbrSpecularGlossiness");
  const auto number = [&](double value, const char* key, unsigned type, unsigned index) {
    const auto single = static_cast<float>(value);
    out->AddProperty(&single, 1, key, type, index);
  };
  auto color = GltfFile::Numbers<4>(gloss ? *gloss : plain, gloss ? "diffuseFactor" : "baseColorFactor", {1, 1, 1, 1});
  SetTexture(*out, gloss ? *gloss : plain, gloss ? "diffuseTexture" : "baseColorTexture", aiTextureType_BASE_COLOR);
  if (gloss != nullptr) {
    number(0, AI_MATKEY_METALLIC_FACTOR);
    number(1 - gloss->value("glossinessFactor", 1.0), AI_MATKEY_ROUGHNESS_FACTOR);
    if (gloss->contains("specularGlossinessTexture"))
      WarnOnce(import_, "specular-glossiness textures are not used: their factors are");
  } else {
    number(plain.value("metallicFactor", 1.0), AI_MATKEY_METALLIC_FACTOR);
    number(plain.value("roughnessFactor", 1.0), AI_MATKEY_ROUGHNESS_FACTOR);
    SetTexture(*out, plain, "metallicRoughnessTexture", aiTextureType_UNKNOWN);
  }
  const std::string mode = in.value("alphaMode", "OPAQUE");
  if (mode == "OPAQUE") color[3] = 1;
  SetText(*out, mode, AI_MATKEY_GLTF_ALPHAMODE);
  number(in.value("alphaCutoff", 0.5), AI_MATKEY_GLTF_ALPHACUTOFF);
  const aiColor4D base(static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2]),
                       static_cast<float>(color[3]));
  out->AddProperty(&base, 1, AI_MATKEY_BASE_COLOR);
  auto glow = GltfFile::Numbers<3>(in, "emissiveFactor", {0, 0, 0});
  if (const json* strength = GltfFile::Extension(in, "KHR_materials_emissive_strength"))
    for (double& c : glow) c *= strength->value("emissiveStrength", 1.0);
  const aiColor3D emission(static_cast<float>(glow[0]), static_cast<float>(glow[1]), static_cast<float>(glow[2]));
  out->AddProperty(&emission, 1, AI_MATKEY_COLOR_EMISSIVE);
  SetTexture(*out, in, "emissiveTexture", aiTextureType_EMISSIVE);
  SetTexture(*out, in, "normalTexture", aiTextureType_NORMALS);
  number(GltfFile::Child(in, "normalTexture").value("scale", 1.0),
         AI_MATKEY_GLTF_TEXTURE_SCALE(aiTextureType_NORMALS, 0));
  const int unlit = GltfFile::Extension(in, "KHR_materials_unlit") != nullptr;
  out->AddProperty(&unlit, 1, kUnlitKey, 0, 0);
}

unsigned GltfMaterials::MaterialOf(const json& primitive) {
  const std::optional<std::size_t> index =
      primitive.contains("material") ? std::optional(GltfFile::Index(primitive, "material")) : std::nullopt;
  const auto [at, is_new] = material_of_.try_emplace(index, static_cast<unsigned>(materials_.size()));
  if (is_new) ReadMaterial(index ? file_.At("materials", *index) : json::object());
  return at->second;
}

}  // namespace sim
