// Where a path lies in a world: free places, surfaces that it passes through, places that it returns to.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/motion/surroundings.h"
#include "sim/motion/trajectory.h"

namespace sim {

std::string FormatPlace(const glm::dvec3& p);  // "(1.2, 0.8, -3) m"

// Where the first of some poses lies when all are moved rigidly to where they keep `clearance`: of 20 000 random places
// and headings the one, among the first 40 that are free and indoors, from which most is seen; enclosed, and with a
// surface within 2.5 m below the middle. That axis of the poses' own frame that is nearest to the cameras' mean upward
// direction becomes +y. Throws std::invalid_argument when none is free.
Pose FreePlaceOf(std::vector<Pose> poses, double clearance, const Surroundings& around, std::uint64_t seed);

// Throws std::invalid_argument naming time, place and mesh of the first surface that the path over [0, end_s] passes
// through. Tested along chords between instants 1/240 s apart, or further apart in paths of more than an hour.
// Instants at which `blind` holds (a covered lens) are exempt.
void RequireFree(const Trajectory& path, double end_s, const Surroundings& around,
                 const std::function<bool(double t_s)>& blind = {});

// Loop closure: from t_s on the camera is within 0.5 m and 30 degrees of its pose at earlier_s, having been more than
// 1 m or 60 degrees away in between; tested every 0.5 s.
struct Revisit {
  double t_s = 0, earlier_s = 0;
};
std::vector<Revisit> Revisits(const Trajectory& path, double end_s);

}  // namespace sim
