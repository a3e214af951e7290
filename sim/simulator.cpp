#include "sim/simulator.h"

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <stdexcept>

#include "sim/light/cache.h"
#include "sim/motion/placement.h"
#include "sim/motion/trajectory.h"
#include "sim/random/random.h"
#include "sim/render/rasteriser.h"
#include "sim/render/ray_scene.h"
#include "sim/render/ray_tracer.h"
#include "sim/render/scene_surroundings.h"
#include "sim/render/surface_tracer.h"
#include "sim/sensor/processing.h"
#include "sim/sensor/sensor.h"
#include "sim/sensor/vignetting.h"
#include "sim/world/labels.h"
#include "sim/world/mesh_loader.h"
#include "sim/world/scene.h"
#include "tools/base/settings/quantity.h"

namespace sim {
namespace {

// Limited to the machine's threads: TBB warns on stderr beyond.
int Threads(int jobs) {
  if (jobs < 1) throw std::invalid_argument("simulator: jobs must be at least 1, not " + std::to_string(jobs));
  return std::min(jobs, tbb::info::default_concurrency());
}

const Scenario& WithImages(const Scenario& scenario) {
  if (!scenario.points) return scenario;
  throw std::invalid_argument(scenario.name + ": a world of points has no images; `vobench run` plays it");
}

double LongestExposure(const SensorParams& s) {
  return s.auto_exposure.on ? std::max(s.exposure_s, s.auto_exposure.longest_s) : s.exposure_s;
}

// Seed of an object's sampled motion: independent of other objects' noise and the camera's.
std::uint64_t ObjectSeed(std::uint64_t seed, std::size_t object) {
  return SeedOf(RandomWords(seed, Stream::object_motion, static_cast<std::uint32_t>(object), 0, 0));
}

// Warns of specular surfaces that are rendered without reflection.
void WarnOfGloss(const Scene& scene, const RenderParams& params, std::vector<std::string>& warnings) {
  const bool mirrors = params.reflections && params.engine == Engine::ray_tracer;
  WarningList list;
  for (const Material& m : scene.materials) {
    const std::string who = "material '" + m.name + "': ";
    glm::vec3 mean(1);  // roughness and metallic are its green and blue
    if (m.gloss_texture >= 0) {
      const Texture& texture = scene.textures[static_cast<std::size_t>(m.gloss_texture)];
      mean = texture.Texel(static_cast<int>(texture.levels().size()) - 1, 0, 0);
    }
    if (mirrors && m.lacks_gloss_map) list.Add(who, "roughness and metalness maps are read of glTF alone");
    if (mirrors || (m.metallic * mean.b < 0.5f && m.roughness * mean.g > 0.5f)) continue;
    list.Add(who, std::string(params.reflections ? "the rasteriser does not render reflections"
                                                 : "render.reflections is false") +
                      ": metal and gloss are Lambert surfaces of their base colour");
  }
  for (std::string& warning : list.Summed()) warnings.push_back(std::move(warning));
}

// A principal point at a quarter of the image or more from its middle is more often a size that was changed alone.
void WarnOfCentre(const CameraParams& c, std::vector<std::string>& warnings) {
  if (std::abs(c.cx - 0.5 * (c.width - 1)) < 0.25 * c.width && std::abs(c.cy - 0.5 * (c.height - 1)) < 0.25 * c.height)
    return;
  const auto text = [](double px) { return settings::FormatNumber(px); };
  warnings.push_back("camera: the principal point (" + text(c.cx) + ", " + text(c.cy) +
                     ") px is far from the middle (" + text(0.5 * (c.width - 1)) + ", " + text(0.5 * (c.height - 1)) +
                     ") px: camera.width and height crop; for another resolution scale fx, fy, cx and cy as well");
}

// `rays` are of this scene; the rasteriser leaves them.
std::unique_ptr<Renderer> MakeRenderer(const Scene& scene, const RenderParams& params, int jobs,
                                       std::unique_ptr<RayScene>& rays, std::vector<std::string>& warnings) {
  WarnOfGloss(scene, params, warnings);
  if (params.engine == Engine::rasteriser) {
    auto renderer = MakeRasteriser(scene, {.rays_per_time_sample = params.rays_per_time_sample}, &warnings);
    if (params.light != LightMode::direct)
      warnings.emplace_back(
          "rasteriser: there is no baked light: render.light is taken as direct, with ambient light for what bounces");
    return renderer;
  }
  tbb::task_arena(jobs).execute(
      [&] { AddLight(scene, params.light, params.bake, params.light_folders, *rays, warnings); });
  return MakeRayTracer(
      scene, std::move(rays),
      {.rays_per_time_sample = params.rays_per_time_sample, .jobs = jobs, .reflections = params.reflections});
}

// Of all cameras; and what an exposure reaches beyond a stamp.
double LastStamp(const Scenario& s) {
  double offset_s = 0;
  for (const RigCamera& camera : s.cameras) offset_s = std::max(offset_s, camera.trigger_offset_s);
  return Seconds(StampNs(CountFrames(s.time) - 1, s.time)) + offset_s;
}
double Reach(const Scenario& s) {
  double reach_s = 0;
  for (const auto& [name, camera, sensor, T_BC, offset_s] : AllCameras(s))
    reach_s = std::max(reach_s, 0.5 * (LongestExposure(sensor) + std::abs(sensor.readout_s)));
  return reach_s;
}

WorldExtent ExtentOf(const Scene& scene) {
  WorldExtent extent;
  for (const Mesh& mesh : scene.meshes) {
    extent.triangles += mesh.triangles.size();
    for (const glm::vec3& p : mesh.positions) {
      extent.low = glm::min(extent.low, glm::dvec3(p));
      extent.high = glm::max(extent.high, glm::dvec3(p));
    }
  }
  for (const Texture& texture : scene.textures)
    extent.texture_bytes += 4 * texture.texels().size() + texture.alpha().size();
  return extent;
}

// Trajectory that covers all frames.
std::unique_ptr<Trajectory> MakeMotion(const Scenario& s, const MotionDescription& motion, std::uint64_t seed,
                                       const Surroundings* around = nullptr) {
  return MakeTrajectory(motion, seed, LastStamp(s), Reach(s), around);
}

std::unique_ptr<Trajectory> MakeObjectMotion(const Scenario& s, std::size_t object) {
  const ObjectDescription& description = s.world.objects[object];
  try {
    return MakeMotion(s, description.motion, ObjectSeed(s.seed, object));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("object " + description.mesh.name + ": " + error.what());
  }
}

// Optical elements between the world and the sensor.
struct Optics {
  Optics(const CameraParams& params, const OpticsParams& optics) : camera(params), vignetting(optics, camera) {}
  Camera camera;
  Vignetting vignetting;
};

}  // namespace

std::unique_ptr<Trajectory> TrajectoryOf(const Scenario& s) {
  if (s.points || !NeedsSurroundings(s.motion)) return MakeMotion(s, s.motion, s.seed);
  Scene scene = LoadScene(s.world);
  scene.objects.clear();  // static geometry only
  return MakeMotion(s, s.motion, s.seed, SurroundingsOf(scene, RayScene(scene)).get());
}

// Common parts of a rig's cameras, made once.
struct Simulator::World {
  World(const Scenario& s, int jobs) : arena(Threads(jobs)) {
    Scene scene = arena.execute([&] { return LoadScene(s.world); });
    for (std::size_t k = 0; k < scene.objects.size(); ++k) {
      scene.objects[k].motion = MakeObjectMotion(s, k);
      object_motions.push_back(scene.objects[k].motion);
      object_names.push_back(scene.objects[k].name);
    }
    warnings = scene.warnings;
    extent = ExtentOf(scene);
    auto rays = arena.execute([&] { return std::make_unique<RayScene>(scene); });
    const auto around = SurroundingsOf(scene, *rays);
    body = MakeMotion(s, s.motion, s.seed, around.get());
    for (const RigCamera& of : AllCameras(s)) {
      WarnOfCentre(of.camera, warnings);
      cameras.push_back(s.cameras.empty() ? body : Mounted(body, of.T_BC));
      RequireFree(*cameras.back(), LastStamp(s), *around, [&](double t_s) { return of.sensor.IsCovered(t_s); });
    }
    renderer = MakeRenderer(scene, s.render, Threads(jobs), rays, warnings);
    if (rays) exact = MakeRayTracer(scene, std::move(rays), {.jobs = Threads(jobs)});
    labels = LabelsOf(scene, s.world);
    for (const Mesh& mesh : scene.meshes) mesh_names.push_back(mesh.name);
    for (const Light& light : scene.lights) {
      const auto* rect = std::get_if<RectLight>(&light);
      if (rect != nullptr && rect->visible) mesh_names.push_back("lamp");
    }
    for (const MovingObject& object : scene.objects) {
      for (const Mesh& mesh : object.meshes) mesh_names.push_back(object.name + "/" + mesh.name);
    }
  }

