#include <map>
#include <sstream>

#include "tools/base/files.h"
#include "tools/bench/import/import.h"

namespace vobench {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, glm::dvec3> kPlain = {
    {"Gazebo/Grey", {.7, .7, .7}},       {"Gazebo/DarkGrey", {.175, .175, .175}},
    {"Gazebo/White", {1, 1, 1}},         {"Gazebo/Black", {0, 0, 0}},
    {"Gazebo/Red", {1, 0, 0}},           {"Gazebo/Green", {0, 1, 0}},
    {"Gazebo/Blue", {0, 0, 1}},          {"Gazebo/Yellow", {1, 1, 0}},
    {"Gazebo/Orange", {1, .5088, .0468}}};

// Words without comments and quotes, braces apart.
std::istringstream Words(const std::string& script) {
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
    if (word != "material" || !(words >> word) || word != name) continue;
    OgreMaterial material;
    for (int depth = 0; words >> word && !(word == "}" && --depth == 0); words.clear()) {
      depth += word == "{" ? 1 : 0;
      glm::dvec3 c(0.0);
      if (word == "texture" && material.texture.empty()) words >> material.texture;
      if (word == "diffuse" && !material.diffuse && words >> c.r >> c.g >> c.b) material.diffuse = c;
    }
    return material;
  }
  return std::nullopt;
}

}  // namespace

std::optional<OgreMaterial> FindOgreMaterial(const std::string& name, const std::vector<fs::path>& scripts) {
  for (const fs::path& script : scripts) {
    std::error_code error;
    std::vector<fs::path> files(fs::is_regular_file(script, error) ? 1 : 0, script);
    for (const auto& entry : fs::directory_iterator(script, error))
      if (entry.path().extension() == ".material") files.push_back(entry.path());
    for (const fs::path& file : files)
      if (auto found = FindIn(file, name)) return found;
  }
  const auto plain = kPlain.find(name);
  return plain == kPlain.end() ? std::nullopt : std::optional(OgreMaterial{plain->second, ""});
}

}  // namespace vobench
