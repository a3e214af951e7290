// Linearised match with the landmark's Gaussian integrated out, for landmarks that are updated one by one.
// match_lanes.inc has the same formulas for eight matches at a time.
// Units:   the plane z = 1, as in landmark.h.
#pragma once

#include "vo/map/landmark.h"

namespace vo {

// One match linearised at a landmark `theta` (not at its mean), the landmark's Gaussian integrated out: with the pose
// moved by d,
//   z - h = e - J_pose d + noise of covariance S = J P J' + R, and the landmark's mode is mean + gain (e - J_pose d).
// Written out by rows (0: x, 1: y).
struct LinearisedMatch {
  void Set(const AnchorView& view, const Landmark& landmark, const Eigen::Vector3d& theta, const Match& match);

  bool in_front = false;               // the rest is valid only then
  double u = 0, v = 0, inverse_z = 0;  // projection, 1 / X_C,z
  double e0 = 0, e1 = 0;
  Eigen::Vector3d J0, J1;            // of the landmark
  Eigen::Vector3d P0, P1;            // columns of P J'
  double W00 = 0, W01 = 0, W11 = 0;  // S^-1
  double det_S = 1;
  Eigen::Vector3d gain0, gain1;  // columns of P J' S^-1
  double cost() const { return W00 * e0 * e0 + 2.0 * W01 * e0 * e1 + W11 * e1 * e1; }
};

[[gnu::always_inline]] inline void LinearisedMatch::Set(const AnchorView& view, const Landmark& landmark,
                                                        const Eigen::Vector3d& theta, const Match& match) {
  const Eigen::Matrix3d& M = view.R_CA;
  const Eigen::Vector3d& t = view.t_C;
  const Eigen::Vector3d X = M.col(0) * theta.x() + M.col(1) * theta.y() + M.col(2) + theta.z() * t;
  in_front = X.z() > kMinDepth;
  if (!in_front) return;
  inverse_z = 1.0 / X.z();
  u = X.x() * inverse_z;
  v = X.y() * inverse_z;
  const double u_iz = u * inverse_z, v_iz = v * inverse_z;
  J0 = {inverse_z * M(0, 0) - u_iz * M(2, 0), inverse_z * M(0, 1) - u_iz * M(2, 1), inverse_z * t.x() - u_iz * t.z()};
  J1 = {inverse_z * M(1, 0) - v_iz * M(2, 0), inverse_z * M(1, 1) - v_iz * M(2, 1), inverse_z * t.y() - v_iz * t.z()};
  const Eigen::Vector3d off = landmark.mean - theta;
  e0 = match.z.x() - u - J0.dot(off);
  e1 = match.z.y() - v - J1.dot(off);
  P0 = landmark.covariance * J0;
  P1 = landmark.covariance * J1;
  const double S00 = J0.dot(P0) + match.R(0, 0), S01 = J0.dot(P1) + match.R(0, 1),
               S11 = J1.dot(P1) + match.R(1, 1);  // (3)
  det_S = S00 * S11 - S01 * S01;
  const double scale = 1.0 / det_S;
  W00 = scale * S11;
  W01 = -scale * S01;
  W11 = scale * S00;
  gain0 = P0 * W00 + P1 * W01;
  gain1 = P0 * W01 + P1 * W11;
}

}  // namespace vo
