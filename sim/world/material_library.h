// Material libraries (MTL) of OBJ files, and the statement syntax common to both: one a line. Private to sim/world.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/world/imported_scene.h"

namespace sim {

// Calls with the first word, the rest without blanks about it, and the line's number; a line that ends in '\' continues
// in the next. Empty lines, comments (within a line: '#' between blanks) and a byte-order mark are skipped.
void ForEachStatement(std::string_view text,
                      const std::function<void(std::string_view word, std::string_view rest, int line)>& call);
// The next word, removed from `rest`; empty: none.
std::string_view NextWord(std::string_view& rest);
// ".5", "+1", "1e-3", "nan" too.
std::optional<double> ToNumber(std::string_view text);

// folder: of the library, relative to the mesh's. Returns the lines that are left out, as their values are no numbers.
std::vector<std::string> ReadMaterialLibrary(std::string_view text, const std::string& folder,
                                             std::map<std::string, ImportedMaterial>& materials);

}  // namespace sim
