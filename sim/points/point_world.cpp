#include "sim/points/point_world.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <stdexcept>

#include "sim/points/point_measurement.h"
#include "sim/random/random.h"

namespace sim {
namespace {

// Key of this world's random numbers, distinct from those of a filter with the same seed and generator.
constexpr std::uint64_t kKey = 0x706f696e745f776full;

const PointDescription& PointsOf(const Scenario& scenario) {
  if (scenario.points) return *scenario.points;
  throw std::invalid_argument(scenario.name + ": the world has meshes, not points: it is rendered, not played");
}

bool InImage(const CameraParams& camera, const glm::dvec2& pixel) {
  return pixel.x >= -0.5 && pixel.x < camera.width - 0.5 && pixel.y >= -0.5 && pixel.y < camera.height - 0.5;
}

// Landmarks that are not drawn from a prior: uniform on the six faces of the box, on the square, or in the box; `start`
// is the first camera. Point k is a function of (key, k) alone: more points leave the first ones where they are.
std::vector<glm::dvec3> PlacePoints(const PointDescription& of, const Pose& start, std::uint64_t key) {
  std::vector<glm::dvec3> points;
  if (of.landmarks == Landmarks::prior) return points;
  const glm::dvec3 center = of.center.value_or(start.p_WC);
  for (int k = 0; k < of.total; ++k) {
    const Words words = RandomWords(key, Stream::point_place, 0, static_cast<std::uint32_t>(k), 0);
    glm::dvec3 in(Uniform(words[0]) - 0.5, Uniform(words[1]) - 0.5, Uniform(words[2]) - 0.5);
    if (of.landmarks == Landmarks::plane) {
      points.push_back(start.p_WC + start.q_WC * glm::dvec3(of.size_m * in.x, of.size_m * in.y, of.distance_m));
      continue;
    }
    if (of.landmarks == Landmarks::room) {
      double& across = in[static_cast<int>(words[3] % 3)];  // of the faces, all of the same area
      across = across < 0 ? -0.5 : 0.5;
    }
    points.push_back(center + of.size_m * in);
  }
  return points;
}

}  // namespace

PointWorld::PointWorld(const Scenario& scenario)
    : scenario_(scenario),
      world_(PointsOf(scenario)),
      key_(scenario.seed ^ kKey),
      frames_(CountFrames(scenario.time)),
      camera_(scenario.camera),
      trajectory_(MakeTrajectory(scenario.motion, key_, Seconds(sim::StampNs(frames_ - 1, scenario.time)), 0)) {
  ThrowIfAny(Problems(world_, scenario.camera), "point world");
  scale_ = std::exp(world_.scale_sigma * Normals(RandomWords(key_, Stream::point_scale, 0, 0, 0))[0]);
  const Truth start = TruthAt(0);
  points_ = PlacePoints(world_, {start.p_WC, start.q_WC}, key_);
  followed_.assign(points_.size(), false);
}

PointWorld::PointWorld(const std::filesystem::path& scenario, std::uint64_t seed)
    : PointWorld(LoadScenario(scenario, {{"seed", std::to_string(seed)}})) {}

std::int64_t PointWorld::StampNs(std::int64_t index) const { return sim::StampNs(index, scenario_.time); }
Truth PointWorld::TruthAt(std::int64_t index) const { return sim::TruthAt(*trajectory_, Seconds(StampNs(index))); }

std::vector<std::string> PointWorld::Warnings() const {
  if (world_.landmarks != Landmarks::room) return {};
  const glm::dvec3 center = world_.center.value_or(TruthAt(0).p_WC);
  for (std::int64_t k = 0; k < frames_; ++k) {
    const glm::dvec3 from = glm::abs(TruthAt(k).p_WC - center);
    if (std::max({from.x, from.y, from.z}) > world_.size_m / 2) {
      return {"the camera leaves the room of points at frame " + std::to_string(k)};
    }
  }
  return {};
}

PointWorld::CameraState PointWorld::CameraOf(const Truth& truth) {
  return {truth, glm::transpose(glm::mat3_cast(truth.q_WC))};
}

// X_C ~ R_CW (X_W - w p): for X_W = rho p_A + R_WA m, w = rho the anchored ray of an inverse-depth landmark.
std::optional<PointWorld::View> PointWorld::See(const CameraState& camera, const glm::dvec4& X_W) const {
  const glm::dvec3 X_C = camera.R_CW * (glm::dvec3(X_W) - X_W.w * camera.truth.p_WC);
  if (!(X_C.z > 0) || X_C.z < world_.min_depth_m * X_W.w) return std::nullopt;
  const View view{camera_.Project(X_C), X_C};
  if (!InImage(camera_.params(), view.pixel)) return std::nullopt;
  // Far outside the image a lens need not be one-to-one: points folded back into the image are not in view.
  const glm::dvec2 ray(X_C.x / X_C.z, X_C.y / X_C.z);
  if (glm::distance(camera_.Undistort(view.pixel), ray) > 1e-6 * (1 + glm::length(ray))) return std::nullopt;
  return view;
}

std::optional<glm::dvec2> PointWorld::Project(const PointLandmark& landmark, std::int64_t frame) const {
  const std::optional<View> view = See(CameraOf(TruthAt(frame)), landmark.X_W);
  return view ? std::optional(view->pixel) : std::nullopt;
}

// How far the image moves during the exposure: X_C' = -w_C x X_C - w v_C, half of it before and after.
double PointWorld::MovedPx(const CameraState& camera, const PointLandmark& landmark, const View& view) const {
  const double half_s = world_.measurement.blur_exposure_s / 2;
  const glm::dvec3 rate =
      -glm::cross(camera.truth.w_WC_C, view.X_C) - landmark.X_W.w * (camera.R_CW * camera.truth.v_WC);
  const glm::dvec3 before = view.X_C - half_s * rate, after = view.X_C + half_s * rate;
  if (!(before.z > 0) || !(after.z > 0)) return std::hypot(camera_.width(), camera_.height());  // it passes the camera
  return glm::distance(camera_.Project(before), camera_.Project(after));
}

void PointWorld::Follow(std::int64_t frame, const CameraState& camera) {
  for (Track& track : tracks_) {
    track.view = See(camera, landmarks_[static_cast<std::size_t>(track.id)].X_W);
    if (track.view) track.last_in_view = frame;
  }
  std::erase_if(tracks_, [&](const Track& track) {
    const bool forgotten = frame - track.last_in_view >= world_.forget_after;
    if (forgotten && track.point) followed_[*track.point] = false;
    return forgotten;
  });
}

// The place in the image is uniform, the inverse depth normal.
glm::dvec4 PointWorld::DrawFromPrior(const CameraState& camera) const {
  const auto id = static_cast<std::uint32_t>(landmarks_.size());
  const Words place = RandomWords(key_, Stream::point_place, 0, id, 0);
  const Words depth = RandomWords(key_, Stream::point_place, 0, id, 1);
  const double margin = world_.margin_px;
  const glm::dvec2 pixel(margin - 0.5 + Uniform(place[0], place[1]) * (camera_.width() - 2 * margin),
                         margin - 0.5 + Uniform(place[2], place[3]) * (camera_.height() - 2 * margin));
  const double rho = scale_ * (world_.inverse_depth + world_.inverse_depth_sigma * Normals(depth)[0]);
  const glm::dvec3 ray = glm::transpose(camera.R_CW) * glm::dvec3(camera_.Undistort(pixel), 1.0);
  return {rho * camera.truth.p_WC + ray, rho};
}

void PointWorld::Begin(std::int64_t frame, const glm::dvec4& X_W, std::optional<std::size_t> point, const View& view) {
  const auto id = static_cast<std::int64_t>(landmarks_.size());
  landmarks_.push_back({id, X_W, frame});
  tracks_.push_back({id, point, frame, view});
}

// New landmarks until `count` are in view, as far as there are any.
void PointWorld::Fill(std::int64_t frame, const CameraState& camera) {
  auto room = world_.count - std::count_if(tracks_.begin(), tracks_.end(), [](const Track& t) { return !!t.view; });
  if (world_.landmarks == Landmarks::prior) {
    for (; room > 0; --room) {
      const glm::dvec4 X_W = DrawFromPrior(camera);
      // z = 1 up to scale: it is in view whatever its inverse depth. min_depth does not apply to a prior.
      const glm::dvec3 X_C = camera.R_CW * (glm::dvec3(X_W) - X_W.w * camera.truth.p_WC);
      Begin(frame, X_W, std::nullopt, {camera_.Project(X_C), X_C});
    }
    return;
  }
  for (std::size_t k = 0; k < points_.size() && room > 0; ++k) {
    if (followed_[k]) continue;
    const glm::dvec4 X_W(points_[k], 1.0);
    const std::optional<View> view = See(camera, X_W);
    if (!view) continue;
    followed_[k] = true;
    Begin(frame, X_W, k, *view);
    --room;
  }
}

std::optional<PointFrame> PointWorld::Next() {
  if (next_ >= frames_) return std::nullopt;
  PointFrame frame{next_, StampNs(next_), TruthAt(next_), {}};
  ++next_;
  const CameraState camera = CameraOf(frame.truth);
  Follow(frame.index, camera);
  Fill(frame.index, camera);
  const PointMeasurement& how = world_.measurement;
  for (const Track& track : tracks_) {
    if (!track.view) continue;
    const PointLandmark& landmark = landmarks_[static_cast<std::size_t>(track.id)];
    const ViewKey key{key_, static_cast<std::uint32_t>(frame.index), static_cast<std::uint32_t>(track.id)};
    const std::optional<glm::dvec2> seen =
        landmark.first_frame == frame.index
            ? MeasureFirst(how, key, track.view->pixel)
            : Measure(how, camera_.params(), key, track.view->pixel, MovedPx(camera, landmark, *track.view));
    if (seen) frame.observations.push_back({track.id, seen->x, seen->y});
  }
  return frame;
}

}  // namespace sim
