#include "sim/world/mesh_material.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "sim/world/image_file.h"
#include "sim/world/mesh_import.h"
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

// "%20" and the like, as file names in glTF have them.
std::string DecodePercent(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto digit = [&](std::size_t at) {
      return at < text.size() && std::isxdigit(static_cast<unsigned char>(text[at]));
    };
    if (text[i] == '%' && digit(i + 1) && digit(i + 2)) {
      out += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

}  // namespace

const MeshMaterial& MeshMaterialReader::Material(unsigned index) {
  MeshMaterial& known = materials_.at(index);
  if (known.index < 0) known = Read(*ai_.mMaterials[index], index < strengths_.size() ? strengths_[index] : 1.0f);
  return known;
}

MeshMaterial MeshMaterialReader::Read(const aiMaterial& in, float emission_strength) {
  sim::Material material;
  material.name = in.GetName().C_Str();
  aiColor4D color(1, 1, 1, 1);
  if (in.Get(AI_MATKEY_BASE_COLOR, color) != AI_SUCCESS) {
    aiColor3D diffuse(1, 1, 1);
    in.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse);
    color = {diffuse.r, diffuse.g, diffuse.b, 1};
  }
  aiColor3D emission(0, 0, 0);
  in.Get(AI_MATKEY_COLOR_EMISSIVE, emission);
  emission = emission * emission_strength;
  for (const float c : {color.r, color.g, color.b, emission.r, emission.g, emission.b}) {
    if (!std::isfinite(c) || c < 0) {
      file_.Problem("material '" + material.name + "': a colour is negative or not finite: " + std::to_string(c));
      break;
    }
  }
  material.base_color = {color.r, color.g, color.b};
  material.emission = {emission.r, emission.g, emission.b};
  material.alpha = color.a;
  ReadAlpha(in, material);

  std::vector<UvChoice> uvs;
  const aiTextureType base =
      in.GetTextureCount(aiTextureType_BASE_COLOR) > 0 ? aiTextureType_BASE_COLOR : aiTextureType_DIFFUSE;
  material.texture = ReadTexture(in, base, "", Texture::Content::color, material.alpha_cutoff > 0, material.name, uvs);
  const aiTextureType glow =
      in.GetTextureCount(aiTextureType_EMISSION_COLOR) > 0 ? aiTextureType_EMISSION_COLOR : aiTextureType_EMISSIVE;
  if (emission.r > 0 || emission.g > 0 || emission.b > 0) {
    material.emission_texture = ReadTexture(in, glow, "emission ", Texture::Content::color, false, material.name, uvs);
  }
  material.normal_map =
      ReadTexture(in, aiTextureType_NORMALS, "normal ", Texture::Content::numbers, false, material.name, uvs);
  in.Get(AI_MATKEY_GLTF_TEXTURE_SCALE(aiTextureType_NORMALS, 0), material.normal_scale);
  in.Get(AI_MATKEY_METALLIC_FACTOR, material.metallic);
  in.Get(AI_MATKEY_ROUGHNESS_FACTOR, material.roughness);
  material.metallic = std::clamp(material.metallic, 0.0f, 1.0f);
  material.roughness = std::clamp(material.roughness, 0.0f, 1.0f);
  if (file_.is_gltf) {
    material.gloss_texture = ReadTexture(in, aiTextureType_UNKNOWN, "metallic-roughness ", Texture::Content::numbers,
                                         false, material.name, uvs);
  }
  if (in.GetTextureCount(aiTextureType_OPACITY) > 0) {
    file_.Warn("material '" + material.name + "': its opacity texture is not used; it is opaque");
  }
  MeshMaterial result;
  result.index = static_cast<int>(file_.scene.materials.size());
  if (!uvs.empty()) result.uv = uvs.front();
  file_.scene.materials.push_back(std::move(material));
  return result;
}

void MeshMaterialReader::ReadAlpha(const aiMaterial& in, sim::Material& material) {
  aiString mode;
  if (in.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) != AI_SUCCESS) {
    ai_real opacity = 1;
    if (in.Get(AI_MATKEY_OPACITY, opacity) == AI_SUCCESS && opacity < 1) {
      file_.Warn("material '" + material.name + "': transparency is not rendered; it is opaque");
    }
    return;
  }
  const std::string name = mode.C_Str();
  if (name == "MASK") {
    ai_real cutoff = 0.5f;
    in.Get(AI_MATKEY_GLTF_ALPHACUTOFF, cutoff);
    material.alpha_cutoff = cutoff;
  } else if (name == "BLEND") {
    material.alpha_cutoff = 0.5f;
    file_.Warn("material '" + material.name + "': alphaMode BLEND is not rendered; it is a cut-out where alpha is 0.5");
  }
}

