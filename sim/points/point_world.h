// Simulator of landmark observations without images: known data association, chosen noise, outliers and missed
// detections, exact truth. For tests of filters apart from image processing.
// Source: docs/point_world.md. Landmarks are homogeneous points, so that an inverse depth may vanish or be negative, as
//   under a Gaussian prior (Civera, Davison and Montiel 2008, "Inverse depth parametrization for monocular SLAM").
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/motion/trajectory.h"
#include "sim/scenario/scenario.h"
#include "sim/sensor/camera.h"

namespace sim {

// Centre of the first pixel = (0, 0), lens distortion included. With noise it may lie outside the image.
struct PointObservation {
  std::int64_t id = 0;
  double x_px = 0, y_px = 0;
};

struct PointFrame {
  std::int64_t index = 0;
  std::int64_t stamp_ns = 0;
  Truth truth;                                 // ground truth, for evaluation
  std::vector<PointObservation> observations;  // by increasing id
};

// A landmark. Ids count first views; a landmark that is dropped and seen again has a new id.
struct PointLandmark {
  std::int64_t id = 0;
  // (x, y, z, w) in W: the point (x, y, z) / w. w = 1 but where landmarks are drawn from a prior: there w is the
  // inverse depth in the first view, and is not always positive.
  glm::dvec4 X_W{0.0};
  std::int64_t first_frame = 0;
};

class PointWorld {
 public:
  // Throws what MakeTrajectory throws, and std::invalid_argument for a scenario without `world.points` or whose values
  // contradict each other (one from LoadScenario has been checked).
  explicit PointWorld(const Scenario& scenario);
  // The scenario of a file, with this seed. Throws settings::Error as well.
  PointWorld(const std::filesystem::path& scenario, std::uint64_t seed);

  std::int64_t frame_count() const { return frames_; }
  const Camera& camera() const { return camera_; }
  const Scenario& scenario() const { return scenario_; }
  // Settings that are possible but probably not meant.
  std::vector<std::string> Warnings() const;

  // Functions of the scenario, its seed and the index in [0, frame_count); std::out_of_range otherwise.
  std::int64_t StampNs(std::int64_t index) const;
  Truth TruthAt(std::int64_t index) const;

  // Frames 0, 1, ... one after the other; none after the last. A longer scenario begins with the same frames.
  std::optional<PointFrame> Next();

  // Every landmark seen so far, landmarks()[id].
  const std::vector<PointLandmark>& landmarks() const { return landmarks_; }
  // Image of the landmark in a frame's camera, without noise; nothing when it is out of view.
  std::optional<glm::dvec2> Project(const PointLandmark& landmark, std::int64_t frame) const;

 private:
  struct View {  // what the present camera sees of a landmark
    glm::dvec2 pixel{0.0};
    glm::dvec3 X_C{0.0};  // up to scale
  };
  struct Track {  // a landmark that is not forgotten
    std::int64_t id = 0;
    std::optional<std::size_t> point;  // in points_
    std::int64_t last_in_view = 0;
    std::optional<View> view;
  };
  struct CameraState {  // the present camera
    Truth truth;
    glm::dmat3 R_CW{1.0};
  };

  static CameraState CameraOf(const Truth& truth);
  std::optional<View> See(const CameraState& camera, const glm::dvec4& X_W) const;
  double MovedPx(const CameraState& camera, const PointLandmark& landmark, const View& view) const;
  void Follow(std::int64_t frame, const CameraState& camera);
  void Fill(std::int64_t frame, const CameraState& camera);
  glm::dvec4 DrawFromPrior(const CameraState& camera) const;
  void Begin(std::int64_t frame, const glm::dvec4& X_W, std::optional<std::size_t> point, const View& view);

  Scenario scenario_;
  PointDescription world_;
  std::uint64_t key_;
  double scale_ = 1;  // of all inverse depths drawn from the prior
  std::int64_t frames_;
  Camera camera_;
  std::shared_ptr<const Trajectory> trajectory_;
  std::vector<glm::dvec3> points_;  // none where landmarks are drawn from a prior
  std::vector<bool> followed_;      // per point
  std::vector<PointLandmark> landmarks_;
  std::vector<Track> tracks_;  // by increasing id
  std::int64_t next_ = 0;
};

}  // namespace sim
