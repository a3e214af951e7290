#include "sim/sequence/flow.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace sim {

bool HasPixel(const Camera& camera, const glm::dvec3& X_C) {
  if (camera.params().lens == Lens::fisheye) return X_C.x != 0 || X_C.y != 0 || X_C.z > 0;
  return X_C.z > 0;
}

bool InImage(const Camera& camera, const glm::dvec3& X_C, const glm::dvec2& pixel) {
  if (!(HasPixel(camera, X_C) && pixel.x >= -0.5 && pixel.y >= -0.5 && pixel.x <= camera.width() - 0.5 &&
        pixel.y <= camera.height() - 0.5)) {
    return false;
  }
  const glm::dvec3 ray(camera.Ray(static_cast<float>(pixel.x), static_cast<float>(pixel.y)));
  const double tolerance = 0.5 / camera.params().fx;  // half a pixel; the table is within 0.003
  return glm::length(glm::normalize(ray) - glm::normalize(X_C)) < tolerance;
}

FlowImage FlowBetween(const SurfaceTracer& surfaces, const Camera& camera, std::span<const SurfacePoint> points,
                      const View& here, const View& there) {
  FlowImage flow{std::vector<float>(2 * points.size(), kUnknownFlow), std::vector<std::uint8_t>(points.size(), 1)};
  const glm::dquat q_CW = glm::conjugate(there.pose.q_WC);
  const std::vector<Pose> objects_here = surfaces.ObjectPoses(here.t_s),
                          objects_there = surfaces.ObjectPoses(there.t_s);
  const auto point_there = [&](const SurfacePoint& point) {  // in W
    const glm::dvec3 X_W = here.pose.p_WC + here.pose.q_WC * point.X_C;
    if (point.object == kWorld) return X_W;
    const auto object = static_cast<std::size_t>(point.object);
    const Pose &now = objects_here[object], &then = objects_there[object];
    return then.p_WC + then.q_WC * (glm::conjugate(now.q_WC) * (X_W - now.p_WC));
  };
  std::vector<glm::dvec3> in_image;
  std::vector<std::size_t> pixel_of;
  const auto width = static_cast<std::size_t>(camera.width());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].triangle == kNoTriangle) continue;
    const glm::dvec3 X_W = point_there(points[i]), X_C = q_CW * (X_W - there.pose.p_WC);
    if (!HasPixel(camera, X_C)) continue;
    const glm::dvec2 pixel = camera.Project(X_C);
    const std::size_t x = i % width, y = i / width;
    flow.uv[2 * i] = static_cast<float>(pixel.x - static_cast<double>(x));
    flow.uv[2 * i + 1] = static_cast<float>(pixel.y - static_cast<double>(y));
    if (!InImage(camera, X_C, pixel)) continue;
    in_image.push_back(X_W);
    pixel_of.push_back(i);
  }
  std::vector<std::uint8_t> visible;
  surfaces.Visible(there, in_image, visible);
  for (std::size_t k = 0; k < in_image.size(); ++k) flow.occluded[pixel_of[k]] = visible[k] ? 0 : 1;
  return flow;
}

}  // namespace sim
