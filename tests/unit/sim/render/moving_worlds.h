// Worlds with moving objects, and the same worlds at rest.
#pragma once

#include <memory>

#include "tests/unit/sim/render/worlds.h"

namespace sim::test {

// Turns the meshes from `first` on into an object; their coordinates in W become those in O.
inline void MakeObject(Scene& scene, std::size_t first, std::shared_ptr<const Trajectory> motion) {
  const auto begin = scene.meshes.begin() + static_cast<std::ptrdiff_t>(first);
  scene.objects.push_back(
      {"object" + std::to_string(scene.objects.size()), {begin, scene.meshes.end()}, std::move(motion)});
  scene.meshes.erase(begin, scene.meshes.end());
}

// Static world of time t_s, with the objects' meshes at their poses.
inline Scene StoppedAt(Scene scene, double t_s) {
  for (const MovingObject& object : scene.objects) {
    const Pose pose = object.motion->At(t_s).pose;
    for (Mesh mesh : object.meshes) {
      for (glm::vec3& p : mesh.positions) p = glm::vec3(pose.q_WC * glm::dvec3(p) + pose.p_WC);
      for (glm::vec3& n : mesh.normals) n = glm::vec3(pose.q_WC * glm::dvec3(n));
      scene.meshes.push_back(std::move(mesh));
    }
  }
  scene.objects.clear();
  return scene;
}

// T_OC of a camera at rest and a moving object. Poses alone.
class SeenFrom : public Trajectory {
 public:
  SeenFrom(std::shared_ptr<const Trajectory> object, const Pose& camera)
      : object_(std::move(object)), camera_(camera) {}
  Motion At(double t_s) const override {
    const Pose object = object_->At(t_s).pose;
    const glm::dquat q_OW = glm::conjugate(object.q_WC);
    Motion motion;
    motion.pose = {q_OW * (camera_.p_WC - object.p_WC), q_OW * camera_.q_WC};
    return motion;
  }

 private:
  std::shared_ptr<const Trajectory> object_;
  Pose camera_;
};

// Constant velocities of the size of a hand-held object's.
inline std::shared_ptr<const Trajectory> Carried() {
  return std::make_shared<SteadyMotion>(Pose{{0.1, -0.05, 0.2}, glm::normalize(glm::dquat(0.98, 0.1, -0.15, 0.05))},
                                        glm::dvec3(0.8, 0.5, -0.3), glm::dvec3(0.9, -1.4, 1.1));
}

// BusyWorld's wall and lights, and a moving object in front of the wall: a smooth sphere with texture coordinates and a
// textured box with vertex colours.
inline Scene CarriedThings() {
  Scene scene = BusyWorld();
  const std::size_t first = 1;  // the ball
  scene.meshes[1].uvs.resize(scene.meshes[1].positions.size());
  for (std::size_t i = 0; i < scene.meshes[1].uvs.size(); ++i) {
    const glm::vec3& p = scene.meshes[1].positions[i];
    scene.meshes[1].uvs[i] = {0.3f * p.x + 0.1f * p.z, 0.3f * p.y};
  }
  AddBox(scene, {-0.7f, -0.5f, 2.4f}, {-0.2f, 0.1f, 2.9f}, 0);
  for (glm::vec3 color : {glm::vec3(1, 0.5f, 0.2f)}) scene.meshes.back().colors.assign(4, color);
  MakeObject(scene, first, Carried());
  return scene;
}

}  // namespace sim::test
