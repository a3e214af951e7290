#include "sim/world/mesh_material.h"

#include <assimp/GltfMaterial.h>

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <stdexcept>
#include <utility>

#include "sim/world/mesh_builder.h"
#include "sim/world/texture_file.h"
#include "tools/base/files.h"
#include "tools/base/limits/picture.h"

namespace sim {
namespace {

namespace fs = std::filesystem;

DecodedImage DecodeEmbedded(const aiTexture& texture, bool with_alpha) {
  if (texture.mHeight == 0) {  // a file of mWidth bytes
    return DecodeImage({reinterpret_cast<const std::uint8_t*>(texture.pcData), texture.mWidth}, with_alpha);
  }
  const std::size_t texels = std::size_t{texture.mWidth} * texture.mHeight;
  const std::string problem = limits::PictureSizeProblem(texture.mWidth, texture.mHeight, texels * sizeof(aiTexel));
  if (!problem.empty()) throw std::runtime_error(problem);
  DecodedImage image{static_cast<int>(texture.mWidth), static_cast<int>(texture.mHeight), {}, {}};
  for (std::size_t i = 0; i < texels; ++i) {
    const aiTexel& texel = texture.pcData[i];
    image.rgb.insert(image.rgb.end(), {texel.r, texel.g, texel.b});
    if (with_alpha) image.alpha.push_back(texel.a);
  }
  return image;
}

bool IsKnown(const aiMaterial& in, const char* key) {
  int value = 0;
  return in.Get(key, 0, 0, value) == AI_SUCCESS && value != 0;
}

}  // namespace

const MeshMaterial& MeshMaterialReader::Material(unsigned index) {
  MeshMaterial& known = materials_.at(index);
  if (known.index < 0) known = Read(*ai_.mMaterials[index]);
  return known;
}

MeshMaterial MeshMaterialReader::Read(const aiMaterial& in) {
  using Content = Texture::Content;
  sim::Material material;
  material.name = in.GetName().C_Str();
  const auto has = [&](aiTextureType type) { return in.GetTextureCount(type) > 0; };
  const aiTextureType base = has(aiTextureType_BASE_COLOR) ? aiTextureType_BASE_COLOR : aiTextureType_DIFFUSE;
  const aiTextureType glow = has(aiTextureType_EMISSION_COLOR) ? aiTextureType_EMISSION_COLOR : aiTextureType_EMISSIVE;
  aiColor4D color(1, 1, 1, 1);
  if (in.Get(AI_MATKEY_BASE_COLOR, color) != AI_SUCCESS) {
    aiColor3D diffuse(1, 1, 1);
    const bool is_replaced = file_.extension == ".fbx" && has(base);  // FBX: a texture takes the colour's place
    if (!is_replaced) in.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse);
    color = {diffuse.r, diffuse.g, diffuse.b, 1};
  }
  aiColor3D emission(0, 0, 0);
  in.Get(AI_MATKEY_COLOR_EMISSIVE, emission);
  if (!file_.is_gltf && has(glow) && emission.IsBlack()) emission = {1, 1, 1};
  for (const float c : {color.r, color.g, color.b, emission.r, emission.g, emission.b}) {
    if (!std::isfinite(c) || c < 0) {
      file_.Problem("material '" + material.name + "': a colour is negative or not finite: " + std::to_string(c));
      break;
    }
  }
  material.base_color = {color.r, color.g, color.b};
  material.emission = {emission.r, emission.g, emission.b};
  material.alpha = file_.is_gltf ? color.a : 1.0f;  // elsewhere transparency is not rendered
  ReadAlpha(in, material);

