#include "sim/world/mesh_material.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/vector_relational.hpp>
#include <opencv2/core.hpp>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "sim/world/texture_cache.h"
#include "sim/world/texture_file.h"
#include "tools/base/files.h"
#include "tools/base/limits/picture.h"

namespace sim {
namespace {

namespace fs = std::filesystem;

DecodedImage Decode(const ImportedPicture& picture, bool with_alpha) {
  if (picture.height == 0) return DecodeImage(picture.bytes, with_alpha);
  const std::size_t texels = picture.bytes.size() / 4;
  const std::string problem = limits::PictureSizeProblem(picture.width, picture.height, picture.bytes.size());
  if (!problem.empty()) throw std::runtime_error(problem);
  if (texels != std::size_t{picture.width} * picture.height) throw std::runtime_error("its texels are not all there");
  DecodedImage image(cv::Mat(static_cast<int>(picture.height), static_cast<int>(picture.width), CV_8UC3));
  for (std::size_t i = 0; i < texels; ++i) {
    const std::uint8_t* bgra = &picture.bytes[4 * i];
    for (std::size_t c = 0; c < 3; ++c) image.rgb[3 * i + c] = bgra[2 - c];
    if (with_alpha) image.alpha.push_back(bgra[3]);
  }
  return image;
}

// The value of `call`, whose exceptions begin with `problem`.
template <class Call>
auto WithProblem(const std::string& problem, const Call& call) try {
  return call();
} catch (const std::exception& error) {
  throw std::runtime_error(problem + error.what());
}

// The largest alpha of a material's picture.
float MostAlpha(const Scene& scene, const Material& material) {
  if (material.texture < 0) return 1;
  const std::span<const std::uint8_t> alpha = scene.textures[static_cast<std::size_t>(material.texture)].alpha();
  return alpha.empty() ? 1 : static_cast<float>(*std::ranges::max_element(alpha)) / 255.0f;
}

}  // namespace

const MeshMaterial& MeshMaterialReader::Material(unsigned index) {
  MeshMaterial& known = materials_.at(index);
  if (known.index < 0) known = Read(from_.materials[index]);
  return known;
}

MeshMaterial MeshMaterialReader::Read(const ImportedMaterial& in) {
  using Content = Texture::Content;
  sim::Material material;
  material.name = in.name;
  glm::vec3 emission = in.emission;
  if (!file_.is_gltf && !in.emission_map.picture.empty() && emission == glm::vec3(0)) emission = glm::vec3(1);
  for (const float c : {in.base_color.r, in.base_color.g, in.base_color.b, emission.r, emission.g, emission.b}) {
    if (!std::isfinite(c) || c < 0) {
      file_.Problem("material '" + material.name + "': a colour is negative or not finite: " + std::to_string(c));
      break;
    }
  }
  material.base_color = in.base_color;
  material.emission = emission;
  material.alpha = file_.is_gltf ? in.base_color.a : 1.0f;  // elsewhere transparency is not rendered
  ReadAlpha(in, material);

  std::vector<UvChoice> uvs;
  const ImportedMap* mask = in.opacity_map.picture.empty() ? nullptr : &in.opacity_map;
  material.texture = ReadTexture(in, {in.color_map, "", Content::color, material.alpha_cutoff > 0, mask}, uvs);
  if (material.texture < 0 && mask != nullptr && in.color_map.picture.empty())
    material.texture = ReadTexture(in, {in.opacity_map, "opacity ", Content::color, true, mask}, uvs);
  if (emission.r > 0 || emission.g > 0 || emission.b > 0) {
    material.emission_texture = ReadTexture(in, {in.emission_map, "emission "}, uvs);
    if (material.emission_texture < 0 && !in.emission_map.picture.empty()) material.emission = glm::vec3(0);
    if (file_.extension == ".ac") material.emission_texture = material.texture;  // AC3D: it applies to all light
  }
  if (!file_.is_gltf && material.texture >= 0 && material.base_color == glm::vec3(0))
    file_.Warn("material '" + material.name + "': ", "a colour of 0 makes its picture black");
  material.normal_map = ReadTexture(in, {in.normal_map, "normal ", Content::numbers}, uvs);
  material.normal_scale = in.normal_scale;
  material.metallic = std::clamp(in.metallic, 0.0f, 1.0f);
  material.roughness = std::clamp(in.roughness, 0.0f, 1.0f);
  if (file_.is_gltf)
    material.gloss_texture = ReadTexture(in, {in.gloss_map, "metallic-roughness ", Content::numbers}, uvs);
  material.lacks_gloss_map = !file_.is_gltf && !in.gloss_map.picture.empty();
  if (in.has_bumps != 0) file_.Warn("material '" + in.name + "': ", "bump maps (heights) are not rendered");
  if (in.unlit != 0) {  // radiance is the base colour, without lighting
    material.emission = std::exchange(material.base_color, glm::vec3(0));
    material.emission_texture = material.texture;
    material.metallic = 0, material.roughness = 1;
    material.normal_map = material.gloss_texture = -1;
  }
  MeshMaterial result;
  result.is_unlit = in.unlit != 0;
  result.index = static_cast<int>(file_.scene.materials.size());
  if (!uvs.empty()) result.uv = uvs.front();
  file_.scene.materials.push_back(std::move(material));
  return result;
}

// Alpha modes are those of glTF. In all other formats the alpha of a picture cuts out.
void MeshMaterialReader::ReadAlpha(const ImportedMaterial& in, sim::Material& material) {
  const std::string who = "material '" + material.name + "': ";
  if (in.alpha_mode.empty()) {
    if (in.opacity < 1)
      file_.Warn(who + "d or transparency is " + std::to_string(in.opacity) + "; ",
                 "transparency is not rendered; it is opaque");
    if (!file_.is_gltf) material.alpha_cutoff = 0.5f;
  } else if (in.alpha_mode == "MASK") {
    material.alpha_cutoff = in.alpha_cutoff;
  } else if (in.alpha_mode == "BLEND") {
    material.alpha_cutoff = 0.5f;
    file_.Warn(who, "alphaMode BLEND is not rendered; it is a cut-out where alpha is 0.5");
  }
}

// Whether two choices look up the same on all meshes of a material: sets may be equal, and wrapping not used.
bool MeshMaterialReader::IsSamePlace(const ImportedMaterial& in, const UvChoice& a, const UvChoice& b) const {
  const auto& meshes = meshes_of_[static_cast<std::size_t>(&in - from_.materials.data())];
  const auto set = [](const ImportedMesh& mesh, const UvChoice& choice) {
    return choice.channel < mesh.uvs.size() ? std::span<const glm::vec2>(mesh.uvs[choice.channel])
                                            : std::span<const glm::vec2>();
  };
  const auto is_inside = [&](const glm::vec2& uv) {
    const glm::dvec2 x = a.transform * glm::dvec3(uv.x, 1.0 - static_cast<double>(uv.y), 1.0);
    return glm::all(glm::greaterThanEqual(x, glm::dvec2(0))) && glm::all(glm::lessThanEqual(x, glm::dvec2(1)));
  };
  return a.transform == b.transform && std::ranges::all_of(meshes, [&](const ImportedMesh* mesh) {
           return (a.channel == b.channel || std::ranges::equal(set(*mesh, a), set(*mesh, b))) &&
                  (a.wrap == b.wrap || std::ranges::all_of(set(*mesh, a), is_inside));
         });
}

// The picture of one use, or -1. Pictures of a material share one set of texture coordinates: one that needs another is
// left out.
int MeshMaterialReader::ReadTexture(const ImportedMaterial& in, const Use& use, std::vector<UvChoice>& uvs) {
  if (use.map.picture.empty()) return -1;
  if (!uvs.empty() && !IsSamePlace(in, uvs.front(), use.map.uv)) {
    file_.Warn("material '" + in.name + "': the " + use.what + "texture " + use.map.picture + " ",
               "has other texture coordinates or wrapping than the material's first; it is left out");
    return -1;
  }
  uvs.push_back(use.map.uv);
  return TextureIndex(in, use);
}

TextureFile MeshMaterialReader::FileOf(const ImportedMaterial& in, const ImportedMap& map) const {
  return map.embedded >= 0 ? TextureFile{file_.path / map.picture}
                           : FindTexture(map.picture, file_.path, in.folder, file_.loading.folders);
}

MeshMaterialReader::Source MeshMaterialReader::Find(const ImportedMaterial& in, const ImportedMap& map,
                                                    const TextureFile& found, std::string& problem) {
  const std::string who = "material '" + in.name + "': ";
  problem = found.file.string() + ": texture of material '" + in.name + "' in " + file_.path.string() + ": ";
  if (map.embedded >= 0) return [picture = from_.pictures[static_cast<std::size_t>(map.embedded)]] { return picture; };
  file_.scene.files.insert(found.file);
  if (found.problem.starts_with("must")) {
    file_.Problem(who + "the texture path '" + map.picture + "' " + found.problem);
    return {};
  }
  if (!found.problem.empty() && file_.loading.missing_textures == MissingTextures::grey) {
    file_.Warn(who + "'" + map.picture + "': ", "a texture that is not there is grey");
    return [] { return ImportedPicture{1, 1, {128, 128, 128, 255}}; };
  }
  if (!found.problem.empty()) {
    const bool is_far = map.picture.find("://") != std::string::npos && !map.picture.starts_with("file");
    file_.loading.problems.push_back(problem + (is_far ? "nothing is fetched from the net" : found.problem));
    return {};
  }
  if (found.is_elsewhere)
    file_.Warn(who + found.file.string() + " for '" + map.picture + "': ",
               "a texture is taken from where one of its name lies");
  return [found] {
    if (!fs::is_regular_file(found.file)) throw std::runtime_error("not a file");
    const std::optional<std::string> bytes = base::ReadFile(found.file);
    if (!bytes) throw std::runtime_error("cannot be opened");
    return ImportedPicture{0, 0, {bytes->begin(), bytes->end()}};
  };
}

int MeshMaterialReader::TextureIndex(const ImportedMaterial& in, const Use& use) {
  const std::string& name = use.map.picture;
  const TextureFile found = FileOf(in, use.map);
  const fs::path file = found.problem.empty() ? found.file : file_.path / name;
  const std::string kind = use.content == Texture::Content::numbers ? " (numbers)"
                           : use.with_alpha                         ? " (with alpha)"
                                                                    : "";
  const std::string mask_of = use.mask == nullptr ? "" : " * " + in.folder + "/" + use.mask->picture;
  const auto [entry, is_new] = file_.loading.textures.try_emplace(file.string() + kind + mask_of, -1);
  if (!is_new) return entry->second;  // a bad one has been reported already
  std::string problem, mask_problem;
  const Source picture = Find(in, use.map, found, problem);
  const bool is_mask = use.mask == &use.map;  // only the picture of its opacity
  const bool has_mask = use.mask != nullptr && (is_mask || use.mask->picture != name);
  const Source mask = has_mask ? Find(in, *use.mask, FileOf(in, *use.mask), mask_problem) : Source();
  if (!picture || (has_mask && !mask)) return -1;
  const auto load = [=, content = use.content, with_alpha = use.with_alpha, folders = file_.loading.cache_folders] {
    std::vector<ImportedPicture> from = {WithProblem(problem, picture)};
    if (mask) from.push_back(WithProblem(mask_problem, mask));
    const auto made_of = static_cast<std::uint64_t>(content) * 4 + with_alpha * 2U + is_mask;
    return CachedTexture(file.string(), from, made_of, folders, [&] {
      DecodedImage image = WithProblem(problem, [&] { return Decode(from[0], with_alpha); });
      if (mask) SetAlpha(WithProblem(mask_problem, [&] { return Decode(from[1], true); }), image);
      if (is_mask) std::ranges::fill(image.rgb, std::uint8_t{255});
      if (std::ranges::none_of(image.alpha, [](std::uint8_t a) { return a < 255; })) image.alpha.clear();
      return WithProblem(
          problem, [&] { return Texture(file.string(), image.width, image.height, image.rgb, image.alpha, content); });
    });
  };
  entry->second = static_cast<int>(file_.scene.textures.size());
  file_.scene.textures.emplace_back(file.string(), 1, 1, std::vector<std::uint8_t>(3));  // until it is loaded
  file_.loading.pictures.push_back({entry->second, load});
  return entry->second;
}

void LoadPictures(WorldLoading& loading) {
  std::vector<PictureJob>& jobs = loading.pictures;
  std::vector<std::string> problems(jobs.size());
  tbb::parallel_for(
      std::size_t{0}, jobs.size(),
      [&](std::size_t i) {
        try {
          loading.scene.textures[static_cast<std::size_t>(jobs[i].texture)] = jobs[i].load();
        } catch (const std::exception& problem) {
          problems[i] = problem.what();
        }
      },
      tbb::simple_partitioner());
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (!problems[i].empty()) loading.problems.push_back(problems[i]);
  }
  jobs.clear();
  for (auto& [index, who] : loading.cut_outs) {
    const Material& material = loading.scene.materials[static_cast<std::size_t>(index)];
    if (!who.empty() && material.alpha * MostAlpha(loading.scene, material) < material.alpha_cutoff) {
      std::ostringstream what;
      what << "its alpha is below " << material.alpha_cutoff << " everywhere: it is not seen";
      loading.warnings.Add(who, what.str());
    }
    who.clear();
  }
}

}  // namespace sim
