// Path of a carried camera through a world: hand-held, or a drone's.
#pragma once

#include <cstdint>
#include <memory>

#include "sim/motion/description.h"
#include "sim/motion/surroundings.h"
#include "sim/motion/trajectory.h"

namespace sim {

// A spline (sim/motion/spline.h) through poses kCarrierStep_s apart:
//
//   p = p_0 + course + offset        q = R_y(yaw) q_0 R_x(pitch) R_z(roll), each the course's plus the offset
//
// with the offsets of sim/motion/carrier_motion.h and a course whose rates are normal numbers through a low-pass of
// second order.
// A course velocity u is scaled to speed * u sqrt((1 + e) / (e + |u|^2)), e the table's evenness, so that the whole
// path has the stated mean speed and turn rate. Near a surface the course's inward velocity is damped and the camera is
// pushed outwards, with a speed that grows with the cube of its depth within a margin of 1.5 s (drones: 2 s) at its
// speed. The gaze varies about the direction, among 27 ahead and to the sides, of the largest Surroundings::Interest
// times a random number, chosen anew every 2 s; or about `look_at`. Paths that still come too near are drawn again, at
// most 32 times.
//
// A vehicle moves level and along its own axis, with a speed and a curvature of low-passed noise, slower and turning
// away where the way ahead is short; it is not fitted to anything.
//
// Without surroundings (worlds of points, objects) the camera roams and looks freely. Throws std::invalid_argument
// naming place and time where the clearance cannot be kept, or when there is no free place to start.
std::unique_ptr<Trajectory> MakeRoaming(const RoamingMotion& motion, std::uint64_t seed, double end_s,
                                        const Surroundings* around);

// The path with a carrier's offsets from 0.7 Hz upwards: p + offset, q R_y R_x R_z. Speeds that `shake` leaves open are
// the path's own means.
std::unique_ptr<Trajectory> Shaken(const Trajectory& path, CarrierMotionParams shake, std::uint64_t seed, double end_s);

}  // namespace sim
