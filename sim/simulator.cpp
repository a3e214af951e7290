#include "sim/simulator.h"

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sim/motion/make.h"
#include "sim/random/random.h"
#include "sim/render/ray_tracer.h"
#include "sim/scenario/stamps.h"
#include "sim/sensor/exposure.h"
#include "sim/sensor/sensor.h"
#include "sim/world/scene.h"

namespace sim {
namespace {

// No more than the machine has: TBB would complain on stderr.
int Threads(int jobs) {
  if (jobs < 1) throw std::invalid_argument("simulator: jobs must be at least 1, not " + std::to_string(jobs));
  return std::min(jobs, tbb::info::default_concurrency());
}

const Scenario& WithImages(const Scenario& scenario) {
  if (!scenario.points) return scenario;
  throw std::invalid_argument(scenario.name + ": a world of points has no images");
}

}  // namespace

struct Simulator::Parts {
  Parts(const Scenario& s, int jobs)
      : scenario(WithImages(s)),
        frames(CountFrames(s.time)),
        camera(s.camera),
        sensor(s.sensor, s.seed),
        trajectory(
            MakeTrajectory(s.motion, s.seed, Seconds(sim::StampNs(frames - 1, s.time)), 0.5 * s.sensor.exposure_s)),
        arena(Threads(jobs)) {
    const Scene scene = LoadScene(s.world);
    warnings = scene.warnings;
    RayTracerOptions options;
    options.rays_per_time_sample = s.render.rays_per_time_sample;
    options.jobs = Threads(jobs);
    renderer = MakeRayTracer(scene, options);
  }

  Scenario scenario;
  std::int64_t frames;
  Camera camera;
  Sensor sensor;
  std::unique_ptr<Trajectory> trajectory;
  std::vector<std::string> warnings;
  std::unique_ptr<Renderer> renderer;
  mutable tbb::task_arena arena;
};

Simulator::Simulator(const Scenario& scenario, int jobs) : parts_(std::make_unique<const Parts>(scenario, jobs)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

std::int64_t Simulator::frame_count() const { return parts_->frames; }
const Camera& Simulator::camera() const { return parts_->camera; }
const Scenario& Simulator::scenario() const { return parts_->scenario; }
const std::vector<std::string>& Simulator::warnings() const { return parts_->warnings; }

std::int64_t Simulator::StampNs(std::int64_t index) const { return sim::StampNs(index, parts_->scenario.time); }

Truth Simulator::TruthAt(std::int64_t index) const {
  return sim::TruthAt(*parts_->trajectory, Seconds(StampNs(index)));
}

Frame Simulator::Render(std::int64_t index) const {
  const Parts& parts = *parts_;
  Frame frame{index, StampNs(index), {}, TruthAt(index)};
  const SensorParams& sensor = parts.scenario.sensor;
  std::vector<Pose> poses;
  for (const double t : ExposureTimes(Seconds(frame.stamp_ns), sensor.exposure_s, sensor.time_samples)) {
    poses.push_back(parts.trajectory->At(t).pose);
  }
  const Words words = RandomWords(parts.scenario.seed, Stream::ray_jitter, static_cast<std::uint32_t>(index), 0, 0);
  const std::uint64_t key = (std::uint64_t{words[0]} << 32) | words[1];
  RadianceImage radiance;
  parts.renderer->Expose(parts.camera, poses, key, radiance);
  parts.arena.execute([&] { frame.image = parts.sensor.Capture(radiance, index); });
  return frame;
}

std::vector<float> Simulator::Depth(std::int64_t index) const {
  std::vector<float> depth;
  parts_->renderer->Depth(parts_->camera, parts_->trajectory->At(Seconds(StampNs(index))).pose, depth);
  return depth;
}

std::optional<Frame> Simulator::Next() {
  if (next_ >= frame_count()) return std::nullopt;
  return Render(next_++);
}

}  // namespace sim
