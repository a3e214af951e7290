// Optical flow and occlusion in closed form, from the surface point that each pixel sees.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/motion/pose.h"
#include "sim/render/surface_tracer.h"
#include "sim/sensor/camera.h"

namespace sim {

// Unknown flow in the Middlebury format: above 1e9.
constexpr float kUnknownFlow = 1e10f;

struct FlowImage {
  std::vector<float> uv;               // two numbers a pixel [px], rows from the top; kUnknownFlow: nothing is seen,
                                       // or what is seen lies behind the other camera
  std::vector<std::uint8_t> occluded;  // 1: the other camera does not see the point: another surface is before it, it
                                       // is outside of the image or behind the camera, or there is no point
};

// From the frame whose pixels see `points` to another one: the point of the surface that is seen through a pixel's
// centre at the stamp here, projected at the stamp there, minus the pixel. In double; the file has floats.
//
// A point is X_W = T_WO(t) X_O, a place on an object times the object's pose at the stamp; of what stands still T_WO is
// the identity.
FlowImage FlowBetween(const SurfaceTracer& surfaces, const Camera& camera, std::span<const SurfacePoint> points,
                      const View& here, const View& there);

// Whether the lens projects the point anywhere: Z > 0; a fisheye, whatever is not straight behind it.
bool HasPixel(const Camera& camera, const glm::dvec3& X_C);

// Whether X_C is inside the camera's image; `pixel` is its projection. Outside its field of view a distorted lens may
// fold points back into the image: these are excluded.
bool InImage(const Camera& camera, const glm::dvec3& X_C, const glm::dvec2& pixel);

}  // namespace sim
