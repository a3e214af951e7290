// Landmark with inverse depth: a ray (x, y, 1) in the camera of its first view, its anchor, and rho.
// Source:  docs/algorithm.md, section 5. Projection X ~ R_CW (rho (p_A - p) + R_WA m), finite as rho -> 0; rho <= 0 is
//          legal.
// Units:   image points here are on the plane z = 1 of an undistorted camera [-]; rho is 1 / depth along z of the
//          anchor [1/m].
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "vo/base/params.h"
#include "vo/geometry/pose.h"

namespace vo {

struct Landmark {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();        // (x, y, rho)
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // with a fixed bearing only the last entry is not 0
};

// Row measurement of a rolling shutter, and its rotation-compensated form at the frame's stamp. The rotation between
// row and stamp needs no depth and is taken out exactly; the translation is left as an offset of the camera's centre.
// Velocity: (v in W, w in C); time in seconds.
struct RowView {
  Eigen::Vector2d z = Eigen::Vector2d::Zero();  // in the camera at the row's time
  double time = 0;                              // of the row, after the stamp; 0 without a rolling shutter

  // z in a camera with the orientation at the stamp and the centre at the row's time.
  struct Compensated {
    Eigen::Vector2d z;
    Eigen::Vector3d centre_offset_W;  // of that centre from the one at the stamp
  };
  Compensated RotationCompensated(const Vector6& velocity) const;
};

// Match of a landmark with a feature of the present image, on the plane z = 1, with covariance R.
// z and centre_offset_W follow from `row` by a velocity.
struct Match {
  int landmark = 0;
  Eigen::Vector2d z = Eigen::Vector2d::Zero();
  Eigen::Matrix2d R = Eigen::Matrix2d::Zero();
  Eigen::Vector3d centre_offset_W =
      Eigen::Vector3d::Zero();  // [m] of the centre that z is seen from, from the one at the stamp
  RowView row = {};
  // Covariance, per match, of the random walk of the patch's point about the landmark's ray.
  Eigen::Matrix2d wander = Eigen::Matrix2d::Zero();
  double inflation = 1;      // factor in R and wander that the landmark's residuals show
  bool provisional = false;  // updates the landmark and not the pose (Algorithm 1 and consensus)
};

// The anchor's camera A seen from the present camera C.
struct AnchorView {
  AnchorView(const Pose& camera, const Pose& anchor)
      : AnchorView(camera.q_WC.conjugate().toRotationMatrix(), camera.p_WC, anchor.q_WC.toRotationMatrix(),
                   anchor.p_WC) {}
  AnchorView(const Eigen::Matrix3d& from_world, const Eigen::Vector3d& camera_W, const Eigen::Matrix3d& R_WA,
             const Eigen::Vector3d& anchor_W)
      : R_CW(from_world), R_CA(from_world * R_WA), t_C(from_world * (anchor_W - camera_W)) {}
  // From a camera whose centre is off by `offset_W` [m].
  AnchorView ShiftedBy(const Eigen::Vector3d& offset_W) const {
    AnchorView view = *this;
    view.t_C -= R_CW * offset_W;
    return view;
  }
  Eigen::Matrix3d R_CW;
  Eigen::Matrix3d R_CA;
  Eigen::Vector3d t_C;  // [m]
};

inline std::vector<AnchorView> ViewsOf(std::span<const Pose> anchors, const Pose& camera) {
  std::vector<AnchorView> views;
  views.reserve(anchors.size());
  for (const Pose& anchor : anchors) views.emplace_back(camera, anchor);
  return views;
}

constexpr double kMinDepth = 1e-6;  // of X_C ~ rho-scaled points: what is nearer or behind is not in front

struct Projection {
  bool in_front = false;                        // X_C,z > 0; the rest is valid only then
  Eigen::Vector2d z = Eigen::Vector2d::Zero();  // on the plane z = 1
  Matrix26 J_pose = Matrix26::Zero();           // dz / d(dp in W, dphi in C)
  // dz / d(rho (p_A - p)) in W: J_pose is -rho times it; d2z / drho dp to first order.
  Matrix23 J_shift = Matrix23::Zero();
  Matrix23 J_landmark = Matrix23::Zero();  // dz / d(x, y, rho)
};

Projection Project(const AnchorView& view, const Eigen::Vector3d& landmark);

// X_C of a landmark, scaled by rho: its image is X.hnormalized() where X.z() > kMinDepth.
inline Eigen::Vector3d ScaledPoint(const Eigen::Matrix3d& R_CW, const Eigen::Vector3d& centre_W, const Pose& anchor,
                                   const Eigen::Vector3d& landmark) {
  return R_CW *
         (anchor.q_WC * Eigen::Vector3d(landmark.x(), landmark.y(), 1) + landmark.z() * (anchor.p_WC - centre_W));
}

// The match of a landmark at `theta` as seen from the camera's centre at the stamp; unchanged where it lies behind one
// of the two.
Match AtStamp(const Match& match, const AnchorView& view, const Eigen::Vector3d& theta);

// dz / d(dp in W, dphi in A) of the anchor's pose, for a landmark in front.
Matrix26 AnchorJacobian(const Projection& projection, const Eigen::Vector3d& landmark);

// Depth with a smaller uncertainty than the prior of LandmarkParams.
struct KnownDepth {
  double inverse_depth;  // [1/m]
  double sigma;          // [1/m]
};

// First view of a landmark on the plane z = 1: at ray + d_ray_d_rho rho, with covariance R.
struct FirstView {
  Eigen::Vector2d ray;
  Eigen::Matrix2d R;
  Eigen::Vector2d d_ray_d_rho =
      Eigen::Vector2d::Zero();  // not 0: the camera moved between the row's time and the stamp
  std::optional<KnownDepth> depth = std::nullopt;
  RowView row = {};  // ray and d_ray_d_rho follow from it by a velocity
};
// By a camera of this pose and velocity. R and the depth are left to the caller.
FirstView FirstSeen(const RowView& row, const Pose& pose, const Vector6& velocity);

Landmark NewLandmark(const FirstView& view, const LandmarkParams& params);

// In W; far away for a vanishing rho.
Eigen::Vector3d PointInWorld(const Pose& anchor, const Eigen::Vector3d& landmark);

// dX_W / d(x, y, rho) and dX_W / d(dp in W, dphi in A) of the anchor's pose. rho > 0 (a precondition).
Eigen::Matrix3d PointJacobian(const Pose& anchor, const Eigen::Vector3d& landmark);
Eigen::Matrix<double, 3, 6> PointAnchorJacobian(const Pose& anchor, const Eigen::Vector3d& landmark);

// Posterior of a landmark from a match at a known pose.
struct LandmarkUpdate {
  Landmark landmark;
  double log_likelihood = 0;  // log p(z | pose): (3) for the EKF, Laplace's approximation at the mode else
};

}  // namespace vo
