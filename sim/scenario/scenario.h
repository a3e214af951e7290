// Scenario: all parameters of a simulation, and the reader of its file (docs/scenario.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/light/params.h"
#include "sim/motion/description.h"
#include "sim/scenario/point_description.h"
#include "sim/scenario/truth_streams.h"
#include "sim/sensor/camera.h"
#include "sim/sensor/description.h"
#include "sim/world/description.h"

namespace sim {

struct TimeParams {
  double rate_hz = 30.0;
  double duration_s = 0.0;  // frames are at k / rate, k = 0 ... round(duration * rate) - 1
};

enum class Engine { ray_tracer, rasteriser };  // docs/renderers.md

struct RenderParams {
  Engine engine = Engine::ray_tracer;
  int rays_per_time_sample = 1;  // more: smoother edges at few time samples
  bool reflections = false;      // of metal and gloss
  LightMode light = LightMode::direct;
  BakeParams bake;
  std::vector<std::filesystem::path> light_folders;  // where baked light is kept
};

struct Scenario {
  std::string name;
  std::uint64_t seed = 1;
  WorldDescription world;                  // to be rendered: empty where there are points
  std::optional<PointDescription> points;  // landmarks without images
  CameraParams camera;
  SensorParams sensor;
  RenderParams render;
  TimeParams time;
  MotionDescription motion;
  TruthParams truth;
  std::string resolved;  // all settings of the above with defaults filled in, as JSON; LoadScenario reads it again
};

// Overrides are (dotted key, YAML value), later ones win; "seed" is a key like any other. File names in a scenario are
// relative to the scenario's folder and are resolved here. The sections `odometry` and `prior` belong to other readers
// and are ignored. Throws settings::Error with all problems at once. Mesh, texture and trajectory files are not opened
// yet.
Scenario LoadScenario(const std::filesystem::path& path,
                      const std::vector<std::pair<std::string, std::string>>& overrides = {});

}  // namespace sim
