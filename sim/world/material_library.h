// Material libraries (MTL) of OBJ files, and what both have in common: statements, one a line. Private to sim/world.
#pragma once

#include <assimp/material.h>

#include <functional>
#include <glm/mat3x2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace sim {

// Calls with the first word, the rest without blanks about it, and the line's number; a line that ends in '\' goes on
// in the next. Empty lines and comments are left out, as is a byte-order mark.
void ForEachStatement(std::string_view text,
                      const std::function<void(std::string_view word, std::string_view rest, int line)>& call);
// The next word, which is taken off `rest`; empty: none.
std::string_view NextWord(std::string_view& rest);
// ".5", "+1", "1e-3", "nan" too.
std::optional<double> ToNumber(std::string_view text);

struct LibraryMap {
  std::string file;  // empty: none
  glm::dmat3x2 transform{1, 0, 0, 1, 0, 0};
  bool clamp = false, own_range = false;  // -clamp on; -mm that is not 0 1
};

struct LibraryMaterial {
  std::string name, folder{};  // of the library, relative to the mesh's
  glm::vec3 color{1.0f};
  std::optional<glm::vec3> emission{};  // none: 0, or 1 where it has a map
  double opacity = 1, roughness = 1, metallic = 0;
  LibraryMap color_map{}, opacity_map{}, emission_map{}, normal_map{};
};

void ReadMaterialLibrary(std::string_view text, const std::string& folder,
                         std::map<std::string, LibraryMaterial>& materials);

aiMaterial* ToAssimp(const LibraryMaterial& material);

}  // namespace sim
