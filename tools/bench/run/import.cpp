#include "tools/bench/import/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "sim/world/mesh_import.h"
#include "sim/world/mesh_loader.h"
#include "sim/world/texture_file.h"
#include "tools/base/files.h"
#include "tools/bench/errors.h"
#include "tools/bench/run/commands.h"
#include "tools/bench/shapes.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/text.h"

namespace vobench {
namespace {

namespace fs = std::filesystem;

constexpr double kDuration_s = 6, kHeight = 480, kFocal = 525;

bool IsOneOf(const fs::path& file, const std::set<std::string>& extensions) {
  return extensions.contains(sim::LowerExtension(file));
}
bool IsDescription(const fs::path& file) { return IsOneOf(file, {".sdf", ".world", ".urdf"}); }
const std::set<std::string> kMeshes = {".gltf", ".glb", ".obj", ".ply", ".dae", ".fbx", ".stl", ".3ds", ".md3"};

const std::set<std::string> kInDouble = {".gltf", ".glb", ".obj", ".ply"};  // are read so

// Of a folder: what its model.config names, its one description, or all its mesh files.
ImportedWorld WorldOf(const ImportOptions& options, const fs::path& shapes) {
  std::vector<fs::path> files = {options.from};
  if (!fs::exists(options.from)) throw BadInput(options.from.string() + ": no such file");
  if (!fs::is_regular_file(options.from) && !fs::is_directory(options.from))
    throw BadInput(options.from.string() + ": neither a file nor a folder");
  const fs::path config = options.from.filename() == "model.config" ? options.from : options.from / "model.config";
  if (fs::is_regular_file(config)) {
    files = {ModelOf(config.parent_path())};
    if (!fs::is_regular_file(files[0])) throw BadInput(config.string() + ": names no file that is there");
  } else if (fs::is_directory(options.from)) {
    files.assign(fs::directory_iterator(options.from), fs::directory_iterator());
    std::erase_if(files, [](const fs::path& file) { return file.filename().string().starts_with("._"); });  // of macOS
    std::ranges::sort(files);
    const auto description = std::ranges::find_if(files, IsDescription);
    if (std::ranges::count_if(files, IsDescription) > 1)
      throw BadInput(options.from.string() + ": has several descriptions (.sdf, .world, .urdf): name one of them");
    if (description != files.end()) files = {fs::path(*description)};
  }
  if (files == std::vector{options.from} && !files[0].has_extension())
    throw BadInput(files[0].string() + ": has no extension, which says its kind: .sdf, .urdf, .obj, .ply, .glb, ...");
  if (files.size() == 1 && (IsDescription(files[0]) || IsOneOf(files[0], {".xml", ".erb"})))
    return Input([&] { return ReadSdf(files[0], options.models, shapes); });
  ImportedWorld result;
  glm::dvec3 origin(0.0);
  sim::WarningList warnings;
  for (const fs::path& file : files) {
    if (file != options.from && !IsOneOf(file, kMeshes)) continue;
    sim::MeshDescription& mesh = result.world.meshes.emplace_back();
    mesh.file = file;
    mesh.name = file.filename().string();
    mesh.category = file.stem().string();
    const glm::dvec3 own = IsOneOf(file, kInDouble) ? sim::ImportMesh(file, {}).origin : glm::dvec3(0);
    if (own == glm::dvec3(0)) continue;
    if (origin == glm::dvec3(0)) origin = own;  // of all, so that they stay together
    mesh.position = -origin;
    warnings.Add(file.string() + ": ",
                 "far from the origin, as in a survey: position " + ListText(mesh.position) + " moves it there");
  }
  result.warnings = warnings.Summed();
  if (result.world.meshes.empty())
    throw BadInput(options.from.string() + ": holds neither a description (.sdf, .world, .urdf) nor a mesh file");
  return result;
}

// Path relative to the scenario where it is below it.
std::string Named(const fs::path& file, const fs::path& scenario) {
  const fs::path whole = fs::weakly_canonical(fs::absolute(file)),
                 relative = whole.lexically_relative(fs::weakly_canonical(fs::absolute(scenario).parent_path()));
  return QuotedForYaml((relative.empty() || *relative.begin() == ".." ? whole : relative).string());
}

std::string ScenarioText(const ImportedWorld& from, const ImportOptions& options, const std::string& motion) {
  const sim::WorldDescription& world = from.world;
  std::string meshes, lights;
  for (const sim::MeshDescription& mesh : world.meshes) {
    const glm::dquat& q = mesh.orientation;
    meshes += fmt::format("    - {{file: {}, name: {}, class: {}", Named(mesh.file, options.output),
                          QuotedForYaml(mesh.name), QuotedForYaml(mesh.category));
    if (mesh.position != glm::dvec3(0)) meshes += ", position: " + ListText(mesh.position);
    if (q != glm::dquat(1, 0, 0, 0)) meshes += fmt::format(", orientation: [{}, {}, {}, {}]", q.x, q.y, q.z, q.w);
    if (mesh.stretch != glm::dvec3(1)) meshes += ", stretch: " + ListText(mesh.stretch);
    if (mesh.color) meshes += ", color: " + ListText(*mesh.color);
    if (!mesh.texture.empty()) meshes += ", texture: " + Named(mesh.texture, options.output);
    meshes += "}\n";
  }
  for (const std::string& light : from.lights) lights += "    - " + light + "\n";
  std::set<std::string> folders;
  for (const fs::path& folder : world.folders) folders.insert(Named(folder, options.output));
  return fmt::format(
      "# Made by `vobench import` from {}.\n"
      "world:\n  meshes:\n{}  texture_folders: [{}]\n  lights:\n{}  background: {}\n"
      "camera: {{width: 640, height: {}, fx: {}, fy: {}, cx: 319.5, cy: 239.5}}\n"
      "sensor: {{auto_exposure: {{on: true}}}}\n"
      "time: {{rate: 30 Hz, duration: {} s}}\n"
      "trajectory: {}\n",
      options.from.filename().string(), meshes, fmt::join(folders, ", "), lights, ListText(from.background), kHeight,
      kFocal, kFocal, kDuration_s, motion);
}

}  // namespace

std::string ListText(const glm::dvec3& v) {
  const glm::dvec3 rounded = 1e-9 * glm::round(1e9 * v) + 0.0;  // no -0
  return fmt::format("[{:.12g}, {:.12g}, {:.12g}]", rounded.x, rounded.y, rounded.z);
}

void Import(const ImportOptions& options) {
  const fs::path shapes = fs::path(options.output).replace_extension("").string() + "_shapes";
  for (const fs::path& made : {options.output, shapes}) {
    if (fs::exists(made)) throw BadInput(made.string() + ": is there already; remove it or choose another name");
  }
  ImportedWorld from = WorldOf(options, shapes);
  from.world.missing_textures = sim::MissingTextures::grey;  // missing ones are reported by the renderer
  try {
    for (const auto& [name, text] :
         {std::pair{"box.obj", kBox}, {"plane.obj", kPlane}, {"cylinder.obj", kCylinder}, {"sphere.obj", kSphere}})
      base::WriteFileAndFolders(shapes / name, text);
    const double fov_rad = 2 * std::atan(0.5 * kHeight / kFocal);
    const std::string motion = Input([&] { return FirstMotion(from, fov_rad, kDuration_s); });
    base::WriteFile(options.output, ScenarioText(from, options, motion));
  } catch (...) {
    fs::remove(options.output);
    fs::remove_all(shapes);
    throw;
  }
  const auto is_shape = [&](const sim::MeshDescription& mesh) { return mesh.file.parent_path() == shapes; };
  if (std::ranges::none_of(from.world.meshes, is_shape)) fs::remove_all(shapes);
  PrintWarnings(from.warnings);
  fmt::print("{}: {}, {}; `vobench check` says more, `vobench render` draws it\n", options.output.string(),
             Count(from.world.meshes.size(), "mesh file"), Count(from.lights.size(), "light"));
}

}  // namespace vobench
