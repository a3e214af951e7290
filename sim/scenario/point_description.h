// Parameters of a point world (docs/point_world.md).
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sim/sensor/camera.h"

namespace sim {

// Where the landmarks are.
enum class Landmarks {
  prior,  // each is drawn when it is first seen: a place in the image, and an inverse depth there
  room,   // on the walls, the floor and the ceiling of a box
  plane,  // on a square before the first camera, at right angles to its axis
  cloud,  // in a box
};

// How a landmark in view becomes an observation. The first view of a landmark is never missing and never an outlier: it
// is what defines the landmark.
struct PointMeasurement {
  double noise_px = 1.0;             // standard deviation per axis; no rounding to whole pixels
  double outlier_probability = 0.0;  // that a view is replaced by a place that has nothing to do with the landmark: ...
  double outlier_radius_px = 0.0;    // ... uniform in a disc about the true one; 0: uniform in the image
  double drop_probability = 0.0;     // that a view is missing
  // A point whose image moves by s px during the exposure is missing with probability x^4 / (1 + x^4), x = s / length.
  double blur_length_px = 0.0;  // half of the points that move so far are missing; 0: none for this reason
  double blur_exposure_s = 0.010;
};

struct PointDescription {
  Landmarks landmarks = Landmarks::prior;
  int count = 100;        // new landmarks are first seen until so many are in view, where there are so many
  int forget_after = 30;  // frames out of view until a landmark is dropped; seen later, it is another one
  // Landmarks::prior
  double inverse_depth = 0.25;        // mean of 1 / Z in the camera of the first view [1/m]
  double inverse_depth_sigma = 0.15;  // its standard deviation; what falls below 0 stays so [1/m]
  double scale_sigma = 0;             // of the log of a factor, drawn once, of all inverse depths: 0: there is none
  double margin_px = 5.0;             // of the image, within which no landmark is first seen
  // The others
  int points = 3000;                 // in the whole world
  double size_m = 5.0;               // side of the box or of the square
  double distance_m = 3.0;           // of the square from the first camera
  std::optional<glm::dvec3> center;  // of the box, in W [m]; without: where the camera starts
  double min_depth_m = 0.0;          // nearer points are not seen

  PointMeasurement measurement;
};

// Everything wrong with the values, one sentence each, beginning with the dotted key of a scenario's `world.points`;
// empty when all is well.
std::vector<std::string> Problems(const PointDescription& points, const CameraParams& camera);

}  // namespace sim
