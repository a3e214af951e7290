// Measurement model of a landmark: Gaussian noise, outliers, missed detections.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>

#include "sim/scenario/scenario.h"
#include "sim/sensor/camera.h"

namespace sim {

// x^4 / (1 + x^4) with x = moved_px / blur_length_px: 6 % at half the length, 50 % at it, 94 % at twice it. 0 where
// blur_length_px is 0.
double BlurLoss(const PointMeasurement& measurement, double moved_px);

// Key of a view: random numbers of different views are independent.
struct ViewKey {
  std::uint64_t key = 0;
  std::uint32_t frame = 0;
  std::uint32_t landmark = 0;
};

// `pixel`: where the landmark's image is. Nothing when the view is missing.
std::optional<glm::dvec2> Measure(const PointMeasurement& measurement, const CameraParams& camera, const ViewKey& view,
                                  const glm::dvec2& pixel, double moved_px);
// First view of a landmark, with noise only.
glm::dvec2 MeasureFirst(const PointMeasurement& measurement, const ViewKey& view, const glm::dvec2& pixel);

}  // namespace sim
