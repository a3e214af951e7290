#include <algorithm>
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
  mesh.place = section.Where("file");
  ReadFields(section, mesh);
  section.Allow("texture");
  if (section.Has("texture")) mesh.texture = ReadFile(section, "texture", folder);  // resolved only where given
  section.Allow("materials");
  if (section.Has("materials")) {  // resolved only where given
    for (Section& each : section.List("materials")) {
      MaterialDescription& material = mesh.materials.emplace_back();
      ReadFields(each, material);
      each.Read("name", material.name);
      each.Allow("texture");
      if (each.Has("texture")) material.texture = ReadFile(each, "texture", folder);
    }
  }
  mesh.category = mesh.file.stem().string();
  section.Allow("class");
  if (section.Has("class")) section.Read("class", mesh.category);  // resolved only where given
  return mesh;
}

// Adds the problem of a repeated name.
void RejectDoubled(Section& section, const char* at, const std::string& name, const std::vector<std::string>& others) {
  if (!name.empty() && std::ranges::count(others, name) > 0)
    section.Reject(at, "'name': another entry is called '" + name + "' already");
}

// `names`: those read before.
ObjectDescription ReadObject(Section& section, const std::filesystem::path& folder, std::vector<std::string>& names) {
  ObjectDescription object;
  object.mesh = ReadMesh(section, folder);
  std::string& name = object.mesh.name = object.mesh.file.stem().string();
  const char* at = section.Read("name", name) ? "name" : "file";
  if (!IsPlainName(name)) {
    section.Reject(at, "'name': an object's name is a file's too: letters, digits, '_' and '-', not '" + name + "'");
  }
  RejectDoubled(section, at, name, names);
  names.push_back(name);
  Section trajectory = section.Child("trajectory");
  object.motion = ReadMotion(trajectory, {folder});
  return object;
}

}  // namespace

bool IsPlainName(const std::string& name) {
  return name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
         std::string::npos;
}

void ReadWorld(Section section, const std::filesystem::path& folder, WorldDescription& world) {
  world.folders.push_back(folder);
  std::vector<std::string> texture_folders;
  if (section.Read("texture_folders", texture_folders))
    for (const std::string& each : texture_folders) world.folders.push_back(folder / each);
  std::vector<std::string> names;
  for (Section& mesh : section.List("meshes")) {
    MeshDescription& read = world.meshes.emplace_back(ReadMesh(mesh, folder));
    mesh.Allow("name");
    if (!mesh.Has("name")) continue;
    mesh.Read("name", read.name);  // resolved only where given
    RejectDoubled(mesh, "name", read.name, names);
    names.push_back(read.name);
  }
  if (world.meshes.empty()) section.Reject("meshes", "'world.meshes': the world is empty");
  section.Allow("objects");
  if (section.Has("objects")) {  // resolved only where given
    for (Section& object : section.List("objects")) {
      world.objects.push_back(ReadObject(object, folder, names));
    }
  }
  // A mesh without a name has its file's, with a number where another has that already.
  for (MeshDescription& mesh : world.meshes) {
    const std::string stem = mesh.file.stem().string();
    for (int number = 1; mesh.name.empty(); ++number) {
      const std::string name = number == 1 ? stem : stem + "_" + std::to_string(number);
      if (std::ranges::count(names, name) == 0) mesh.name = name;
    }
    names.push_back(mesh.name);
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
