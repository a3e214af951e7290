#include "sim/world/fbx_text.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>

#include "tools/base/text.h"

namespace sim {
namespace {

template <class T>
std::optional<double> NumberAt(std::string_view bytes) {
  if (bytes.size() < sizeof(T)) return std::nullopt;
  T value{};
  std::memcpy(&value, bytes.data(), sizeof value);
  return static_cast<double>(value);
}

// Behind a property's name: three texts 'S' LENGTH BYTES, then the value, of the type that its letter states.
std::optional<double> BinaryValue(std::string_view rest) {
  for (int text = 0; text < 3; ++text) {
    const std::optional<double> length =
        rest.starts_with('S') ? NumberAt<std::uint32_t>(rest.substr(1)) : std::optional<double>();
    if (!length || *length > static_cast<double>(rest.size()) - 5) return std::nullopt;
    rest.remove_prefix(5 + static_cast<std::size_t>(*length));
  }
  const std::string_view value = rest.substr(std::min<std::size_t>(rest.size(), 1));
  return rest.starts_with('I')   ? NumberAt<std::int32_t>(value)
         : rest.starts_with('L') ? NumberAt<std::int64_t>(value)
         : rest.starts_with('D') ? NumberAt<double>(value)
         : rest.starts_with('F') ? NumberAt<float>(value)
                                 : std::nullopt;
}

// Behind a property's name, to the line's end: what follows the last comma.
std::optional<double> TextValue(std::string_view rest) {
  const std::string_view line = rest.substr(0, rest.find_first_of("\r\n"));
  const std::vector<base::Word> words = base::SplitWords(line.substr(line.rfind(',') + 1));
  return words.size() == 1 ? base::ParseNumber(words[0].text) : std::nullopt;
}

// Whether a property of this name has this value anywhere.
bool HasValue(std::string_view file, bool is_binary, std::string_view name, double value) {
  for (std::size_t at = file.find(name); at != std::string_view::npos; at = file.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    const bool is_name = is_binary
                             ? at >= 5 && file[at - 5] == 'S' &&
                                   NumberAt<std::uint32_t>(file.substr(at - 4)) == static_cast<double>(name.size())
                             : at >= 1 && file[at - 1] == '"' && file.substr(end).starts_with("\",");
    if (is_name && (is_binary ? BinaryValue(file.substr(end)) : TextValue(file.substr(end))) == value) return true;
  }
  return false;
}

}  // namespace

std::vector<std::string> FbxWarnings(std::string_view file) {
  const bool is_binary = file.starts_with("Kaydara FBX Binary");
  const auto has = [&](std::string_view name, double value) { return HasValue(file, is_binary, name, value); };
  std::vector<std::string> warnings;
  if (has("WrapModeU", 1) || has("WrapModeV", 1))
    warnings.push_back("a texture that ends at its edge (WrapMode 1) is not read as such: it repeats");
  if (has("Show", 0) || has("Visibility", 0)) warnings.push_back("hidden objects are drawn");
  if (file.find(is_binary ? std::string_view("S\x08\0\0\0LodGroup", 13) : "\"LodGroup\"") != std::string_view::npos)
    warnings.push_back("all levels of detail (LodGroup) are drawn");
  if (file.find(is_binary ? std::string_view("S\x0e\0\0\0LayeredTexture", 19) : "LayeredTexture:") !=
      std::string_view::npos)
    warnings.push_back("layered textures may be left out: bake them into one");
  for (const std::string_view name : {"LayerElementNormal", "LayerElementUV", "LayerElementColor"}) {
    bool of_faces = false;
    for (std::size_t at = file.find(name, 1); at != std::string_view::npos; at = file.find(name, at + 1)) {
      const bool is_node =
          is_binary ? file[at - 1] == static_cast<char>(name.size()) : file.substr(at + name.size()).starts_with(':');
      const std::size_t key = file.find("MappingInformationType", at);
      if (!is_node || key == std::string_view::npos) continue;
      const std::string_view mapping = file.substr(key, 45);
      of_faces = of_faces || mapping.find("AllSame") != std::string_view::npos ||
                 (mapping.find("ByPolygon") != std::string_view::npos &&
                  mapping.find("ByPolygonVertex") == std::string_view::npos);
    }
    if (of_faces) warnings.push_back("a " + std::string(name) + " of whole faces (ByPolygon, AllSame) is left out");
  }
  return warnings;
}

}  // namespace sim