  mutable tbb::task_arena arena;
  std::shared_ptr<const Trajectory> body;
  std::vector<std::shared_ptr<const Trajectory>> cameras;
  std::vector<std::string> warnings;
  WorldExtent extent;
  std::unique_ptr<Renderer> renderer;
  std::unique_ptr<Renderer> exact;  // for exact queries, where the renderer has none
  std::vector<std::string> mesh_names, object_names;
  Labels labels;
  std::vector<std::shared_ptr<const Trajectory>> object_motions;
};

// One camera.
struct Simulator::Parts {
  // The first camera has the scenario's seed, each other noise of its own.
  static Scenario Of(Scenario s, std::size_t k) {
    const RigCamera camera = AllCameras(s)[k];
    s.camera = camera.camera;
    s.sensor = camera.sensor;
    if (k > 0) s.seed = SeedOf(RandomWords(s.seed, Stream::rig_camera, static_cast<std::uint32_t>(k), 0, 0));
    return s;
  }

  Parts(const Scenario& s, std::shared_ptr<const World> in, std::size_t k)
      : scenario(Of(s, k)),
        index(k),
        frames(CountFrames(s.time)),
        offset_ns(std::llround(1e9 * AllCameras(s)[k].trigger_offset_s)),
        optics(scenario.camera, scenario.sensor.optics),
        sensor(scenario.sensor, scenario.seed, scenario.camera.width, scenario.camera.height),
        world(std::move(in)),
        trajectory(world->cameras[k]) {
    if (scenario.sensor.auto_exposure.on) Meter();
    for (std::size_t other = 1; k == 0 && other < s.cameras.size(); ++other)
      others.push_back(Simulator(std::make_shared<const Parts>(s, world, other)));
  }