// The picture of one use, or -1. Pictures of a material share one set of texture coordinates: one that wants another is
// left out.
int MeshMaterialReader::ReadTexture(const aiMaterial& in, aiTextureType type, const char* what,
                                    Texture::Content content, bool with_alpha, const std::string& name,
                                    std::vector<UvChoice>& uvs) {
  aiString path;
  if (in.Get(AI_MATKEY_TEXTURE(type, 0), path) != AI_SUCCESS || path.length == 0) return -1;
  const std::string label = "material '" + name + "': the " + what + "texture " + path.C_Str();
  const UvChoice uv = ReadUvChoice(in, type, label);
  if (!uvs.empty() && uvs.front() != uv) {
    file_.Warn(label + " has other texture coordinates than the material's first; it is left out");
    return -1;
  }
  uvs.push_back(uv);
  return TextureIndex(path.C_Str(), name, content, with_alpha);
}

UvChoice MeshMaterialReader::ReadUvChoice(const aiMaterial& in, aiTextureType type, const std::string& label) {
  UvChoice choice;
  int channel = 0;
  in.Get(AI_MATKEY_UVWSRC(type, 0), channel);
  choice.channel = static_cast<unsigned>(std::max(channel, 0));
  aiUVTransform t;
  if (in.Get(AI_MATKEY_UVTRANSFORM(type, 0), t) != AI_SUCCESS) return choice;
  if (!file_.is_gltf) {
    file_.Warn(label + ": its transform is not applied");
    return choice;
  }
  // KHR_texture_transform: uv' = offset + rotation * scale * uv. assimp keeps the rotation's negative, and an offset
  // for coordinates with v up that turn about the picture's middle (its glTF2 importer says how): undone here.
  const double angle = -t.mRotation, c = std::cos(angle), s = std::sin(angle);
  const glm::dvec2 scale(t.mScaling.x, t.mScaling.y);
  const glm::dvec2 offset(t.mTranslation.x - 0.5 * scale.x * (-c + s + 1.0),
                          -(t.mTranslation.y - 0.5 * scale.y * (s + c - 1.0) - 1.0 + scale.y));
  choice.transform = glm::dmat3x2(c * scale.x, -s * scale.x, s * scale.y, c * scale.y, offset.x, offset.y);
  return choice;
}

int MeshMaterialReader::TextureIndex(const std::string& name, const std::string& material, Texture::Content content,
                                     bool with_alpha) {
  std::string text = name;
  std::replace(text.begin(), text.end(), '\\', '/');
  fs::path path = fs::path(text).lexically_normal();
  const aiTexture* embedded = ai_.GetEmbeddedTexture(name.c_str());
  std::error_code error;
  if (embedded == nullptr && file_.is_gltf && !fs::exists(file_.path.parent_path() / path, error)) {
    text = DecodePercent(text);
    path = fs::path(text).lexically_normal();
  }
  const fs::path file = embedded != nullptr ? file_.path / name : (file_.path.parent_path() / path).lexically_normal();
  const std::string kind = content == Texture::Content::numbers ? " (numbers)" : with_alpha ? " (with alpha)" : "";
  const auto [entry, is_new] = file_.textures.try_emplace(file.string() + kind, -1);
  if (!is_new) return entry->second;  // a bad one has been reported
  const auto bad = [&](const std::string& what) {
    file_.problems.push_back(file.string() + ": texture of material '" + material + "' in " + file_.path.string() +
                             ": " + what);
    return -1;
  };
  try {
    DecodedImage image;
    if (embedded != nullptr) {
      image = DecodeEmbedded(*embedded, with_alpha);
    } else {
      const bool has_drive = text.size() > 1 && text[1] == ':';
      if (path.is_absolute() || has_drive || (!path.empty() && *path.begin() == "..") ||
          !LiesBeside(file_.path, file)) {
        file_.Problem("material '" + material + "': the texture path '" + name +
                      "' must be relative and stay inside the mesh file's folder");
        return -1;
      }
      file_.scene.files.insert(file);
      if (!fs::exists(file)) return bad("no such file");
      if (!fs::is_regular_file(file)) return bad("not a file");
      const std::optional<std::string> bytes = base::ReadFile(file);
      if (!bytes) return bad("cannot be opened");
      image = DecodeImage(base::AsBytes(*bytes), with_alpha);
    }
    const bool is_cut = std::any_of(image.alpha.begin(), image.alpha.end(), [](std::uint8_t a) { return a < 255; });
    if (!is_cut) image.alpha.clear();
    file_.scene.textures.emplace_back(file.string(), image.width, image.height, image.rgb, image.alpha, content);
  } catch (const std::exception& problem) {
    return bad(problem.what());
  }
  return entry->second = static_cast<int>(file_.scene.textures.size()) - 1;
}

}  // namespace sim
