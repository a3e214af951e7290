// Parameters of a point world (docs/point_world.md).
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "sim/sensor/camera.h"
#include "tools/base/settings/fields.h"

namespace sim {

// Where the landmarks are.
enum class Landmarks {
  prior,  // each is drawn when it is first seen: a place in the image, and an inverse depth there
  room,   // on the walls, the floor and the ceiling of a box
  plane,  // on a square before the first camera, at right angles to its axis
  cloud,  // in a box
};

// Measurement model of a landmark in view. The first view, which defines the landmark, is never missing and never an
// outlier.
struct PointMeasurement {
  double noise_px = 1.0;
  double outlier_probability = 0.0, outlier_radius_px = 0.0;
  double drop_probability = 0.0;
  double blur_length_px = 0.0, blur_exposure_s = 0.010;
};

template <class V>
void Visit(V& v, PointMeasurement& p) {
  using settings::Range, settings::Unit;
  const Range not_negative = Range::AtLeast(0);
  v("noise", p.noise_px, {Unit::pixel, not_negative, "standard deviation per axis; no rounding to whole pixels"});
  v("drops", p.drop_probability, {Range{0, 1}, "probability that a view is missing"});
  v.Child("outliers", [&](auto& outliers) {
    outliers("probability", p.outlier_probability, {Range{0, 1}, "that a view is another place: uniform"});
    outliers("radius", p.outlier_radius_px,
             {Unit::pixel, not_negative, "in a disc about the true one; 0: in the image"});
  });
  v.Child("blur", [&](auto& blur) {
    blur("length", p.blur_length_px, {Unit::pixel, not_negative, "image motion that drops half of the views; 0: none"});
    blur("exposure", p.blur_exposure_s, {Unit::time, not_negative, "in this time"});
  });
}

struct PointDescription {
  Landmarks landmarks = Landmarks::prior;
  int count = 100;
  int forget_after = 30;
  // Landmarks::prior
  double inverse_depth = 0.25, inverse_depth_sigma = 0.15;  // [1/m]
  double scale_sigma = 0;
  double margin_px = 5.0;
  // The others
  int total = 3000;
  double size_m = 5.0;
  double distance_m = 3.0;
  std::optional<glm::dvec3> center;  // in W [m]
  double min_depth_m = 0.0;

  PointMeasurement measurement;
};

template <class V>
void Visit(V& v, PointDescription& p) {
  using enum Landmarks;
  using settings::Range, settings::Unit;
  const Range number{1, 1'000'000}, not_negative = Range::AtLeast(0);
  v("landmarks", p.landmarks, {{"prior", prior}, {"room", room}, {"plane", plane}, {"cloud", cloud}},
    "drawn at the first view; on the faces of a box; on a square across the first axis; in a box");
  v("count", p.count, {number, "landmarks in view: new ones are first seen up to it"});
  v("forget_after", p.forget_after, {Range::AtLeast(1), "frames out of view; seen later, it is another landmark"});
  if (p.landmarks == prior) {
    v("inverse_depth", p.inverse_depth, {"mean of 1 / Z in the camera of the first view [1/m]"});
    v("inverse_depth_sigma", p.inverse_depth_sigma, {not_negative, "its standard deviation; not cut off at 0"});
    v("scale_sigma", p.scale_sigma, {Range{0, 3}, "of the log of a factor, drawn once, of all inverse depths"});
    v("margin", p.margin_px, {Unit::pixel, not_negative, "of the image, where no landmark is first seen"});
  } else {
    v.Renamed("points", "total");
    v("total", p.total, {number, "landmarks in the whole world"});
    v("size", p.size_m, {Unit::length, Range::Positive(), "side of the box or square"});
    v("min_depth", p.min_depth_m, {Unit::length, not_negative, "nearer points are not seen"});
  }
  if (p.landmarks == plane)
    v("distance", p.distance_m, {Unit::length, Range::Positive(), "of the square from the first camera"});
  if (p.landmarks == room || p.landmarks == cloud)
    v("center", p.center, {Unit::length, Range{-1e6, 1e6}, "of the box, in W; none: where the camera starts"});
  v.Child("measurement", p.measurement);
}

// Ranges, and rules between several values and the camera; keys are those of a scenario's `world.points`.
std::vector<settings::FieldProblem> Problems(PointDescription points, const CameraParams& camera);

}  // namespace sim
