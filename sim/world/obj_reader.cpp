#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <string_view>
#include <tuple>

#include "sim/world/material_library.h"
#include "sim/world/mesh_builder.h"
#include "sim/world/mesh_readers.h"
#include "sim/world/texture_file.h"

namespace sim {
namespace {

namespace fs = std::filesystem;

struct Part {
  std::string name, material;
  Polygons polygons{};
};

class ObjReader {
 public:
  ObjReader(MeshFiles& files, MeshImport& import) : files_(files), import_(import) {}

  void Read() {
    const std::optional<std::string> text = files_.Read(files_.mesh());
    if (!text) return Fail("cannot be opened");
    ForEachStatement(*text, [&](std::string_view word, std::string_view rest, int line) {
      line_ = line;
      Statement(word, rest);
    });
    if (pools_.colors.empty()) PolypaintColors(*text);
    for (const Part& part : parts_) {  // forward references are allowed
      if (problems_.empty()) problems_ = IndexProblem(part.polygons, pools_);
    }
    if (!problems_.empty()) return Fail("cannot be read: " + problems_);
    Build();
  }

 private:
  void Fail(const std::string& what) { import_.problem = what; }
  void Problem(const std::string& what) {
    constexpr int kMostProblems = 5;
    if (++problem_count_ > kMostProblems) return;
    problems_ += (problems_.empty() ? "line " : "; line ") + std::to_string(line_) + ": " + what;
  }

  // Numbers of the rest of the line, as many as there are.
  std::size_t Numbers(std::string_view rest, std::span<double> numbers) {
    std::size_t count = 0;
    for (std::string_view word = NextWord(rest); !word.empty() && count < numbers.size(); word = NextWord(rest)) {
      if (word[0] == '#') break;
      const std::optional<double> number = ToNumber(word);
      if (!number) {
        Problem("'" + std::string(word) + "' is not a number");
        break;
      }
      numbers[count++] = *number;
    }
    return count;
  }

  void Statement(std::string_view word, std::string_view rest) {
    std::array<double, 8> n{};
    if (word == "v") {
      const std::size_t count = Numbers(rest, n);
      if (count < 3) return Problem("a vertex has three coordinates");
      pools_.positions.emplace_back(n[0], n[1], n[2]);
      known_ = true;
      if (count < 6) return;
      pools_.colors.resize(pools_.positions.size(), glm::vec4(1.0f));
      pools_.colors.back() = glm::vec4(n[3], n[4], n[5], 1);
    } else if (word == "vt") {
      if (Numbers(rest, n) < 1) return Problem("a texture coordinate has a number");
      pools_.uvs.emplace_back(n[0], n[1]);
    } else if (word == "vn") {
      Normal(rest);
    } else if (word == "f" || word == "fo") {
      Face(rest);
    } else if (word == "usemtl") {
      material_ = rest;
    } else if (word == "o" || word == "g") {
      name_ = rest;
    } else if (word == "mtllib") {
      Library(rest);
    } else {
      surfaces_ += word == "surf";
      known_ = known_ || word == "l" || word == "p" || word == "surf";
      return;
    }
    known_ = true;
  }

  // Vertex colours in comments of ZBrush: "#MRGB" and MMRRGGBB, hexadecimal, of each vertex in turn; M is a mask.
  void PolypaintColors(std::string_view text) {
    static constexpr std::string_view kKey = "#MRGB ";
    for (std::size_t at = text.find(kKey); at != std::string_view::npos; at = text.find(kKey, at)) {
      if (at > 0 && text[at - 1] != '\n') return pools_.colors.clear();
      at += kKey.size();
      std::uint32_t bits = 0;
      for (const char* begin = text.data() + at; text.size() - at >= 8; at += 8, begin += 8) {
        const auto [end, error] = std::from_chars(begin, begin + 8, bits, 16);
        if (error != std::errc() || end != begin + 8) break;
        const glm::vec3 code(bits >> 16 & 255u, bits >> 8 & 255u, bits & 255u);
        pools_.colors.emplace_back(code / 255.0f, 1.0f);
      }
    }
    if (pools_.colors.size() != pools_.positions.size()) pools_.colors.clear();
  }

  // One that is not finite leads to flat normals.
  void Normal(std::string_view rest) {
    glm::vec3& normal = pools_.normals.emplace_back();
    for (int i = 0; i < 3; ++i) {
      const std::string_view word = NextWord(rest);
      if (word.empty()) return Problem("a normal has three coordinates");
      normal[i] = static_cast<float>(ToNumber(word).value_or(std::nan("")));
    }
  }

