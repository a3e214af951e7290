#include "sim/scenario/points_reader.h"

#include <string>

#include "tools/base/settings/field_reader.h"

namespace sim {
namespace {

using settings::Section;

void Refuse(Section& section, const std::string& path, const std::string& key) {
  if (!section.Has(key)) return;
  section.Allow(key);
  section.Reject(key, "'" + path + key + "' is for worlds that are rendered: it goes with 'world.meshes', not with " +
                          "'world.points'");
}

}  // namespace

PointDescription ReadPoints(Section& root, Section& world, const CameraParams& camera) {
  for (const char* key : {"meshes", "objects", "lights", "background"}) Refuse(world, "world.", key);
  for (const char* key : {"sensor", "render", "truth", "landmarks", "imu"}) Refuse(root, "", key);
  Section section = world.Child("points");
  PointDescription points;
  const bool good = ReadFields(section, points);
  section.RequirePresent("landmarks");
  if (good && section.Has("landmarks")) {
    section.Reject(Problems(points, camera));
  } else {
    section.IgnoreRest();  // which keys there are depends on the kind of landmarks
  }
  return points;
}

}  // namespace sim