  std::int64_t StampNs(std::int64_t frame) const { return sim::StampNs(frame, scenario.time) + offset_ns; }

  // The settings of all frames, each metered on the frame before it at 1/8 of the resolution, one ray per pixel.
  void Meter() {
    const Optics small(Binned(scenario.camera, 8), scenario.sensor.optics);
    AutoExposure control(scenario.sensor);
    RadianceImage picture;
    for (std::int64_t k = 0; k < frames; ++k) {
      settings.push_back(control.setting());
      Expose(small, MakeExposure(small, k), k, picture);
      control.Meter(picture);
    }
  }

  ExposureSetting Setting(std::int64_t frame) const {
    const SensorParams& s = scenario.sensor;
    return settings.empty() ? ExposureSetting{s.exposure_s, s.gain} : settings[static_cast<std::size_t>(frame)];
  }

  // Of one time sample, through a pinhole.
  Exposure MakeExposure(const Optics& to, std::int64_t frame) const {
    return {.middle_s = Seconds(StampNs(frame)),
            .exposure_s = Setting(frame).exposure_s,
            .row_delay_s = scenario.sensor.RowDelay(to.camera.height())};
  }

  // The light that an exposure collects on the sensor.
  void Expose(const Optics& to, const Exposure& exposure, std::int64_t frame, RadianceImage& radiance) const {
    if (scenario.sensor.IsCovered(exposure.middle_s)) {
      const int width = to.camera.width(), height = to.camera.height();
      const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
      radiance = {width, height, std::vector<float>(3 * pixels, 0.0F)};
      return;
    }
    world->renderer->Expose(to.camera, *trajectory, exposure, FrameKey(frame), radiance);
    to.vignetting.Apply(radiance);
  }

  std::uint64_t FrameKey(std::int64_t frame) const {
    return SeedOf(RandomWords(scenario.seed, Stream::ray_jitter, static_cast<std::uint32_t>(frame), 0, 0));
  }