  void Face(std::string_view rest) {
    std::vector<Corner> corners;
    bool has_uv = true, has_normal = true;
    for (std::string_view word = NextWord(rest); !word.empty() && word[0] != '#'; word = NextWord(rest)) {
      Corner corner{-1, -1, -1, -1};
      const std::array<std::size_t, 3> counts = {pools_.positions.size(), pools_.uvs.size(), pools_.normals.size()};
      for (std::size_t i = 0; i < 3 && !word.empty(); ++i) {
        const std::size_t end = std::min(word.find('/'), word.size());
        if (end > 0) {
          std::int32_t index = 0;
          const auto [stop, error] = std::from_chars(word.data(), word.data() + end, index);
          if (error != std::errc() || stop != word.data() + end || index == 0)
            return Problem("'" + std::string(word.substr(0, end)) + "' is not an index");
          corner[i] = index > 0 ? index - 1 : static_cast<std::int32_t>(counts[i]) + index;
          if (corner[i] < 0) return Problem(std::to_string(index) + " names a vertex that does not exist");
        }
        word.remove_prefix(std::min(end + 1, word.size()));
      }
      if (corner[0] < 0) return Problem("a corner without a vertex");
      has_uv = has_uv && corner[1] >= 0;
      has_normal = has_normal && corner[2] >= 0;
      corners.push_back(corner);
    }
    if (corners.size() < 3) return;
    for (Corner& corner : corners) {
      if (!has_uv) corner[1] = -1;
      if (!has_normal) corner[2] = -1;
    }
    const auto [at, is_new] = part_of_.try_emplace({name_, material_, has_uv, has_normal}, parts_.size());
    if (is_new) parts_.push_back({name_, material_});
    Polygons& polygons = parts_[at->second].polygons;
    polygons.sizes.push_back(static_cast<std::uint32_t>(corners.size()));
    polygons.corners.insert(polygons.corners.end(), corners.begin(), corners.end());
  }

  // One name, which may have blanks, or several without.
  void Library(std::string_view rest) {
    if (rest.size() > 1 && rest.front() == '"' && rest.back() == '"') rest = rest.substr(1, rest.size() - 2);
    if (ReadLibrary(rest)) return;
    std::string_view words = rest;
    const std::string_view first = NextWord(words);
    if (words.empty()) return files_.Missing(std::string(rest));
    for (std::string_view name = first; !name.empty(); name = NextWord(words)) {
      if (!ReadLibrary(name)) files_.Missing(std::string(name));
    }
  }
  bool ReadLibrary(std::string_view name) {
    const fs::path folder = files_.mesh().parent_path();
    const TextureFile found = FindTexture(std::string(name), files_.mesh(), "", files_.folders());
    const std::optional<std::string> text = found.problem.empty() ? files_.Read(found.file) : std::nullopt;
    if (!text) return false;
    if (found.is_elsewhere) import_.warnings.push_back("takes " + found.file.string() + " for " + std::string(name));
    const std::vector<std::string> left_out = ReadMaterialLibrary(
        *text, found.file.parent_path().lexically_relative(folder.empty() ? "." : folder).string(), materials_);
    if (!left_out.empty())
      import_.warnings.push_back(
          found.file.string() + ": " + std::to_string(left_out.size()) +
          " × values that are not plain numbers (with a point) are left out (first: " + left_out[0] + ")");
    any_library_ = true;
    return true;
  }

  void Build() {
    if (!known_) return Fail("cannot be read: has no statement of an OBJ file (in ASCII or UTF-8)");
    if (parts_.empty())
      return Fail(
          "has no triangles: points, lines, curves and free-form surfaces are not rendered; convert them to faces "
          "first");
    if (surfaces_ > 0)
      import_.warnings.push_back(std::to_string(surfaces_) +
                                 " of its surfaces are free-form (surf): they are left out");
    Box used;
    for (const Part& part : parts_) used.Add(part.polygons, pools_);
    import_.origin = OriginFor(used);
    if (!pools_.colors.empty()) pools_.colors.resize(pools_.positions.size(), glm::vec4(1.0f));
    ScaleColors(pools_, import_.warnings);
    auto& [nodes, meshes, materials, pictures] = import_.scene;
    std::map<std::string, unsigned> index_of;
    for (Part& part : parts_) {
      for (Corner& corner : part.polygons.corners) corner[3] = pools_.colors.empty() ? -1 : corner[0];
      ImportedMesh& mesh = meshes.emplace_back();
      mesh.name = part.name;
      const auto [at, is_new] = index_of.try_emplace(part.material, static_cast<unsigned>(materials.size()));
      if (is_new) {
        const auto known = materials_.find(part.material);
        if (known == materials_.end() && !part.material.empty() && (any_library_ || import_.missing.empty()))
          import_.warnings.push_back("names the material '" + part.material + "', which " +
                                     (any_library_ ? "its library does not have" : "no library (mtllib) defines"));
        materials.push_back(known == materials_.end() ? ImportedMaterial{part.material} : known->second);
      }
      mesh.material = at->second;
      AppendPolygons(part.polygons, pools_, import_.origin, mesh);
    }
    nodes.push_back(NodeOfAll(meshes));
  }

  MeshFiles& files_;
  MeshImport& import_;
  int line_ = 0, problem_count_ = 0, surfaces_ = 0;
  std::string problems_;
  bool known_ = false, any_library_ = false;
  PolygonPools pools_;
  std::string name_, material_;
  std::vector<Part> parts_;
  std::map<std::tuple<std::string, std::string, bool, bool>, std::size_t> part_of_;
  std::map<std::string, ImportedMaterial> materials_;
};

}  // namespace

void ReadObj(MeshFiles& files, MeshImport& import) { ObjReader(files, import).Read(); }

}  // namespace sim
