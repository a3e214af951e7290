// Simulator: renders the frames of a scenario with exact truth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/motion/trajectory.h"
#include "sim/scenario/scenario.h"
#include "sim/sensor/camera.h"
#include "sim/sensor/exposure.h"
#include "sim/sensor/image.h"

namespace sim {

struct Labels;
class SurfaceTracer;
class Trajectory;

struct Frame {
  std::int64_t index = 0;
  std::int64_t stamp_ns = 0;  // mid-exposure
  ExposureSetting setting;
  Image image;
  Truth truth;
};

// Trajectory of the camera of a scenario, without a simulator: meshes are read only where it keeps clear of them.
// Throws as MakeTrajectory and LoadScene do.
std::unique_ptr<Trajectory> TrajectoryOf(const Scenario& scenario);

// Bounding box of the static world, in W [m]; number of triangles; textures in memory.
struct WorldExtent {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  std::size_t triangles = 0, texture_bytes = 0;
};

class Simulator {
 public:
  // Loads the world and the trajectory. At most `jobs` threads work in one call; their number never changes a result.
  // Throws SceneError, settings::Error or std::runtime_error naming the files at fault; std::invalid_argument for a
  // scenario whose values contradict each other (one from LoadScenario has been checked), for a camera that passes
  // through a surface (sim/motion/placement.h), and for jobs < 1.
  Simulator(const Scenario& scenario, int jobs);
  ~Simulator();
  Simulator(const Simulator&);  // the world is shared
  Simulator& operator=(const Simulator&);

  std::int64_t frame_count() const;
  const Camera& camera() const;
  const Scenario& scenario() const;
  // Of a rig, of which this is the first camera, a simulator for each: with its frames, stamps, truth and seed. Their
  // world is loaded and baked once.
  std::vector<Simulator> Cameras() const;
  std::size_t camera_index() const;
  // Properties of the world that are valid but probably unintended.
  const std::vector<std::string>& warnings() const;

  // Pure functions of the scenario, its seed and the index in [0, frame_count); std::out_of_range otherwise. They may
  // be called at the same time from several threads.
  Frame Render(std::int64_t index) const;
  std::int64_t StampNs(std::int64_t index) const;
  Truth TruthAt(std::int64_t index) const;
  View ViewAt(std::int64_t index) const;  // the camera's at the stamp
  ExposureSetting SettingOf(std::int64_t index) const;
  // Z in the camera frame [m] at each pixel's centre at the stamp, rows from the top; 0: nothing there.
  // By ray intersection, with either renderer.
  std::vector<float> Depth(std::int64_t index) const;

  // Camera trajectory, and the surface points of pixels. Both live as long as the simulator.
  const Trajectory& trajectory() const;
  std::shared_ptr<const Trajectory> body() const;  // of a rig; else the camera's
  const SurfaceTracer& surfaces() const;
  const WorldExtent& extent() const;
  // Of the world's meshes, as SurfaceTracer::MeshOf counts them; of an object's "OBJECT/MESH".
  const std::vector<std::string>& mesh_names() const;
  const Labels& labels() const;
  // Moving objects, and their state at a frame's stamp: frame O in place of C.
  const std::vector<std::string>& object_names() const;
  Truth ObjectTruthAt(std::size_t object, std::int64_t index) const;

  // Frames 0, 1, ... one after the other; none after the last.
  std::optional<Frame> Next();

 private:
  struct World;
  struct Parts;
  explicit Simulator(std::shared_ptr<const Parts> parts);

  std::shared_ptr<const Parts> parts_;
  std::int64_t next_ = 0;
};

}  // namespace sim
