#include "sim/simulator.h"

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>

#include "sim/motion/make.h"
#include "sim/random/random.h"
#include "sim/render/ray_tracer.h"
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

std::int64_t CountFrames(const TimeParams& time) {
  const double frames = std::round(time.rate_hz * time.duration_s);
  if (!(time.rate_hz > 0) || !(frames >= 1 && frames <= 1e7)) {
    throw std::invalid_argument("simulator: the scenario has no frame, or more than ten million");
  }
  return static_cast<std::int64_t>(frames);
}

std::int64_t Stamp(std::int64_t index, const TimeParams& time) {
  return std::llround(static_cast<double>(index) * 1e9 / time.rate_hz);
}

// Truth is that of the rounded stamp, the one that is written.
double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace

struct Simulator::Parts {
  Parts(const Scenario& s, int jobs)
      : scenario(s),
        frames(CountFrames(s.time)),
        camera(s.camera),
        sensor(s.sensor, s.seed),
        trajectory(MakeTrajectory(s.motion, s.seed, Seconds(Stamp(frames - 1, s.time)), 0.5 * s.sensor.exposure_s)),
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

std::int64_t Simulator::StampNs(std::int64_t index) const {
  if (index < 0 || index >= parts_->frames) {
    throw std::out_of_range("simulator: there is no frame " + std::to_string(index) + " of " +
                            std::to_string(parts_->frames));
  }
  return Stamp(index, parts_->scenario.time);
}

Truth Simulator::TruthAt(std::int64_t index) const {
  const Motion motion = parts_->trajectory->At(Seconds(StampNs(index)));
  const glm::dquat q = motion.pose.q_WC.w < 0 ? -motion.pose.q_WC : motion.pose.q_WC;
  const double size = glm::length(motion.pose.p_WC) + glm::length(motion.v_WC) + glm::length(motion.w_WC_C);
  if (!std::isfinite(size) || !(std::abs(glm::length(q) - 1) < 1e-9)) {
    throw std::logic_error("simulator: the truth of frame " + std::to_string(index) +
                           " is not finite or not a rotation");
  }
  return {motion.pose.p_WC, q, motion.v_WC, motion.w_WC_C};
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
