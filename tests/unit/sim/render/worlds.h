// Small worlds and cameras with images in closed form.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "sim/light/cache.h"
#include "sim/motion/pose.h"
#include "sim/motion/so3.h"
#include "sim/motion/trajectory.h"
#include "sim/render/ray_tracer.h"
#include "sim/render/surface_tracer.h"
#include "sim/sensor/camera.h"
#include "sim/world/scene.h"

namespace sim::test {

inline CameraParams SmallCamera(int width = 83, int height = 61) {
  CameraParams params;
  params.width = width;
  params.height = height;
  params.fx = params.fy = 70.0;
  params.cx = (width - 1) / 2.0;
  params.cy = (height - 1) / 2.0;
  return params;
}

// Camera with strong distortion in all five terms.
inline CameraParams DistortedCamera() {
  CameraParams params = SmallCamera(120, 90);
  params.k1 = 0.12;
  params.k2 = -0.05;
  params.p1 = 0.006;
  params.p2 = -0.004;
  params.k3 = 0.01;
  return params;
}

inline int AddMaterial(Scene& scene, glm::vec3 base_color, glm::vec3 emission = glm::vec3(0.0f), int texture = -1) {
  scene.materials.push_back({"material", base_color, emission, texture});
  return static_cast<int>(scene.materials.size()) - 1;
}

// A parallelogram: corner, corner + a, corner + a + b, corner + b, with texture coordinates (0, 0), (1, 0), (1, 1), (0,
// 1).
inline void AddQuad(Scene& scene, glm::vec3 corner, glm::vec3 a, glm::vec3 b, int material, float repeats = 1.0f) {
  Mesh mesh;
  mesh.name = "quad";
  mesh.positions = {corner, corner + a, corner + a + b, corner + b};
  mesh.uvs = {{0, 0}, {repeats, 0}, {repeats, repeats}, {0, repeats}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.material = material;
  scene.meshes.push_back(mesh);
}

inline void AddBox(Scene& scene, glm::vec3 low, glm::vec3 high, int material) {
  const glm::vec3 x(high.x - low.x, 0, 0), y(0, high.y - low.y, 0), z(0, 0, high.z - low.z);
  AddQuad(scene, low, x, y, material);
  AddQuad(scene, low, y, z, material);
  AddQuad(scene, low, z, x, material);
  AddQuad(scene, high, -x, -y, material);
  AddQuad(scene, high, -y, -z, material);
  AddQuad(scene, high, -z, -x, material);
}

// A sphere of latitude and longitude with `rings` bands and the true normals.
inline void AddSphere(Scene& scene, glm::dvec3 center, double radius, int rings, int material) {
  Mesh mesh;
  mesh.name = "sphere";
  mesh.material = material;
  const int around = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int k = 0; k <= around; ++k) {
      const double polar = std::numbers::pi * i / rings, turn = 2 * std::numbers::pi * k / around;
      const glm::dvec3 n(std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn));
      mesh.positions.emplace_back(center + radius * n);
      mesh.normals.emplace_back(n);
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int k = 0; k < around; ++k) {
      const auto a = static_cast<std::uint32_t>(i * (around + 1) + k), b = a + static_cast<std::uint32_t>(around) + 1;
      if (i > 0) mesh.triangles.emplace_back(a, a + 1, b);
      if (i + 1 < rings) mesh.triangles.emplace_back(a + 1, b + 1, b);
    }
  }
  scene.meshes.push_back(mesh);
}

