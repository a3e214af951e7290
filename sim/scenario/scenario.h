// Scenario: all parameters of a simulation, and the reader of its file (docs/scenario.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sim/light/params.h"
#include "sim/motion/description.h"
#include "sim/motion/imu.h"
#include "sim/sensor/camera.h"
#include "sim/sensor/description.h"
#include "sim/world/description.h"

namespace sim {

// Where the landmarks of a world without images are (docs/point_world.md).
enum class Landmarks {
  prior,  // each is drawn when it is first seen: a place in the image, and an inverse depth there
  room,   // on the walls, the floor and the ceiling of a box
  plane,  // on a square before the first camera, at right angles to its axis
  cloud,  // in a box
};

// Measurement model of a landmark in view. The first view, which defines the landmark, is never missing and never an
// outlier.
struct PointMeasurement {
  double noise_px = 1.0;
  double outlier_probability = 0.0, outlier_radius_px = 0.0;
  double drop_probability = 0.0;
  double blur_length_px = 0.0, blur_exposure_s = 0.010;
};

template <class V>
void Visit(V& v, PointMeasurement& p) {
  using settings::Range, settings::Unit;
  const Range not_negative = Range::AtLeast(0);
  v("noise", p.noise_px, {Unit::pixel, not_negative, "standard deviation per axis; no rounding to whole pixels"});
  v("drops", p.drop_probability, {Range{0, 1}, "probability that a view is missing"});
  v.Child("outliers", [&](auto& outliers) {
    outliers("probability", p.outlier_probability, {Range{0, 1}, "that a view is another place: uniform"});
    outliers("radius", p.outlier_radius_px,
             {Unit::pixel, not_negative, "in a disc about the true one; 0: in the image"});
  });
  v.Child("blur", [&](auto& blur) {
    blur("length", p.blur_length_px, {Unit::pixel, not_negative, "image motion that drops half of the views; 0: none"});
    blur("exposure", p.blur_exposure_s, {Unit::time, not_negative, "in this time"});
  });
}

struct PointDescription {
  Landmarks landmarks = Landmarks::prior;
  int count = 100;
  int forget_after = 30;
  // Landmarks::prior
  double inverse_depth = 0.25, inverse_depth_sigma = 0.15;  // [1/m]
  double scale_sigma = 0;
  double margin_px = 5.0;
  // The others
  int total = 3000;
  double size_m = 5.0;
  double distance_m = 3.0;
  std::optional<glm::dvec3> center;  // in W [m]
  double min_depth_m = 0.0;

