// Trajectory of a frame that is fixed to a moving body: a camera of a rig.
#pragma once

#include <glm/geometric.hpp>
#include <memory>
#include <utility>

#include "sim/motion/trajectory.h"

namespace sim {

class Mounted : public Trajectory {
 public:
  // T_BC: maps points from the frame to the body, X_B = R(q) X_C + p.
  Mounted(std::shared_ptr<const Trajectory> body, const Pose& T_BC) : body_(std::move(body)), T_BC_(T_BC) {}

  Motion At(double t_s) const override {
    const Motion body = body_->At(t_s);
    const glm::dvec3 &r = T_BC_.p_WC, &w = body.w_WC_C;
    const glm::dquat &q_WB = body.pose.q_WC, q_CB = glm::conjugate(T_BC_.q_WC);
    return {{body.pose.p_WC + q_WB * r, q_WB * T_BC_.q_WC},
            body.v_WC + q_WB * glm::cross(w, r),
            q_CB * w,
            body.a_WC + q_WB * (glm::cross(body.alpha_WC_C, r) + glm::cross(w, glm::cross(w, r))),
            q_CB * body.alpha_WC_C};
  }

 private:
  std::shared_ptr<const Trajectory> body_;
  Pose T_BC_;
};

}  // namespace sim