// Scene with texture, light and shadow in every part of the image.
inline Scene BusyWorld() {
  Scene scene;
  std::vector<std::uint8_t> rgb;
  for (int i = 0; i < 50 * 70 * 3; ++i) rgb.push_back(static_cast<std::uint8_t>((i * 2654435761u) >> 24));
  scene.textures.emplace_back("noise", 50, 70, rgb);
  AddMaterial(scene, {0.9f, 0.8f, 0.7f}, glm::vec3(0.0f), 0);
  AddMaterial(scene, {0.3f, 0.8f, 0.4f});
  AddQuad(scene, {-6, -6, 4}, {12, 0, 1}, {0, 12, 1}, 0, 3.0f);
  AddSphere(scene, {0.3, 0.1, 2.2}, 0.5, 20, 1);
  scene.lights = {AmbientLight{{0.1, 0.1, 0.1}}, PointLight{{1, -1, 0}, {9, 8, 7}}, SunLight{{1, 1, 2}, {1, 1, 1}},
                  RectLight{{-1, -1, 0}, {0.5, 0, 0}, {0, 0.5, 0}, {8, 8, 8}}};
  return scene;
}

// Irradiance at x from a polygon of radiance 1 (Lambert 1760): sum over its edges of angle * (normal of the edge's
// fan . n) / 2.
inline double PolygonIrradiance(const std::vector<glm::dvec3>& corners, glm::dvec3 x, glm::dvec3 n) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = glm::normalize(corners[i] - x), b = glm::normalize(corners[(i + 1) % corners.size()] - x);
    sum += std::acos(glm::dot(a, b)) * glm::dot(glm::normalize(glm::cross(a, b)), n);
  }
  return std::abs(sum) / 2;
}

// Pose aligned with no axis.
inline Pose TiltedPose() { return {{0.2, -0.1, -0.3}, glm::normalize(glm::dquat(0.97, 0.08, -0.12, 0.06))}; }

inline glm::dvec3 RayInWorld(const Camera& camera, const Pose& pose, double u, double v) {
  const glm::dvec2 ray = camera.Undistort({u, v});
  return pose.q_WC * glm::dvec3(ray, 1.0);
}

inline RayTracerOptions Centred(int jobs = 1) {
  RayTracerOptions options;
  options.jitter = false;
  options.jobs = jobs;
  return options;
}

// At `start` at time 0, with constant velocities.
class SteadyMotion : public Trajectory {
 public:
  explicit SteadyMotion(const Pose& start, const glm::dvec3& v_WC = {}, const glm::dvec3& w_WC_C = {})
      : start_(start), v_(v_WC), w_(w_WC_C) {}
  Motion At(double t_s) const override { return {{start_.p_WC + t_s * v_, start_.q_WC * Exp(t_s * w_)}, v_, w_}; }

 private:
  Pose start_;
  glm::dvec3 v_, w_;
};

inline std::unique_ptr<Renderer> MakeBaked(const Scene& scene, LightMode mode, const BakeParams& bake,
                                           const RayTracerOptions& options = Centred()) {
  std::vector<std::string> warnings;
  return MakeRayTracer(scene, LitScene(scene, mode, bake, {}, warnings), options);
}

// Peak signal-to-noise ratio [dB] for a peak of 1.
inline double Psnr(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (double{a[i]} - b[i]) * (double{a[i]} - b[i]);
  return -10 * std::log10(sum / static_cast<double>(a.size()));
}

inline RadianceImage Render(const Renderer& renderer, const Camera& camera, const Pose& pose) {
  RadianceImage image;
  renderer.Expose(camera, SteadyMotion(pose), Exposure{}, 1, image);
  return image;
}
inline RadianceImage Render(const Scene& scene, const Camera& camera, const Pose& pose,
                            const RayTracerOptions& options = Centred()) {
  return Render(*MakeRayTracer(scene, options), camera, pose);
}

// Z in C of the surface at each pixel's centre; 0: none.
inline std::vector<float> DepthOf(const Renderer& ray_tracer, const Camera& camera, const View& view) {
  std::vector<SurfacePoint> points;
  ray_tracer.surfaces()->Trace(camera, view, points);
  std::vector<float> depth;
  for (const SurfacePoint& point : points) depth.push_back(static_cast<float>(point.depth));
  return depth;
}

}  // namespace sim::test
