#include "vo/map/row_view.h"

#include <Eigen/Geometry>

#include "vo/geometry/so3.h"

namespace vo {

RowView::Compensated RowView::RotationCompensated(const Vector6& velocity) const {
  if (time == 0) return {z, Eigen::Vector3d::Zero()};
  return {(Exp(time * velocity.tail<3>()) * z.homogeneous()).hnormalized(), time * velocity.head<3>()};
}

}  // namespace vo
