#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "sim/world/material_library.h"
#include "sim/world/mesh_builder.h"
#include "sim/world/mesh_readers.h"

namespace sim {
namespace {

class OffReader {
 public:
  void Line(std::string_view word, std::string_view rest, int line) {
    const std::size_t name = word.find("OFF");
    if (!has_header_ && name != std::string_view::npos) {
      const std::string_view kind = word.substr(0, name);
      if (kind.find_first_of("4n") != std::string_view::npos || rest.find("BINARY") != std::string_view::npos)
        throw std::runtime_error("it is OFF of another kind than text with three coordinates");
      has_normal_ = kind.find('N') != std::string_view::npos, has_uv_ = kind.find("ST") != std::string_view::npos;
      has_header_ = true;
      word.remove_prefix(name + 3);  // the counts may follow at once
      if (word.empty()) word = NextWord(rest);
    }
    std::vector<double> n;
    for (; !word.empty() && word[0] != '#'; word = NextWord(rest)) {
      const std::optional<double> number = ToNumber(word);
      if (!number) throw std::runtime_error("line " + std::to_string(line) + ": '" + std::string(word) + "'");
      n.push_back(*number);
    }
    if (n.empty()) return;
    if (vertices_ < 0 && n.size() >= 2) {
      vertices_ = n[0], faces_ = n[1];
    } else if (static_cast<double>(pools_.positions.size()) < vertices_) {
      Vertex(n, line);
    } else if (faces_-- > 0) {
      Face(n, line);
    }
  }

  void Build(MeshImport& import) {
    if (faces_ > 0 || static_cast<double>(pools_.positions.size()) < vertices_)
      throw std::runtime_error("the file ends too early");
    if (const std::string problem = IndexProblem(polygons_, pools_); !problem.empty())
      throw std::runtime_error(problem);
    Box used;
    used.Add(polygons_, pools_);
    import.origin = OriginFor(used);
    std::vector<std::string> unsaid;  // 0 ... 255 is usual
    ScaleColors(pools_, unsaid);
    if (!pools_.colors.empty()) pools_.colors.emplace_back(1.0f);  // what has none is white
    for (Corner& corner : polygons_.corners)
      if (corner[3] < 0) corner[3] = static_cast<std::int32_t>(pools_.colors.size()) - 1;
    import.scene.materials.emplace_back();
    AppendPolygons(polygons_, pools_, import.origin, import.scene.meshes.emplace_back());
    import.scene.nodes.push_back(NodeOfAll(import.scene.meshes));
  }

 private:
  // Coordinates, normal, colour, texture coordinates.
  void Vertex(const std::vector<double>& n, int line) {
    const auto single = [&](std::size_t i) { return static_cast<float>(n[i]); };
    const std::size_t color = has_normal_ ? 6 : 3, uv = n.size() - (has_uv_ ? 2 : 0);
    if (n.size() < color || uv < color)
      throw std::runtime_error("line " + std::to_string(line) + ": a vertex lacks numbers");
    pools_.positions.emplace_back(n[0], n[1], n[2]);
    if (has_normal_) pools_.normals.emplace_back(single(3), single(4), single(5));
    if (has_uv_) pools_.uvs.emplace_back(single(uv), single(uv + 1));
    color_of_.push_back(Color(n, color, uv));
  }

  // The number of corners, their vertices, a colour.
  void Face(const std::vector<double>& n, int line) {
    if (!(n[0] >= 0 && n[0] < static_cast<double>(n.size())))
      throw std::runtime_error("line " + std::to_string(line) + ": a face lacks vertices");
    const auto end = 1 + static_cast<std::size_t>(n[0]);
    if (end < 4) return;
    const std::int32_t color = Color(n, end, n.size());
    polygons_.sizes.push_back(static_cast<std::uint32_t>(end - 1));
    for (std::size_t k = 1; k < end; ++k) {
      if (!(n[k] >= 0 && n[k] < static_cast<double>(color_of_.size())))
        throw std::runtime_error("line " + std::to_string(line) + ": a face names a vertex that does not exist");
      const auto i = static_cast<std::int32_t>(n[k]);
      polygons_.corners.push_back(
          {i, has_uv_ ? i : -1, has_normal_ ? i : -1, color >= 0 ? color : color_of_[static_cast<std::size_t>(i)]});
    }
  }

  // The index of a colour; -1: there is none, or one of a table that the file does not have.
  std::int32_t Color(const std::vector<double>& n, std::size_t begin, std::size_t end) {
    if (begin + 3 > end) return -1;
    pools_.colors.emplace_back(n[begin], n[begin + 1], n[begin + 2], 1);
    return static_cast<std::int32_t>(pools_.colors.size()) - 1;
  }

  bool has_header_ = false, has_normal_ = false, has_uv_ = false;
  double vertices_ = -1, faces_ = 0;  // that are to come
  PolygonPools pools_;
  Polygons polygons_;
  std::vector<std::int32_t> color_of_;  // of vertices
};

}  // namespace

void ReadOff(MeshFiles& files, MeshImport& import) {
  OffReader reader;
  try {
    ForEachStatement(files.Read(files.mesh()).value_or(""),
                     [&](std::string_view word, std::string_view rest, int line) { reader.Line(word, rest, line); });
    reader.Build(import);
  } catch (const std::runtime_error& error) {
    import.problem = std::string("cannot be read: ") + error.what();
  }
}

}  // namespace sim
