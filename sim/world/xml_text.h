// XML files as assimp (5.2) understands them. Private to sim/world.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sim {

// Without blanks at the beginning of an element's text, which assimp takes for the end of its numbers, and with names
// of texture coordinates that are their set's place among those of the polygons: assimp numbers sets in that way, but
// takes the set's own number, or any digit of a name. A name that is bound to no set has the first one, with a warning.
// Textures name their image and its wrapping, whatever parameters lead there; morphs are their base; files of COLLADA
// 1.5 are such of 1.4.
std::string ColladaForAssimp(std::string_view text, std::vector<std::string>& warnings);

// With the first of several texts in quotes (URLs), with sets of faces and triangles whose corners share nothing,
// without lines, with known grouping nodes for others. What assimp leaves out or draws otherwise is a warning.
std::string X3dForAssimp(std::string_view text, std::vector<std::string>& warnings);

}  // namespace sim
