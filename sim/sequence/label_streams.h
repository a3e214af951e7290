// Truth streams of labels: instances, boxes, and their legend (docs/truth.md).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/render/surface_tracer.h"
#include "sim/simulator.h"
#include "sim/world/labels.h"

namespace sim {

// Of what each pixel sees: 1, 2, ...; 0: nothing. Throws std::runtime_error above 65535 instances.
std::vector<std::uint16_t> InstanceIds(const Simulator& simulator, const std::vector<SurfacePoint>& points);

// CSV, a line for each instance that a pixel sees: its outermost pixels, its number of pixels, its box in C.
std::string Boxes(const Simulator& simulator, const View& view, const std::vector<std::uint16_t>& ids);

// JSON: instances with name, class and entry in the scenario; classes.
std::string LabelsJson(const Labels& labels);

}  // namespace sim
