#include "vo/filter/landmark_on_path.h"

#include <Eigen/LU>

#include "vo/geometry/symmetric.h"
#include "vo/map/point_moments.h"

namespace vo {
namespace {

struct Conditional {
  Eigen::Matrix3d P;
  Eigen::Matrix<double, 3, Eigen::Dynamic> D;
};

Conditional Condition(const WindowInput& in, const Track& track, const PathGaussian& path,
                      const Eigen::Vector3d& theta) {
  const Eigen::Matrix3d L = LandmarkRoot(in.landmarks[track.landmark].covariance);
  const Pose& anchor = AnchorOn(path, in, track);
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  Eigen::Matrix<double, 3, Eigen::Dynamic> E =
      Eigen::Matrix<double, 3, Eigen::Dynamic>::Zero(3, path.covariance.cols());
  for (const Track::View& view : track.views) {
    const Projection h = Project(AnchorView(path.mean[view.slot], anchor).ShiftedBy(view.centre_offset_W), theta);
    if (!h.in_front) continue;
    const Matrix23 M = h.J_landmark * L;
    const Eigen::Matrix<double, 3, 2> MtW = M.transpose() * view.R_inverse;
    G.noalias() += MtW * M;
    E.middleCols<6>(kPoseSize * view.slot).noalias() += MtW * h.J_pose;
    if (track.anchor_slot >= 0)
      E.middleCols<6>(kPoseSize * track.anchor_slot).noalias() += MtW * AnchorJacobian(h, theta);
  }
  const Eigen::Matrix3d LG = L * G.inverse();
  return {LG * L.transpose(), LG.lazyProduct(E)};
}

}  // namespace

Landmark LandmarkGivenPath(const WindowInput& in, const Track& track, const PathGaussian& path,
                           const Eigen::Vector3d& theta) {
  return {theta, Condition(in, track, path, theta).P};
}

Eigen::Matrix<double, 9, 9> AnchorAndLandmarkCovariance(const WindowInput& in, const Track& track,
                                                        const PathGaussian& path, const Eigen::Vector3d& theta) {
  const Conditional landmark = Condition(in, track, path, theta);
  const Eigen::Matrix<double, Eigen::Dynamic, 3> cross = path.covariance.lazyProduct(landmark.D.transpose());
  Eigen::Matrix<double, 9, 9> P = Eigen::Matrix<double, 9, 9>::Zero();
  P.bottomRightCorner<3, 3>() = landmark.P + landmark.D.lazyProduct(cross);
  if (track.anchor_slot >= 0) {
    const Eigen::Index a = kPoseSize * track.anchor_slot;
    P.topLeftCorner<6, 6>() = path.covariance.block<6, 6>(a, a);
    P.topRightCorner<6, 3>() = -cross.middleRows<6>(a);
    P.bottomLeftCorner<3, 6>() = P.topRightCorner<6, 3>().transpose();
  }
  return Symmetrised(P);
}

Eigen::Matrix3d PointCovarianceOnPath(const WindowInput& in, const Track& track, const PathGaussian& path,
                                      const Eigen::Vector3d& theta) {
  const Pose& anchor = in.anchors[track.anchor];
  Eigen::Matrix<double, 3, 9> J;
  J << PointAnchorJacobian(anchor, theta), PointJacobian(anchor, theta);
  return Symmetrised(J * AnchorAndLandmarkCovariance(in, track, path, theta) * J.transpose());
}

ImagePrediction PredictImageOnPath(const WindowInput& in, const Track& track, const PathGaussian& path,
                                   const Eigen::Vector3d& theta) {
  const Projection h = Project({path.mean.back(), AnchorOn(path, in, track)}, theta);
  if (!h.in_front) return {};
  if (track.views.empty() && track.anchor_slot < 0) {  // the window does not see it
    const auto last = path.covariance.bottomRightCorner<6, 6>();
    const Eigen::Matrix3d& P = in.landmarks[track.landmark].covariance;
    return {true, h.z,
            Symmetrised(h.J_pose * last * h.J_pose.transpose() + h.J_landmark * P * h.J_landmark.transpose())};
  }
  const Conditional landmark = Condition(in, track, path, theta);
  Eigen::Matrix<double, 2, Eigen::Dynamic> J = -h.J_landmark.lazyProduct(landmark.D);
  J.rightCols<6>() += h.J_pose;
  if (track.anchor_slot >= 0) J.middleCols<6>(kPoseSize * track.anchor_slot) += AnchorJacobian(h, theta);
  // Thin: a blocked product is slower
  const Eigen::Matrix<double, Eigen::Dynamic, 2> PJt = path.covariance.lazyProduct(J.transpose());
  return {true, h.z, Symmetrised(J.lazyProduct(PJt) + h.J_landmark * landmark.P * h.J_landmark.transpose())};
}

}  // namespace vo
