#include "sim/scenario/world_reader.h"

#include <glm/geometric.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "sim/scenario/motion_reader.h"
#include "sim/scenario/pose_reader.h"

namespace sim {
namespace {

using settings::Range;
using settings::Section;
using settings::Unit;

const Range kNotNegative = Range::AtLeast(0);

// Of a light: none of the three may be negative.
void ReadColor(Section& section, const std::string& key, glm::dvec3& color) {
  if (ReadVector(section, key, color) && (color.x < 0 || color.y < 0 || color.z < 0)) {
    section.Reject(key, "'" + key + "': light is not negative");
  }
}

enum class LightKind { ambient, sun, point, rectangle, sky };

void ReadFlicker(Section section, Flicker& flicker) {
  section.Read("frequency", flicker.frequency_hz, Unit::frequency, kNotNegative);
  section.Read("depth", flicker.depth, Range{0, 1});
  double phase_rad = 2 * std::numbers::pi * flicker.phase;
  section.Read("phase", phase_rad, Unit::angle);
  flicker.phase = phase_rad / (2 * std::numbers::pi);
  if (flicker.depth > 0 && flicker.frequency_hz == 0)
    section.Reject("frequency", "a lamp that flickers needs a frequency above 0");
}

// Three ways to say what the sky is: one radiance, three that are blended, or a picture.
SkyDescription ReadSky(Section& section, const std::filesystem::path& folder) {
  SkyDescription sky;
  for (const char* key : {"radiance", "zenith", "horizon", "ground", "file", "strength", "turn"}) section.Allow(key);
  const bool blended = section.Has("zenith") || section.Has("horizon") || section.Has("ground");
  if (section.Has("file") + section.Has("radiance") + blended != 1) {
    section.Reject("type", "a sky has either 'radiance', or 'zenith', 'horizon' and 'ground', or a 'file'");
  }
  if (section.Has("file")) {
    sky.file = ReadFile(section, "file", folder);
    section.Read("strength", sky.strength, kNotNegative);
    double turn_rad = 0;
    section.Read("turn", turn_rad, Unit::angle);
    sky.turn = turn_rad / (2 * std::numbers::pi);
    return sky;
  }
  for (const char* key : {"strength", "turn"}) {
    if (section.Has(key)) section.Reject(key, std::string("'") + key + "': only a sky from a file has it");
  }
  if (section.Has("radiance")) {
    ReadColor(section, "radiance", sky.zenith);
    sky.horizon = sky.ground = sky.zenith;
    return sky;
  }
  ReadColor(section, "zenith", sky.zenith);
  ReadColor(section, "horizon", sky.horizon);
  sky.ground = sky.horizon;
  ReadColor(section, "ground", sky.ground);
  return sky;
}

Light ReadLight(Section& section, LightKind kind) {
  using Kind = LightKind;
  if (kind == Kind::sun) {
    SunLight light;
    if (ReadVector(section, "direction", light.direction) && glm::length(light.direction) == 0) {
      section.Reject("direction", "'direction' has no length");
    }
    ReadColor(section, "irradiance", light.irradiance);
    return light;
  }
  if (kind == Kind::point) {
    PointLight light;
    ReadVector(section, "position", light.position, Unit::length);
    ReadColor(section, "intensity", light.intensity);
    ReadFlicker(section.Child("flicker"), light.flicker);
    return light;
  }
  if (kind == Kind::rectangle) {
    RectLight light;
    ReadVector(section, "corner", light.corner, Unit::length);
    ReadVector(section, "side_u", light.side_u, Unit::length);
    ReadVector(section, "side_v", light.side_v, Unit::length);
    if (glm::length(glm::cross(light.side_u, light.side_v)) == 0) section.Reject("side_u", "the rectangle has no area");
    ReadColor(section, "radiance", light.radiance);
    ReadFlicker(section.Child("flicker"), light.flicker);
    section.Read("visible", light.visible);
    return light;
  }
  AmbientLight light;
  ReadColor(section, "radiance", light.radiance);
  return light;
}

MeshDescription ReadMesh(Section& section, const std::filesystem::path& folder) {
  MeshDescription mesh;
  mesh.file = ReadFile(section, "file", folder);
  ReadVector(section, "position", mesh.position, Unit::length);
  ReadOrientation(section, "orientation", mesh.orientation);
  section.Read("scale", mesh.scale, Range{1e-9, 1e9});
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
  for (Section& mesh : section.List("meshes")) world.meshes.push_back(ReadMesh(mesh, folder));
  if (world.meshes.empty()) section.Reject("meshes", "'world.meshes': the world is empty");
  section.Allow("objects");
  if (section.Has("objects")) {  // a manifest of a world without any says nothing of them
    for (Section& object : section.List("objects")) {
      world.objects.push_back(ReadObject(object, folder, duration_s, world.objects));
    }
  }
  for (Section& light : section.List("lights")) {
    LightKind kind = LightKind::ambient;
    light.RequireChoice("type", kind,
                        {{"ambient", LightKind::ambient},
                         {"sun", LightKind::sun},
                         {"point", LightKind::point},
                         {"rectangle", LightKind::rectangle},
                         {"sky", LightKind::sky}});
    if (kind != LightKind::sky) {
      world.lights.push_back(ReadLight(light, kind));
      continue;
    }
    if (world.sky) light.Reject("type", "there is a sky already: a world has one at most");
    world.sky = ReadSky(light, folder);
  }
  ReadColor(section, "background", world.background);
}

}  // namespace sim
