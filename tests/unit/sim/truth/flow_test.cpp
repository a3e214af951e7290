#include "sim/sequence/flow.h"

#include <gtest/gtest.h>

#include "sim/render/surface_tracer.h"
#include "tests/unit/sim/render/worlds.h"

namespace sim::test {
namespace {

struct Traced {
  Traced(const Scene& scene, const CameraParams& params, const Pose& pose)
      : camera(params), renderer(MakeRayTracer(scene)), surfaces(*renderer->surfaces()) {
    surfaces.Trace(camera, pose, points);
  }
  Camera camera;
  std::unique_ptr<Renderer> renderer;
  const SurfaceTracer& surfaces;
  std::vector<SurfacePoint> points;
};

TEST(Flow, OfAPlaneThroughADistortedLensByHand) {
  Scene scene;
  AddMaterial(scene, glm::vec3(1.0f));
  AddQuad(scene, {-16, -16, -1}, {32, 0, 16}, {0, 32, -8}, 0);  // z = 3 + x / 2 - y / 4
  const glm::dvec3 n(0.5, -0.25, -1.0), at(0, 0, 3);
  const Pose here = TiltedPose(), there{{0.3, -0.15, -0.1}, glm::normalize(glm::dquat(0.98, 0.06, -0.1, 0.03))};
  const Traced traced(scene, DistortedCamera(), here);
  const FlowImage flow = FlowBetween(traced.surfaces, traced.camera, traced.points, here, there);
  int seen = 0, hidden = 0;
  for (int v = 0; v < 90; ++v) {
    for (int u = 0; u < 120; ++u) {
      const auto i = static_cast<std::size_t>(v * 120 + u);
      const glm::dvec3 ray = RayInWorld(traced.camera, here, u, v);
      const glm::dvec3 X_W = here.p_WC + glm::dot(n, at - here.p_WC) / glm::dot(n, ray) * ray;
      const glm::dvec2 pixel = traced.camera.Project(glm::conjugate(there.q_WC) * (X_W - there.p_WC));
      // Error of the pixel's ray, 1e-6 px, and rounding to float.
      ASSERT_NEAR(flow.uv[2 * i], pixel.x - u, 3e-6) << u << ", " << v;
      ASSERT_NEAR(flow.uv[2 * i + 1], pixel.y - v, 3e-6) << u << ", " << v;
      const bool in_image = pixel.x >= -0.5 && pixel.y >= -0.5 && pixel.x <= 119.5 && pixel.y <= 89.5;
      ASSERT_EQ(flow.occluded[i], in_image ? 0 : 1) << u << ", " << v;
      ++(in_image ? seen : hidden);
    }
  }
  EXPECT_GT(seen, 1000);
  EXPECT_GT(hidden, 100);
}

// Occlusion by a square in front of a wall: a point of the wall is hidden when the ray to it crosses the square.
TEST(Flow, OcclusionBehindASquare) {
  Scene scene;
  AddMaterial(scene, glm::vec3(1.0f));
  AddQuad(scene, {-8, -8, 4}, {16, 0, 0}, {0, 16, 0}, 0);
  AddQuad(scene, {-0.5, -0.5, 2}, {1, 0, 0}, {0, 1, 0}, 0);
  const Pose here{}, there{{0.3, 0, 0}, {1, 0, 0, 0}};
  const Traced traced(scene, SmallCamera(), here);
  const FlowImage flow = FlowBetween(traced.surfaces, traced.camera, traced.points, here, there);
  int hidden = 0;
  for (std::size_t i = 0; i < traced.points.size(); ++i) {
    const glm::dvec3& X = traced.points[i].X_C;
    const bool square = traced.surfaces.MeshOf(traced.points[i].triangle) == 1;
    ASSERT_EQ(square, X.z < 3);
    const glm::dvec3 middle = 0.5 * (X + there.p_WC);  // of the ray to a point of the wall: in the square's plane
    const double edge = std::max(std::abs(middle.x), std::abs(middle.y)) - 0.5;
    if (!square && std::abs(edge) < 1e-6) continue;
    const double u = static_cast<double>(i % 83) + static_cast<double>(flow.uv[2 * i]);
    const bool behind = !square && edge < 0, in_image = u >= -0.5 && u <= 82.5;
    ASSERT_EQ(flow.occluded[i], behind || !in_image ? 1 : 0) << i;
    hidden += behind;
    ASSERT_NEAR(flow.uv[2 * i], -70 * 0.3 / X.z, 3e-6);
    ASSERT_NEAR(flow.uv[2 * i + 1], 0, 3e-6);
  }
  EXPECT_GT(hidden, 50);
}

TEST(Flow, UnknownWhereNothingIsOrWhatIsBehind) {
  Scene scene;
  AddMaterial(scene, glm::vec3(1.0f));
  AddQuad(scene, {-0.5, -0.5, 2}, {1, 0, 0}, {0, 1, 0}, 0);
  const Pose here{};
  const Traced traced(scene, SmallCamera(), here);
  for (const double z : {1.0, 3.0}) {
    const FlowImage flow = FlowBetween(traced.surfaces, traced.camera, traced.points, here, Pose{{0, 0, z}, here.q_WC});
    const std::size_t middle = 30 * 83 + 41;
    EXPECT_EQ(flow.uv[0], kUnknownFlow);
    EXPECT_EQ(flow.occluded[0], 1);
    EXPECT_EQ(flow.uv[2 * middle] > 1e9f, z > 2);
    EXPECT_EQ(flow.occluded[middle], z > 2 ? 1 : 0);
  }
}

// Points beyond the maximum of x (1 + k1 x^2): folded back into the image by the formula, but not in the image.
TEST(Flow, WhatTheLensFoldsBackIsNotInTheImage) {
  CameraParams params = SmallCamera();
  params.k1 = -0.15;
  const Camera camera(params);
  const glm::dvec3 inside(0.05, 0.1, 1), folded(2.5, 0.1, 1);
  EXPECT_TRUE(InImage(camera, inside, camera.Project(inside)));
  const glm::dvec2 pixel = camera.Project(folded);
  EXPECT_TRUE(pixel.x > 0 && pixel.x < 82 && pixel.y > 0 && pixel.y < 60);
  EXPECT_FALSE(InImage(camera, folded, pixel));
}

TEST(SurfaceTracer, PointsOfACorner) {
  Scene scene;
  AddMaterial(scene, glm::vec3(1.0f));
  AddBox(scene, {-2, -1, -3}, {2, 3, 4}, 0);
  const Pose pose = TiltedPose();
  const Traced traced(scene, DistortedCamera(), pose);
  std::vector<glm::dvec3> points_W;
  for (std::size_t i = 0; i < traced.points.size(); ++i) {
    const SurfacePoint& p = traced.points[i];
    ASSERT_NE(p.triangle, kNoTriangle);
    const glm::dvec3 X = pose.p_WC + pose.q_WC * p.X_C;
    points_W.push_back(X);
    // On the one of the six planes that has the normal.
    const glm::dvec3 n = glm::normalize(traced.surfaces.Normal(p.triangle));
    const double planes[3][2] = {{-2, 2}, {-1, 3}, {-3, 4}};
    int on = 0;
    for (int c = 0; c < 3; ++c) {
      for (const double plane : planes[c]) {
        if (std::abs(n[c]) > 0.5 && std::abs(X[c] - plane) < 1e-9) ++on;
      }
    }
    ASSERT_EQ(on, 1) << i;
    ASSERT_EQ(traced.surfaces.MeshOf(p.triangle), p.triangle / 2);
    ASSERT_EQ(p.depth, p.X_C.z);
    const glm::dvec2 pixel = traced.camera.Project(p.X_C);
    ASSERT_LT(glm::length(pixel - glm::dvec2(i % 120, i / 120)), 2e-6);
  }
  // A convex room: all points are visible from inside.
  std::vector<std::uint8_t> visible;
  traced.surfaces.Visible(Pose{{1.2, 2.1, -2.3}}, points_W, visible);
  for (std::size_t i = 0; i < visible.size(); ++i) ASSERT_EQ(visible[i], 1) << i;
  traced.surfaces.Visible(Pose{{1.2, 2.1, -3.5}}, points_W,
                          visible);  // from outside: the points of the near side alone
  for (std::size_t i = 0; i < visible.size(); ++i) ASSERT_EQ(visible[i], points_W[i].z < -2.999999 ? 1 : 0) << i;
}

}  // namespace
}  // namespace sim::test
