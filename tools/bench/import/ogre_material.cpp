#include <map>
#include <sstream>

#include "tools/base/files.h"
#include "tools/bench/import/import.h"

namespace vobench {
namespace {

namespace fs = std::filesystem;

// Diffuse colours; those of the name with "Glow" are the same.
// Source: gazebo.material, Gazebo 11.
const std::map<std::string, glm::dvec3> kPlain = {{"Gazebo/Grey", {.7, .7, .7}},
                                                  {"Gazebo/DarkGrey", {.175, .175, .175}},
                                                  {"Gazebo/White", {1, 1, 1}},
                                                  {"Gazebo/FlatBlack", {.1, .1, .1}},
                                                  {"Gazebo/Black", {0, 0, 0}},
                                                  {"Gazebo/Red", {1, 0, 0}},
                                                  {"Gazebo/RedBright", {.87, .26, .07}},
                                                  {"Gazebo/Green", {0, 1, 0}},
                                                  {"Gazebo/Blue", {0, 0, 1}},
                                                  {"Gazebo/SkyBlue", {0, 0, 1}},
                                                  {"Gazebo/Yellow", {1, 1, 0}},
                                                  {"Gazebo/ZincYellow", {.9725, .9529, .2078}},
                                                  {"Gazebo/Purple", {1, 0, 1}},
                                                  {"Gazebo/Turquoise", {0, 1, 1}},
                                                  {"Gazebo/Orange", {1, .5088, .0468}},
                                                  {"Gazebo/Gold", {.8, .64869, .120759}}};

// Words without comments and quotes, braces apart.
std::istringstream Words(std::string script) {
  for (std::size_t at = 0; (at = script.find("/*", at)) != std::string::npos;) {
    const std::size_t end = script.find("*/", at + 2);
    script.replace(at, end == std::string::npos ? end : end + 2 - at, " ");
  }
  std::string plain;
  std::istringstream lines(script);
  for (std::string line; std::getline(lines, line); plain += '\n') {
    for (const char c : line.substr(0, line.find("//")))
      plain += c == '{' ? " { " : c == '}' ? " } " : std::string(c != '"', c);
  }
  return std::istringstream(plain);
}

std::optional<OgreMaterial> FindIn(const fs::path& script, const std::string& name) {
  std::istringstream words = Words(base::ReadFile(script).value_or(""));
  for (std::string word; words >> word;) {
    if (word != "material" || !(words >> word) || (word != name && word != name + ':')) continue;
    OgreMaterial material;
    for (int depth = 0; words >> word && !(word == "}" && --depth == 0); words.clear()) {
      depth += word == "{" ? 1 : 0;
      if (depth == 0) material.base = word.substr(word.starts_with(':') ? 1 : 0);
      glm::dvec3 c(0.0);
      if (word == "texture" && material.texture.empty()) words >> material.texture;
      if (word == "diffuse" && !material.diffuse && words >> c.r >> c.g >> c.b) material.diffuse = c;
      if (word == "emissive" && words >> c.r >> c.g >> c.b) material.is_emissive |= c != glm::dvec3(0);
      material.is_scaled |= word == "scale";
    }
    return material;
  }
  return std::nullopt;
}

std::optional<OgreMaterial> FindOne(const std::string& name, const std::vector<fs::path>& scripts) {
  for (const fs::path& script : scripts) {
    std::error_code error;
    std::vector<fs::path> files(fs::is_regular_file(script, error) ? 1 : 0, script);
    for (const auto& entry : fs::directory_iterator(script, error))
      if (entry.path().extension() == ".material") files.push_back(entry.path());
    for (const fs::path& file : files)
      if (auto found = FindIn(file, name)) return found;
  }
  const bool glows = name.ends_with("Glow");
  const auto plain = kPlain.find(name.substr(0, name.size() - (glows ? 4 : 0)));
  return plain == kPlain.end() ? std::nullopt
                               : std::optional(OgreMaterial{.diffuse = plain->second, .is_emissive = glows});
}

}  // namespace

std::optional<OgreMaterial> FindOgreMaterial(const std::string& name, const std::vector<fs::path>& scripts) {
  constexpr int kMostBases = 10;  // of bases that inherit from each other
  std::optional<OgreMaterial> material = FindOne(name, scripts);
  for (int i = 0; i < kMostBases && material && !material->base.empty(); ++i) {
    const auto base = FindOne(material->base, scripts);
    if (!base) break;
    if (!material->diffuse) material->diffuse = base->diffuse;
    if (material->texture.empty()) material->texture = base->texture;
    material->base = base->base;
    material->is_emissive |= base->is_emissive, material->is_scaled |= base->is_scaled;
  }
  return material;
}

}  // namespace vobench