  PointMeasurement measurement;
};

template <class V>
void Visit(V& v, PointDescription& p) {
  using enum Landmarks;
  using settings::Range, settings::Unit;
  const Range number{1, 1'000'000}, not_negative = Range::AtLeast(0);
  v("landmarks", p.landmarks, {{"prior", prior}, {"room", room}, {"plane", plane}, {"cloud", cloud}},
    "drawn at the first view; on the faces of a box; on a square across the first axis; in a box");
  v("count", p.count, {number, "landmarks in view: new ones are first seen up to it"});
  v("forget_after", p.forget_after, {Range::AtLeast(1), "frames out of view; seen later, it is another landmark"});
  if (p.landmarks == prior) {
    v("inverse_depth", p.inverse_depth, {"mean of 1 / Z in the camera of the first view [1/m]"});
    v("inverse_depth_sigma", p.inverse_depth_sigma, {not_negative, "its standard deviation; not cut off at 0"});
    v("scale_sigma", p.scale_sigma, {Range{0, 3}, "of the log of a factor, drawn once, of all inverse depths"});
    v("margin", p.margin_px, {Unit::pixel, not_negative, "of the image, where no landmark is first seen"});
  } else {
    v.Renamed("points", "total");
    v("total", p.total, {number, "landmarks in the whole world"});
    v("size", p.size_m, {Unit::length, Range::Positive(), "side of the box or square"});
    v("min_depth", p.min_depth_m, {Unit::length, not_negative, "nearer points are not seen"});
  }
  if (p.landmarks == plane)
    v("distance", p.distance_m, {Unit::length, Range::Positive(), "of the square from the first camera"});
  if (p.landmarks == room || p.landmarks == cloud)
    v("center", p.center, {Unit::length, Range{-1e6, 1e6}, "of the box, in W; none: where the camera starts"});
  v.Child("measurement", p.measurement);
}

// Ranges, and rules between several values and the camera; keys are those of a scenario's `world.points`.
std::vector<settings::FieldProblem> Problems(PointDescription points, const CameraParams& camera);

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

// Contents and exactness: docs/truth.md.
enum class TruthStream {
  depth,         // 16-bit PNG
  depth_exr,     // the same in float
  depth_kinect,  // 16-bit PNG, with a structured-light camera's noise: sim/sensor/depth_noise.h
  distance,
  normals,
  flow,           // to the next frame
  flow_backward,  // to the one before
  occlusion,      // what of each flow cannot be seen in the other frame
  surface_id,
  moving,  // which pixels see an object that moves
  instance,
  semantic,
  boxes,      // of each instance that is seen, in the picture and in space
  disparity,  // of the first two cameras of a rig, and what is hidden from the second
  landmarks,
  acceleration,
  imu
};

struct TruthParams {
  std::set<TruthStream> streams{TruthStream::depth};  // beside poses and velocities, which are always there
  int landmarks = 500;
  ImuParams imu;
};

template <class V>
void Visit(V& v, TruthParams& p) {
  using S = TruthStream;
  v("truth", p.streams,
    {{"depth", S::depth},
     {"depth_exr", S::depth_exr},
     {"depth_kinect", S::depth_kinect},
     {"distance", S::distance},
     {"normals", S::normals},
     {"flow", S::flow},
     {"flow_backward", S::flow_backward},
     {"occlusion", S::occlusion},
     {"surface_id", S::surface_id},
     {"moving", S::moving},
     {"instance", S::instance},
     {"semantic", S::semantic},
     {"boxes", S::boxes},
     {"disparity", S::disparity},
     {"landmarks", S::landmarks},
     {"acceleration", S::acceleration},
     {"imu", S::imu}},
    "streams beside poses and velocities: docs/truth.md");
  v.Child("landmarks", [&](auto& landmarks) {
    landmarks("count", p.landmarks, {Range{1, 100000}, "surface points that are tracked"});
  });
  v.Child("imu", p.imu);
}

// A camera of a rig. T_BC maps points from C to the rig's body B; frame k is at k / rate + trigger_offset.
struct RigCamera {
  std::string name;  // of its folder
  CameraParams camera;
  SensorParams sensor;
  Pose T_BC;
  double trigger_offset_s = 0;
};
// But for name, camera and sensor.
template <class V>
void Visit(V& v, RigCamera& p) {
  v("position", p.T_BC.p_WC, {Unit::length, Range{-1e6, 1e6}, "of C in the body B, whose path is the trajectory"});
  v("orientation", p.T_BC.q_WC, {"of C in B: x, y, z, w"});
  v("trigger_offset", p.trigger_offset_s, {Unit::time, Range{0, 100}, "of its stamps; less than 1 / rate"});
}

// Checks that the first two cameras are a rectified pair: equal pinholes side by side, along x, at the same times.
// Returns the violated condition, or nothing.
std::string RectifiedProblem(const std::vector<RigCamera>& cameras);

struct Scenario {
  std::string name;
  std::uint64_t seed = 1;
  WorldDescription world;                  // to be rendered: empty where there are points
  std::optional<PointDescription> points;  // landmarks without images
  CameraParams camera;                     // the first one of a rig
  SensorParams sensor;                     // the same
  std::vector<RigCamera> cameras;          // of a rig; empty: one camera, which is the body
  RenderParams render;
  TimeParams time;
  MotionDescription motion;
  TruthParams truth;
  std::vector<std::pair<std::string, std::string>> drawn;  // keys that the file gives as distributions, and the values
  std::string resolved;  // all settings of the above with defaults filled in, as JSON; LoadScenario reads it again
};

// The cameras of a rig, or the one.
std::vector<RigCamera> AllCameras(const Scenario& scenario);

// Overrides are (dotted key, YAML value), later ones win; "seed" is a key like any other. File names in a scenario are
// relative to the scenario's folder and are resolved here. The sections `odometry` and `prior` belong to other readers
// and are ignored. Throws settings::Error with all problems at once. Mesh, texture and trajectory files are not opened
// yet, but for glTF files where one of their cameras is named.
Scenario LoadScenario(const std::filesystem::path& path,
                      const std::vector<std::pair<std::string, std::string>>& overrides = {});

// Number of frames, round(duration * rate). Throws std::invalid_argument when that is no frame, or more than ten
// million.
std::int64_t CountFrames(const TimeParams& time);

// Time stamp of a frame: k / rate, rounded to a nanosecond. Throws std::out_of_range unless 0 <= index <
// CountFrames(time).
std::int64_t StampNs(std::int64_t index, const TimeParams& time);

// Truth is that of the rounded stamp, the one that is written.
inline double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace sim