  std::vector<UvChoice> uvs;
  aiString mask;
  in.Get(AI_MATKEY_TEXTURE(aiTextureType_OPACITY, 0), mask);
  material.texture =
      ReadTexture(in, {base, "", Content::color, material.alpha_cutoff > 0, mask.C_Str()}, material.name, uvs);
  if (material.texture < 0 && mask.length > 0 && !has(base)) {
    material.texture =
        ReadTexture(in, {aiTextureType_OPACITY, "opacity ", Content::color, true, mask.C_Str()}, material.name, uvs);
  }
  if (emission.r > 0 || emission.g > 0 || emission.b > 0) {
    material.emission_texture = ReadTexture(in, {glow, "emission "}, material.name, uvs);
    if (file_.extension == ".ac") material.emission_texture = material.texture;  // AC3D: the texture is on all light
  }
  material.normal_map = ReadTexture(in, {aiTextureType_NORMALS, "normal ", Content::numbers}, material.name, uvs);
  in.Get(AI_MATKEY_GLTF_TEXTURE_SCALE(aiTextureType_NORMALS, 0), material.normal_scale);
  in.Get(AI_MATKEY_METALLIC_FACTOR, material.metallic);
  in.Get(AI_MATKEY_ROUGHNESS_FACTOR, material.roughness);
  material.metallic = std::clamp(material.metallic, 0.0f, 1.0f);
  material.roughness = std::clamp(material.roughness, 0.0f, 1.0f);
  if (file_.is_gltf) {
    material.gloss_texture =
        ReadTexture(in, {aiTextureType_UNKNOWN, "metallic-roughness ", Content::numbers}, material.name, uvs);
  }
  if (IsKnown(in, kUnlitKey)) {  // radiance is the base colour, whatever shines on it
    material.emission = std::exchange(material.base_color, glm::vec3(0));
    material.emission_texture = material.texture;
    material.metallic = 0, material.roughness = 1;
    material.normal_map = material.gloss_texture = -1;
  }
  MeshMaterial result;
  result.index = static_cast<int>(file_.scene.materials.size());
  if (!uvs.empty()) result.uv = uvs.front();
  file_.scene.materials.push_back(std::move(material));
  return result;
}

// glTF says what alpha is for. In all other formats the alpha of a picture cuts out.
void MeshMaterialReader::ReadAlpha(const aiMaterial& in, sim::Material& material) {
  const std::string who = "material '" + material.name + "': ";
  aiString mode;
  if (in.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) != AI_SUCCESS) {
    ai_real opacity = 1;
    if (in.Get(AI_MATKEY_OPACITY, opacity) == AI_SUCCESS && opacity < 1)
      file_.Warn(who + "d or transparency is " + std::to_string(opacity) + "; ",
                 "transparency is not rendered; it is opaque");
    if (!file_.is_gltf) material.alpha_cutoff = 0.5f;
    return;
  }
  const std::string name = mode.C_Str();
  if (name == "MASK") {
    ai_real cutoff = 0.5f;
    in.Get(AI_MATKEY_GLTF_ALPHACUTOFF, cutoff);
    material.alpha_cutoff = cutoff;
  } else if (name == "BLEND") {
    material.alpha_cutoff = 0.5f;
    file_.Warn(who, "alphaMode BLEND is not rendered; it is a cut-out where alpha is 0.5");
  }
}

// The picture of one use, or -1. Pictures of a material share one set of texture coordinates: one that wants another is
// left out.
int MeshMaterialReader::ReadTexture(const aiMaterial& in, const Use& use, const std::string& name,
                                    std::vector<UvChoice>& uvs) {
  aiString path, folder;
  if (in.Get(AI_MATKEY_TEXTURE(use.type, 0), path) != AI_SUCCESS || path.length == 0) return -1;
  in.Get(kFolderKey, 0, 0, folder);
  const UvChoice uv = ReadUvChoice(in, use.type);
  if (!uvs.empty() && !uvs.front().IsSamePlace(uv)) {
    file_.Warn("material '" + name + "': the " + use.what + "texture " + path.C_Str() + " ",
               "has other texture coordinates than the material's first; it is left out");
    return -1;
  }
  uvs.push_back(uv);
  return TextureIndex(path.C_Str(), folder.C_Str(), name, use);
}

UvChoice MeshMaterialReader::ReadUvChoice(const aiMaterial& in, aiTextureType type) {
  UvChoice choice;
  int channel = 0;
  in.Get(AI_MATKEY_UVWSRC(type, 0), channel);
  choice.channel = static_cast<unsigned>(std::max(channel, 0));
  for (const std::size_t axis : {0u, 1u}) {
    int mode = aiTextureMapMode_Wrap;
    in.Get(axis == 0 ? "$tex.mapmodeu" : "$tex.mapmodev", type, 0, mode);
    if (mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal) choice.wrap[axis] = UvWrap::clamp;
    if (mode == aiTextureMapMode_Mirror) choice.wrap[axis] = UvWrap::mirror;
  }
  float own[6] = {};
  unsigned count = 6;
  if (in.Get(kUvTransformKey, type, 0, own, &count) == AI_SUCCESS && count == 6) {
    choice.transform = glm::dmat3x2(own[0], own[1], own[2], own[3], own[4], own[5]);
    return choice;
  }
  aiUVTransform t;
  if (in.Get(AI_MATKEY_UVTRANSFORM(type, 0), t) != AI_SUCCESS) return choice;
  // assimp's: v up; scaled, then turned about (0.5, 0.5), then moved.
  const double c = std::cos(t.mRotation), s = std::sin(t.mRotation);
  const glm::dmat3 flip(1, 0, 0, 0, -1, 0, 0, 1, 1), scale(t.mScaling.x, 0, 0, 0, t.mScaling.y, 0, 0, 0, 1),
      turn(c, s, 0, -s, c, 0, 0.5 - 0.5 * c + 0.5 * s, 0.5 - 0.5 * s - 0.5 * c, 1),
      move(1, 0, 0, 0, 1, 0, t.mTranslation.x, t.mTranslation.y, 1);
  choice.transform = glm::dmat3x2(flip * move * turn * scale * flip);
  return choice;
}

