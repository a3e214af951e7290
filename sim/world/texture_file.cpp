#include "sim/world/texture_file.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>
#include <system_error>

#include "sim/world/mesh_import.h"

namespace sim {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPictures[] = {".tga", ".jpg", ".jpeg", ".png", ".bmp", ".webp", ".tif", ".tiff"};

std::string Plain(std::string text) {
  std::replace(text.begin(), text.end(), '\\', '/');
  for (const char* prefix : {"file:///", "file://"}) {
    if (text.starts_with(prefix)) text = text.substr(std::string(prefix).size() - (prefix[7] == '/' ? 1 : 0));
  }
  const std::size_t last = text.find_last_not_of(" \t\r\n");
  return text.substr(0, last == std::string::npos ? 0 : last + 1);
}

// The file, or one whose path differs in capitals only; of any kind: a picture of another format is accepted, as in
// Quake's engines.
std::optional<fs::path> Existing(const fs::path& file, bool of_any_kind = false) {
  std::error_code error;
  if (fs::exists(file, error)) return file;
  const std::string wanted = Lower(file.filename().string()), stem = Lower(file.stem().string());
  const std::optional<fs::path> folder = file.has_parent_path() ? Existing(file.parent_path()) : fs::path();
  if (!folder) return std::nullopt;
  for (fs::directory_iterator entry(folder->empty() ? "." : *folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path& found = entry->path();
    const std::string extension = LowerExtension(found);
    const bool is_picture = std::ranges::count(kPictures, extension) > 0;
    if (Lower(found.filename().string()) == wanted ||
        (of_any_kind && is_picture && Lower(found.stem().string()) == stem))
      return *folder / found.filename();
  }
  return std::nullopt;
}

}  // namespace

std::string Lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string LowerExtension(const fs::path& file) { return Lower(file.extension().string()); }

std::string DecodePercent(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto digit = [&](std::size_t at) {
      return at < text.size() && std::isxdigit(static_cast<unsigned char>(text[at]));
    };
    if (text[i] == '%' && digit(i + 1) && digit(i + 2)) {
      out += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

TextureFile FindTexture(const std::string& name, const fs::path& mesh, const std::string& folder,
                        const std::vector<fs::path>& folders) {
  std::vector<std::string> texts = {Plain(name)};
  if (const std::string decoded = DecodePercent(texts[0]); decoded != texts[0]) texts.push_back(decoded);
  std::vector<fs::path> bases = {mesh.parent_path() / folder, mesh.parent_path(),
                                 (mesh.parent_path() / "../materials/textures").lexically_normal()};  // Gazebo's layout
  bases.insert(bases.end(), folders.begin(), folders.end());
  bool is_outside = false;
  for (const std::string& text : texts) {
    const bool has_drive = text.size() > 1 && text[1] == ':';
    for (const fs::path& base : bases) {
      const auto found = has_drive ? std::nullopt : Existing((base / text).lexically_normal());
      if (found && IsAllowed(mesh, folders, *found)) return {*found, *found != (base / text).lexically_normal(), ""};
      is_outside = is_outside || found || has_drive || fs::path(text).is_absolute();
    }
  }
  for (const std::string& text : texts) {
    for (const fs::path& base : bases) {
      const auto found = Existing((base / fs::path(text).filename()).lexically_normal(), true);
      if (found && found->has_filename() && IsAllowed(mesh, folders, *found)) return {*found, true, ""};
    }
  }
  const fs::path file = (bases[0] / texts.back()).lexically_normal();
  if (is_outside) return {file, false, "must stay inside the folder of the mesh or of the scenario"};
  return {file, false, "no such file"};
}

}  // namespace sim
