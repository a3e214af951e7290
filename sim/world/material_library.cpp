#include "sim/world/material_library.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <vector>

#include "sim/world/mesh_builder.h"
#include "sim/world/texture_file.h"
#include "tools/base/text.h"

namespace sim {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";

std::string_view Trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

// One to three numbers; of those that are left out `otherwise`.
std::array<double, 3> UpToThree(std::string_view& rest, double otherwise) {
  std::array<double, 3> numbers = {otherwise, otherwise, otherwise};
  for (double& number : numbers) {
    std::string_view after = rest;
    const std::optional<double> read = ToNumber(NextWord(after));
    if (!read || after.empty()) break;  // the last word is the file's name
    number = *read;
    rest = after;
  }
  return numbers;
}

// `[-option values] ... file name`
LibraryMap ReadMap(std::string_view rest) {
  LibraryMap map;
  std::array<double, 3> scale = {1, 1, 1}, offset = {0, 0, 0};
  while (rest.starts_with('-')) {
    std::string_view after = rest;
    const std::string_view option = NextWord(after);
    if (after.empty()) break;  // a name that begins so
    if (option == "-s") {
      scale = UpToThree(after, 1);
    } else if (option == "-o") {
      offset = UpToThree(after, 0);
    } else if (option == "-t") {
      UpToThree(after, 0);  // turbulence
    } else if (option == "-mm") {
      const std::optional<double> base = ToNumber(NextWord(after)), gain = ToNumber(NextWord(after));
      map.own_range = base != 0.0 || gain != 1.0;
    } else if (option == "-clamp") {
      map.clamp = NextWord(after) == "on";
    } else if (option == "-blendu" || option == "-blendv" || option == "-bm" || option == "-boost" ||
               option == "-imfchan" || option == "-texres" || option == "-type" || option == "-cc") {
      NextWord(after);
    } else {
      break;
    }
    rest = after;
  }
  if (rest.size() > 1 && rest.front() == '"' && rest.back() == '"') rest = rest.substr(1, rest.size() - 2);
  map.file = rest;
  // uv' = scale uv + offset where v points up.
  map.transform = glm::dmat3x2(scale[0], 0, 0, scale[1], offset[0], 1 - scale[1] - offset[1]);
  return map;
}

void SetMap(aiMaterial& material, const LibraryMap& map, aiTextureType type) {
  if (map.file.empty()) return;
  SetText(material, map.file, AI_MATKEY_TEXTURE(type, 0));
  SetUvTransform(material, type, map.transform);
  const int mode = map.clamp ? aiTextureMapMode_Clamp : aiTextureMapMode_Wrap;
  material.AddProperty(&mode, 1, AI_MATKEY_MAPPINGMODE_U(type, 0));
  material.AddProperty(&mode, 1, AI_MATKEY_MAPPINGMODE_V(type, 0));
}

}  // namespace

void ForEachStatement(std::string_view text,
                      const std::function<void(std::string_view word, std::string_view rest, int line)>& call) {
  text = base::WithoutMark(text);
  std::string joined, lines;
  if (text.find('\n') == std::string_view::npos && text.find('\r') != std::string_view::npos) {
    lines = text;
    std::ranges::replace(lines, '\r', '\n');
    text = lines;
  }
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view statement = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (statement.ends_with('\r')) statement.remove_suffix(1);
    if (statement.ends_with('\\') && !text.empty()) {
      joined += std::string(statement.substr(0, statement.size() - 1)) + ' ';
      continue;
    }
    if (!joined.empty()) statement = joined += statement;
    std::string_view rest = Trimmed(statement);
    if (!rest.empty() && rest[0] != '#') {
      const std::string_view word = NextWord(rest);
      call(word, rest, line);
    }
    joined.clear();
  }
}

std::string_view NextWord(std::string_view& rest) {
  const std::size_t begin = std::min(rest.find_first_not_of(kBlanks), rest.size());
  const std::size_t end = std::min(rest.find_first_of(kBlanks, begin), rest.size());
  const std::string_view word = rest.substr(begin, end - begin);
  rest = Trimmed(rest.substr(end));
  return word;
}

std::optional<double> ToNumber(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const char* const all = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), all, value);
  if (error == std::errc::result_out_of_range && end == all) return std::strtod(std::string(text).c_str(), nullptr);
  return error == std::errc() && end == all ? std::optional(value) : std::nullopt;
}

void ReadMaterialLibrary(std::string_view text, const std::string& folder,
                         std::map<std::string, LibraryMaterial>& materials) {
  LibraryMaterial* m = nullptr;
  ForEachStatement(text, [&](std::string_view word, std::string_view rest, int) {
    const std::string key = Lower(std::string(word));
    const auto number = [&] {
      std::string_view words = rest;
      return ToNumber(NextWord(words));
    };
    const auto color = [&](glm::vec3& value) {
      std::string_view words = rest;
      const auto r = ToNumber(NextWord(words)), g = ToNumber(NextWord(words)), b = ToNumber(NextWord(words));
      if (r) value = g && b ? glm::vec3(*r, *g, *b) : glm::vec3(static_cast<float>(*r));
    };
    if (key == "newmtl") {
      m = &materials.insert_or_assign(std::string(rest), LibraryMaterial{std::string(rest), folder}).first->second;
      return;
    }
    if (m == nullptr) return;
    if (key == "kd") color(m->color);
    if (key == "ke") color(m->emission.emplace(0.0f));
    if (key == "d")
      m->opacity = ToNumber(rest.substr(rest.starts_with("-halo") ? 5 : 0)).value_or(number().value_or(1));
    if (key == "tr") {  // MeshLab writes 1 for what is opaque
      const double transparency = number().value_or(0);
      if (transparency > 0 && transparency < 1) m->opacity = 1 - transparency;
    }
    if (key == "pr") m->roughness = number().value_or(1);
    if (key == "pm") m->metallic = number().value_or(0);
    if (key == "map_kd") m->color_map = ReadMap(rest);
    if (key == "map_d") m->opacity_map = ReadMap(rest);
    if (key == "map_ke") m->emission_map = ReadMap(rest);
    if (key == "norm") m->normal_map = ReadMap(rest);
  });
}

aiMaterial* ToAssimp(const LibraryMaterial& from) {
  auto* to = new aiMaterial;
  SetText(*to, from.name, AI_MATKEY_NAME);
  SetText(*to, from.folder, kFolderKey);
  const aiColor4D color(from.color.r, from.color.g, from.color.b, 1);
  const glm::vec3 glow = from.emission.value_or(glm::vec3(from.emission_map.file.empty() ? 0.0f : 1.0f));
  const aiColor3D emission(glow.r, glow.g, glow.b);
  to->AddProperty(&color, 1, AI_MATKEY_BASE_COLOR);
  to->AddProperty(&emission, 1, AI_MATKEY_COLOR_EMISSIVE);
  const auto number = [&](double value, const char* key, unsigned type, unsigned index) {
    const auto single = static_cast<float>(value);
    to->AddProperty(&single, 1, key, type, index);
  };
  number(from.opacity, AI_MATKEY_OPACITY);
  number(from.roughness, AI_MATKEY_ROUGHNESS_FACTOR);
  number(from.metallic, AI_MATKEY_METALLIC_FACTOR);
  SetMap(*to, from.color_map, aiTextureType_BASE_COLOR);
  SetMap(*to, from.opacity_map, aiTextureType_OPACITY);
  SetMap(*to, from.emission_map, aiTextureType_EMISSIVE);
  SetMap(*to, from.normal_map, aiTextureType_NORMALS);
  return to;
}

}  // namespace sim