std::optional<DecodedImage> MeshMaterialReader::Decode(const std::string& name, const std::string& folder,
                                                       const std::string& material, bool with_alpha) {
  const aiTexture* embedded = ai_.GetEmbeddedTexture(name.c_str());
  TextureFile found{file_.path / name};
  const auto bad = [&](const std::string& what) {
    file_.loading.problems.push_back(found.file.string() + ": texture of material '" + material + "' in " +
                                     file_.path.string() + ": " + what);
    return std::nullopt;
  };
  try {
    if (embedded != nullptr) return DecodeEmbedded(*embedded, with_alpha);
    found = FindTexture(name, file_.path, folder, file_.loading.folders);
    file_.scene.files.insert(found.file);
    if (found.problem.starts_with("must")) {
      file_.Problem("material '" + material + "': the texture path '" + name + "' " + found.problem);
      return std::nullopt;
    }
    if (!found.problem.empty() && file_.loading.missing_textures == MissingTextures::grey) {
      file_.Warn("material '" + material + "': '" + name + "': ", "a texture that is not there is grey");
      return DecodedImage{1, 1, {128, 128, 128}, {}};
    }
    if (!found.problem.empty()) return bad(found.problem);
    if (found.is_elsewhere)
      file_.Warn("material '" + material + "': " + found.file.string() + " for '" + name + "': ",
                 "a texture is taken from where one of its name lies");
    if (!fs::is_regular_file(found.file)) return bad("not a file");
    const std::optional<std::string> bytes = base::ReadFile(found.file);
    if (!bytes) return bad("cannot be opened");
    return DecodeImage(base::AsBytes(*bytes), with_alpha);
  } catch (const std::exception& problem) {
    return bad(problem.what());
  }
}

int MeshMaterialReader::TextureIndex(const std::string& name, const std::string& folder, const std::string& material,
                                     const Use& use) {
  const TextureFile found = FindTexture(name, file_.path, folder, file_.loading.folders);
  const fs::path file =
      ai_.GetEmbeddedTexture(name.c_str()) != nullptr || !found.problem.empty() ? file_.path / name : found.file;
  const std::string kind = use.content == Texture::Content::numbers ? " (numbers)"
                           : use.with_alpha                         ? " (with alpha)"
                                                                    : "";
  const std::string key = file.string() + kind + (use.mask.empty() ? "" : " * " + folder + "/" + use.mask);
  const auto [entry, is_new] = file_.loading.textures.try_emplace(key, -1);
  if (!is_new) return entry->second;  // a bad one has been reported
  std::optional<DecodedImage> image = Decode(name, folder, material, use.with_alpha);
  if (!image) return -1;
  if (!use.mask.empty() && (use.mask != name || use.type == aiTextureType_OPACITY)) {
    const std::optional<DecodedImage> mask = Decode(use.mask, folder, material, true);
    if (!mask) return -1;
    SetAlpha(*mask, *image);
    if (use.type == aiTextureType_OPACITY) std::ranges::fill(image->rgb, std::uint8_t{255});
  }
  const bool is_cut = std::ranges::any_of(image->alpha, [](std::uint8_t a) { return a < 255; });
  if (!is_cut) image->alpha.clear();
  if (is_cut && std::ranges::none_of(image->alpha, [](std::uint8_t a) { return a > 127; }))
    file_.Warn("material '" + material + "': ", "the alpha of its picture is below 0.5 everywhere: it is not seen");
  try {
    file_.scene.textures.emplace_back(file.string(), image->width, image->height, image->rgb, image->alpha,
                                      use.content);
  } catch (const std::invalid_argument& problem) {
    file_.Problem(problem.what());
    return -1;
  }
  return entry->second = static_cast<int>(file_.scene.textures.size()) - 1;
}

}  // namespace sim