  Scenario scenario;
  std::size_t index;  // in the rig
  std::int64_t frames;
  std::int64_t offset_ns;  // of its stamps
  Optics optics;
  Sensor sensor;
  std::shared_ptr<const World> world;
  std::shared_ptr<const Trajectory> trajectory;
  std::vector<ExposureSetting> settings;  // by frame; empty: always the scenario's
  std::vector<Simulator> others;          // of the first camera of a rig
};

Simulator::Simulator(const Scenario& scenario, int jobs)
    : parts_(std::make_shared<const Parts>(scenario, std::make_shared<const World>(WithImages(scenario), jobs), 0)) {}
Simulator::Simulator(std::shared_ptr<const Parts> parts) : parts_(std::move(parts)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(const Simulator&) = default;
Simulator& Simulator::operator=(const Simulator&) = default;

std::int64_t Simulator::frame_count() const { return parts_->frames; }
const Camera& Simulator::camera() const { return parts_->optics.camera; }
const Scenario& Simulator::scenario() const { return parts_->scenario; }
std::vector<Simulator> Simulator::Cameras() const {
  std::vector<Simulator> cameras{*this};
  cameras.insert(cameras.end(), parts_->others.begin(), parts_->others.end());
  return cameras;
}
std::size_t Simulator::camera_index() const { return parts_->index; }
const std::vector<std::string>& Simulator::warnings() const { return parts_->world->warnings; }
const Trajectory& Simulator::trajectory() const { return *parts_->trajectory; }
std::shared_ptr<const Trajectory> Simulator::body() const { return parts_->world->body; }
const SurfaceTracer& Simulator::surfaces() const {
  return *(parts_->world->exact ? parts_->world->exact : parts_->world->renderer)->surfaces();
}
const WorldExtent& Simulator::extent() const { return parts_->world->extent; }
const std::vector<std::string>& Simulator::mesh_names() const { return parts_->world->mesh_names; }
const Labels& Simulator::labels() const { return parts_->world->labels; }

std::int64_t Simulator::StampNs(std::int64_t index) const { return parts_->StampNs(index); }

Truth Simulator::TruthAt(std::int64_t index) const {
  return sim::TruthAt(*parts_->trajectory, Seconds(StampNs(index)));
}

View Simulator::ViewAt(std::int64_t index) const {
  const double t_s = Seconds(StampNs(index));
  return {parts_->trajectory->At(t_s).pose, t_s};
}

const std::vector<std::string>& Simulator::object_names() const { return parts_->world->object_names; }

Truth Simulator::ObjectTruthAt(std::size_t object, std::int64_t index) const {
  return sim::TruthAt(*parts_->world->object_motions.at(object), Seconds(StampNs(index)));
}

ExposureSetting Simulator::SettingOf(std::int64_t index) const {
  StampNs(index);  // throws for an invalid index
  return parts_->Setting(index);
}

Frame Simulator::Render(std::int64_t index) const {
  const Parts& parts = *parts_;
  Frame frame;
  frame.index = index;
  frame.stamp_ns = StampNs(index);
  frame.truth = TruthAt(index);
  frame.setting = parts.Setting(index);
  const SensorParams& sensor = parts.scenario.sensor;
  Exposure exposure = parts.MakeExposure(parts.optics, index);
  exposure.time_samples = sensor.time_samples;
  exposure.aperture_m = sensor.optics.aperture_m;
  exposure.focus_m = sensor.optics.focus_m;
  RadianceImage radiance;
  parts.Expose(parts.optics, exposure, index, radiance);
  if (const double sigma = sensor.optics.psf_sigma_px; sigma > 0)
    radiance.rgb = GaussianBlur(radiance.rgb, radiance.width, radiance.height, 3, sigma);
  parts.world->arena.execute([&] { frame.image = parts.sensor.Capture(radiance, index, frame.setting); });
  return frame;
}

std::vector<float> Simulator::Depth(std::int64_t index) const {
  return surfaces().Depth(parts_->optics.camera, ViewAt(index));
}

std::optional<Frame> Simulator::Next() {
  if (next_ >= frame_count()) return std::nullopt;
  return Render(next_++);
}

}  // namespace sim
