// Triangles with clamped or mirrored textures, cut into pieces whose coordinates follow the wrap mode everywhere.
#include "sim/world/uv_wrap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

namespace sim {
namespace {

// Triangle in the plane z = 0, with texture coordinates equal to its positions.
Mesh RandomMesh(std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-2, 3);
  Mesh mesh;
  for (int i = 0; i < 3; ++i) {
    mesh.positions.emplace_back(uniform(random), uniform(random), 0);
    mesh.normals.emplace_back(0, 0, 1);
    mesh.uvs.emplace_back(mesh.positions.back());
    mesh.colors.emplace_back(mesh.positions.back());
  }
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

double Area(const Mesh& mesh) {
  double sum = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    sum += 0.5 *
           std::abs(glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]).z);
  }
  return sum;
}

double Expected(UvWrap wrap, double c, double edge) {
  if (wrap == UvWrap::mirror) {
    c = std::fmod(std::fmod(c, 2) + 2, 2);
    if (c > 1) c = 2 - c;
  }
  return wrap == UvWrap::repeat ? c : std::min(std::max(c, edge), 1 - edge);
}

TEST(UvWrap, PiecesFollowTheRule) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int n = 0; n < 300; ++n) {
    const UvWrap wrap_u = static_cast<UvWrap>(n % 3), wrap_v = static_cast<UvWrap>(n / 3 % 3);
    const Mesh before = RandomMesh(random);
    Mesh mesh = before;
    ASSERT_TRUE(WrapUvs(mesh, 0, wrap_u, 8));
    ASSERT_TRUE(WrapUvs(mesh, 1, wrap_v, 4));
    EXPECT_NEAR(Area(mesh), Area(before), 1e-5);
    for (const glm::uvec3& t : mesh.triangles) {
      const double a = uniform(random), b = uniform(random) * (1 - a), c = 1 - a - b;
      const auto mix = [&](const auto& values) {
        return a * glm::dvec3(values[t.x]) + b * glm::dvec3(values[t.y]) + c * glm::dvec3(values[t.z]);
      };
      const glm::dvec3 at = mix(mesh.positions);
      const glm::dvec2 uv =
          a * glm::dvec2(mesh.uvs[t.x]) + b * glm::dvec2(mesh.uvs[t.y]) + c * glm::dvec2(mesh.uvs[t.z]);
      EXPECT_NEAR(uv.x, Expected(wrap_u, at.x, 1.0 / 16), 2e-5) << n;
      EXPECT_NEAR(uv.y, Expected(wrap_v, at.y, 1.0 / 8), 2e-5) << n;
      EXPECT_NEAR(glm::length(mix(mesh.colors) - at), 0, 2e-5) << "the rest goes along";
    }
  }
}

TEST(UvWrap, LeavesWhatIsInside) {
  std::mt19937 random(4);
  Mesh mesh = RandomMesh(random);
  mesh.uvs = {{0.25f, 0.25f}, {0.75f, 0.25f}, {0.25f, 0.75f}};
  for (const UvWrap wrap : {UvWrap::clamp, UvWrap::mirror}) {
    ASSERT_TRUE(WrapUvs(mesh, 0, wrap, 8));
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.uvs[1], glm::vec2(0.75f, 0.25f));
  }
  mesh.uvs[1].x = 1000;
  EXPECT_FALSE(WrapUvs(mesh, 0, UvWrap::mirror, 8));
  EXPECT_TRUE(WrapUvs(mesh, 0, UvWrap::clamp, 8));
}

}  // namespace
}  // namespace sim
