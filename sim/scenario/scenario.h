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
  double duration_s = 0.0;
};

template <class V>
void Visit(V& v, TimeParams& p) {
  v("rate", p.rate_hz, {Unit::frequency, Range{0.01, 10000}, "frames per second"});
  v("duration", p.duration_s, {Unit::time, Range{0, 1e6}, "frames at k / rate; of a script: up to its last key"});
}

enum class Engine { ray_tracer, rasteriser };  // docs/renderers.md

struct RenderParams {
  Engine engine = Engine::ray_tracer;
  int rays_per_time_sample = 1;
  bool reflections = false;
  LightMode light = LightMode::direct;
  BakeParams bake;
  std::vector<std::filesystem::path> light_folders;  // where baked light is kept
};

template <class V>
void Visit(V& v, RenderParams& p) {
  v("engine", p.engine, {{"ray_tracer", Engine::ray_tracer}, {"rasteriser", Engine::rasteriser}}, "docs/renderers.md");
  v("rays_per_time_sample", p.rays_per_time_sample, {Range{1, 256}, "more: smoother edges at few time samples"});
  v("reflections", p.reflections, {"of metal and gloss"});
  v("light", p.light,
    {{"direct", LightMode::direct}, {"baked_indirect", LightMode::baked_indirect}, {"baked", LightMode::baked}},
    "lamps in each frame; and bounces, computed once; all computed once (docs/light.md)");
  v.Child("bake", p.bake);
}

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
