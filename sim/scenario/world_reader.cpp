#include <glm/geometric.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "sim/scenario/readers.h"
#include "tools/base/settings/field_reader.h"

namespace sim {
namespace {

using settings::Section;

// One radiance, three that are blended, or a picture.
SkyDescription ReadSky(Section& section, const std::filesystem::path& folder) {
  SkyDescription sky;
  for (const char* key : {"radiance", "zenith", "horizon", "ground", "file", "strength", "turn"}) section.Allow(key);
  const bool blended = section.Has("zenith") || section.Has("horizon") || section.Has("ground");
  if (section.Has("file") + section.Has("radiance") + blended != 1) {
    section.Reject("type", "a sky has either 'radiance', or 'zenith', 'horizon' and 'ground', or a 'file'");
  }
  if (section.Has("file")) {
    sky.file = ReadFile(section, "file", folder);
    ReadFields(section, sky);
    return sky;
  }
  for (const char* key : {"strength", "turn"}) {
    if (section.Has(key)) section.Reject(key, std::string("'") + key + "': only a sky from a file has it");
  }
  if (section.Has("radiance")) {
    settings::FieldReader fields(section);
    fields("radiance", sky.zenith, {kOfLight, "from everywhere"});
    sky.horizon = sky.ground = sky.zenith;
  } else {
    ReadFields(section, sky);
  }
  return sky;
}

template <class L>
Light ReadLight(Section& section) {
  L light;
  ReadFields(section, light);
  if constexpr (std::is_same_v<L, SunLight>) {
    if (glm::length(light.direction) == 0) section.Reject("direction", "'direction' has no length");
  }
  if constexpr (std::is_same_v<L, RectLight>) {
    if (glm::length(glm::cross(light.side_u, light.side_v)) == 0) section.Reject("side_u", "the rectangle has no area");
  }
  if constexpr (requires { light.flicker; }) {
    if (light.flicker.depth > 0 && light.flicker.frequency_hz == 0)
      section.Child("flicker").Reject("frequency", "a lamp that flickers needs a frequency above 0");
  }
  return light;
}

MeshDescription ReadMesh(Section& section, const std::filesystem::path& folder) {
  MeshDescription mesh;
  mesh.file = ReadFile(section, "file", folder);
  ReadFields(section, mesh);
  return mesh;
}

// duration_s: of the scenario; an object's script must not end before.
ObjectDescription ReadObject(Section& section, const std::filesystem::path& folder, double duration_s,
                             const std::vector<ObjectDescription>& others) {
  ObjectDescription object;
  object.mesh = ReadMesh(section, folder);
  object.name = object.mesh.file.stem().string();
  const bool named = section.Read("name", object.name);
  const char* at = named ? "name" : "file";
  constexpr const char* kGood = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  if (object.name.find_first_not_of(kGood) != std::string::npos) {
    section.Reject(at,
                   "'name': an object's name is a file's too: letters, digits, '_' and '-', not '" + object.name + "'");
  }
  for (const ObjectDescription& other : others) {
    if (other.name != object.name || object.name.empty()) continue;
    section.Reject(at, "'name': another object is called '" + object.name + "' already");
  }
  Section trajectory = section.Child("trajectory");
  object.motion = ReadMotion(trajectory, folder);
  const auto* script = std::get_if<ScriptedMotion>(&object.motion);
  if (script != nullptr && !script->keys.empty() && script->keys.back().t_s < duration_s) {
    trajectory.Reject("keys", "'trajectory.keys': the last key pose is at " +
                                  settings::FormatNumber(script->keys.back().t_s) + " s, but the scenario lasts " +
                                  settings::FormatNumber(duration_s) + " s");
  }
  return object;
}

}  // namespace

void ReadWorld(Section section, const std::filesystem::path& folder, double duration_s, WorldDescription& world) {
  world.folders.push_back(folder);
  std::vector<std::string> texture_folders;
  if (section.Read("texture_folders", texture_folders))
    for (const std::string& each : texture_folders) world.folders.push_back(folder / each);
  for (Section& mesh : section.List("meshes")) world.meshes.push_back(ReadMesh(mesh, folder));
  if (world.meshes.empty()) section.Reject("meshes", "'world.meshes': the world is empty");
  section.Allow("objects");
  if (section.Has("objects")) {  // resolved only where given
    for (Section& object : section.List("objects")) {
      world.objects.push_back(ReadObject(object, folder, duration_s, world.objects));
    }
  }
  for (Section& light : section.List("lights")) {
    Light (*read)(Section&) = ReadLight<AmbientLight>;  // null: a sky
    light.RequireChoice("type", read,
                        {{"ambient", ReadLight<AmbientLight>},
                         {"sun", ReadLight<SunLight>},
                         {"point", ReadLight<PointLight>},
                         {"rectangle", ReadLight<RectLight>},
                         {"sky", nullptr}});
    if (read != nullptr) {
      world.lights.push_back(read(light));
      continue;
    }
    if (world.sky) light.Reject("type", "there is a sky already: a world has one at most");
    world.sky = ReadSky(light, folder);
  }
  ReadFields(section, world);
}

}  // namespace sim
