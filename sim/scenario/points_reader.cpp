#include "sim/scenario/points_reader.h"

#include <string>

#include "sim/scenario/pose_reader.h"

namespace sim {
namespace {

using settings::Section;
using settings::Unit;

void Refuse(Section& section, const std::string& path, const std::string& key) {
  if (!section.Has(key)) return;
  section.Allow(key);
  section.Reject(key, "'" + path + key + "' is for worlds that are rendered: it goes with 'world.meshes', not with " +
                          "'world.points'");
}

void ReadMeasurement(Section section, PointMeasurement& measurement) {
  section.Read("noise", measurement.noise_px, Unit::pixel);
  section.Read("drops", measurement.drop_probability);
  Section outliers = section.Child("outliers");
  outliers.Read("probability", measurement.outlier_probability);
  outliers.Read("radius", measurement.outlier_radius_px, Unit::pixel);
  Section blur = section.Child("blur");
  blur.Read("length", measurement.blur_length_px, Unit::pixel);
  blur.Read("exposure", measurement.blur_exposure_s, Unit::time);
}

}  // namespace

PointDescription ReadPoints(Section& root, Section& world, const CameraParams& camera) {
  for (const char* key : {"meshes", "objects", "lights", "background"}) Refuse(world, "world.", key);
  for (const char* key : {"sensor", "render", "truth", "landmarks", "imu"}) Refuse(root, "", key);
  Section section = world.Child("points");
  PointDescription points;
  const bool known = section.RequireChoice("landmarks", points.landmarks,
                                           {{"prior", Landmarks::prior},
                                            {"room", Landmarks::room},
                                            {"plane", Landmarks::plane},
                                            {"cloud", Landmarks::cloud}});
  if (!known) {
    section.IgnoreRest();
    return points;
  }
  section.Read("count", points.count);
  section.Read("forget_after", points.forget_after);
  if (points.landmarks == Landmarks::prior) {
    section.Read("inverse_depth", points.inverse_depth);
    section.Read("inverse_depth_sigma", points.inverse_depth_sigma);
    section.Read("scale_sigma", points.scale_sigma);
    section.Read("margin", points.margin_px, Unit::pixel);
  } else {
    section.Read("points", points.points);
    section.Read("size", points.size_m, Unit::length);
    section.Read("min_depth", points.min_depth_m, Unit::length);
    if (points.landmarks == Landmarks::plane) {
      section.Read("distance", points.distance_m, Unit::length);
    } else {
      section.Allow("center");
      if (section.Has("center")) ReadVector(section, "center", points.center.emplace(0.0), Unit::length);
    }
  }
  ReadMeasurement(section.Child("measurement"), points.measurement);
  for (const std::string& problem : Problems(points, camera)) {
    section.Reject(problem.substr(0, problem.find(' ')), "points: " + problem);
  }
  return points;
}

}  // namespace sim
