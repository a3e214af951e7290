#include "tools/bench/points/point_bound.h"

#include <cmath>
#include <stdexcept>
#include <variant>

#include "tools/bench/points/truth.h"

namespace vobench {
namespace {

const sim::SampledMotion& MotionOf(const sim::Scenario& scenario) {
  const auto* motion = std::get_if<sim::SampledMotion>(&scenario.motion);
  const auto refuse = [&](const char* why) {
    throw std::invalid_argument(scenario.name + ": no Cramer-Rao bound: " + why);
  };
  const sim::CameraParams& camera = scenario.camera;
  if (!scenario.points || scenario.points->landmarks != sim::Landmarks::prior) refuse("landmarks are not from a prior");
  if (scenario.points->scale_sigma > 0) refuse("the landmarks' scale is unknown");
  if (!motion) refuse("the motion is not sampled");
  if (motion->position_return > 0 || motion->orientation_return > 0) refuse("the motion has a return");
  if (std::abs(camera.fx / camera.fy - 1) > 0.01) refuse("pixels are not square");
  if (!(scenario.points->measurement.noise_px > 0)) refuse("views have no noise");
  return *motion;
}

}  // namespace

evaluation::PointWorldProblem ProblemOf(const sim::PointWorld& world, const std::vector<sim::PointFrame>& frames,
                                        const evaluation::Matrix12d& start) {
  const sim::Scenario& scenario = world.scenario();
  const sim::SampledMotion& motion = MotionOf(scenario);
  evaluation::PointWorldProblem problem;
  problem.sigma = problem.anchor_sigma =
      scenario.points->measurement.noise_px / std::sqrt(scenario.camera.fx * scenario.camera.fy);
  problem.position_noise = motion.position_noise;
  problem.orientation_noise = motion.orientation_noise;
  problem.start_covariance = start;
  for (const sim::PointLandmark& landmark : world.landmarks()) {
    const glm::dvec2 ray = world.camera().Undistort(world.Project(landmark, landmark.first_frame).value());
    problem.landmarks.push_back({static_cast<std::size_t>(landmark.first_frame),
                                 {ray.x, ray.y},
                                 landmark.X_W.w,
                                 scenario.points->inverse_depth_sigma,
                                 {}});
  }
  Truth truth;
  for (const sim::PointFrame& frame : frames) {
    Append(frame.stamp_ns, frame.truth, truth);
    for (const sim::PointObservation& seen : frame.observations) {
      evaluation::PointLandmark& landmark = problem.landmarks[static_cast<std::size_t>(seen.id)];
      const auto index = static_cast<std::size_t>(frame.index);
      if (landmark.anchor_frame < index) landmark.frames.push_back(index);
    }
  }
  problem.truth = truth.poses;
  return problem;
}

}  // namespace vobench
