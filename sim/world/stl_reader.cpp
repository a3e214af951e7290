#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sim/world/material_library.h"
#include "sim/world/mesh_builder.h"
#include "sim/world/mesh_readers.h"
#include "sim/world/texture_file.h"

namespace sim {
namespace {

constexpr std::size_t kHeader = 80, kFirst = kHeader + 4, kFacet = 50;

struct StlFile {
  PolygonPools pools;
  std::vector<std::pair<std::string, Polygons>> solids;

  // A polygon of the last `size` positions; color: its index, or -1.
  void Close(std::size_t size, std::int32_t color) {
    if (solids.empty()) throw std::runtime_error("a facet outside of a solid");
    Polygons& polygons = solids.back().second;
    for (std::size_t i = pools.positions.size() - size; i < pools.positions.size(); ++i)
      polygons.corners.push_back({static_cast<std::int32_t>(i), -1, -1, color});
    polygons.sizes.push_back(static_cast<std::uint32_t>(size));
  }

  void ReadText(std::string_view text) {
    bool is_open = false;     // a solid
    std::size_t corners = 0;  // of the facet
    ForEachStatement(text, [&](std::string_view word, std::string_view rest, int line) {
      for (; !word.empty(); word = NextWord(rest)) {
        const std::string key = Lower(std::string(word));
        if (key == "solid") solids.emplace_back(rest, Polygons());
        if (key == "solid" || key == "endsolid") {
          is_open = key == "solid";
          return;
        }
        if (key == "loop") corners = 0;
        if (key == "endloop" && corners > 2) Close(corners, -1);
        if (key != "vertex") continue;
        glm::dvec3 x;
        for (int i = 0; i < 3; ++i) {
          const std::optional<double> number = ToNumber(NextWord(rest));
          if (!number) throw std::runtime_error("line " + std::to_string(line) + ": a vertex has three numbers");
          x[i] = *number;
        }
        pools.positions.push_back(x);
        ++corners;
      }
    });
    if (is_open) throw std::runtime_error("the file ends too early");
  }

  // Colours are VisCAM's, or Magics' where the header has COLOR=: other bits, and those without one are the object's.
  // A facet's colour is taken where any facet has an attribute.
  void ReadBinary(std::string_view text, std::size_t count) {
    solids.emplace_back();
    const std::string_view header = text.substr(0, kHeader);
    const std::size_t key = header.find("COLOR=");
    const bool is_magics = key <= kHeader - 10;
    pools.colors.emplace_back(1);
    for (int i = 0; i < 3 && is_magics; ++i)
      pools.colors[0][i] =
          static_cast<float>(NumberAt<std::uint8_t>(&header[key + 6 + static_cast<std::size_t>(i)])) / 255;
    const auto attribute = [&](std::size_t i) {
      return static_cast<unsigned>(NumberAt<std::uint16_t>(&text[kFirst + kFacet * (i + 1) - 2]));
    };
    bool has_colors = is_magics, has_own = false;
    for (std::size_t i = 0; i < count; ++i) {
      has_own = has_own || attribute(i) != 0;
      has_colors = has_colors || attribute(i) >= 0x8000;
    }
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t at = kFirst + kFacet * i + 12; at < kFirst + kFacet * (i + 1) - 2; at += 12)
        pools.positions.emplace_back(NumberAt<float>(&text[at]), NumberAt<float>(&text[at + 4]),
                                     NumberAt<float>(&text[at + 8]));
      const unsigned code = attribute(i);
      const bool is_own = has_own && is_magics == (code < 0x8000);
      const auto five = [&](unsigned shift) {
        return static_cast<float>(code >> (is_magics ? shift : 10 - shift) & 31) / 31;
      };
      if (is_own) pools.colors.emplace_back(five(0), five(5), five(10), 1);
      Close(3, !has_colors ? -1 : is_own ? static_cast<std::int32_t>(pools.colors.size()) - 1 : 0);
    }
  }
};

}  // namespace

void ReadStl(MeshFiles& files, MeshImport& import) {
  try {
    const std::string text = files.Read(files.mesh()).value_or("");
    const std::size_t count =
        text.size() < kFirst ? 0 : static_cast<std::size_t>(NumberAt<std::uint32_t>(&text[kHeader]));
    const bool is_whole = text.size() >= kFirst + kFacet * count;
    const std::string head = Lower(text.substr(0, 1000));
    const std::size_t first = head.find_first_not_of("\xef\xbb\xbf \t\r\n");
    const bool is_text = head.find("solid") == first && head.find('\0') == std::string::npos &&
                         (head.find("facet") != std::string::npos || head.find("endsolid") != std::string::npos);
    StlFile stl;
    if (!is_text && !is_whole) throw std::runtime_error("the file ends too early, or is not STL");
    is_text ? stl.ReadText(text) : stl.ReadBinary(text, count);
    Box used;
    for (const auto& [name, polygons] : stl.solids) used.Add(polygons, stl.pools);
    import.origin = OriginFor(used);
    import.scene.materials.emplace_back();
    for (const auto& [name, polygons] : stl.solids) {
      ImportedMesh& mesh = import.scene.meshes.emplace_back();
      mesh.name = name;
      AppendPolygons(polygons, stl.pools, import.origin, mesh);
    }
    import.scene.nodes.push_back(NodeOfAll(import.scene.meshes));
  } catch (const std::runtime_error& error) {
    import.problem = std::string("cannot be read: ") + error.what();
  }
}

}  // namespace sim
