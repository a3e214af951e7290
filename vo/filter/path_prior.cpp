#include "vo/filter/path_prior.h"

#include <Eigen/Cholesky>

#include "vo/geometry/symmetric.h"

namespace vo {

PathPrior::PathPrior(const std::vector<MotionModel>& steps, const Matrix6& velocity_covariance) {
  const int m = static_cast<int>(steps.size());
  Eigen::MatrixXd covariance(kPoseSize * m, kPoseSize * m);                  // of u
  Eigen::Matrix<double, 6, Eigen::Dynamic> with_velocity(6, kPoseSize * m);  // Cov(v_k, u_1..k)
  Matrix6 V = velocity_covariance;
  last_of_first_ = Matrix6::Identity();
  for (int k = 0; k < m; ++k) {
    const Matrix6 F12 = steps[k].F.topRightCorner<6, 6>(), F22 = steps[k].F.bottomRightCorner<6, 6>();
    const Matrix6 Q11 = steps[k].Q.topLeftCorner<6, 6>(), Q21 = steps[k].Q.bottomLeftCorner<6, 6>(),
                  Q22 = steps[k].Q.bottomRightCorner<6, 6>();
    mean_of_step_.push_back(F12 * last_of_first_);
    last_of_first_ = F22 * last_of_first_;
    covariance.block(kPoseSize * k, 0, 6, kPoseSize * k) = F12 * with_velocity.leftCols(kPoseSize * k);
    covariance.block(0, kPoseSize * k, kPoseSize * k, 6) =
        covariance.block(kPoseSize * k, 0, 6, kPoseSize * k).transpose();
    covariance.block<6, 6>(kPoseSize * k, kPoseSize * k) = F12 * V * F12.transpose() + Q11;
    with_velocity.leftCols(kPoseSize * k) = (F22 * with_velocity.leftCols(kPoseSize * k)).eval();
    with_velocity.middleCols<6>(kPoseSize * k) = F22 * V * F12.transpose() + Q21;
    V = (F22 * V * F22.transpose()).eval() + Q22;
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  precision_ = Symmetrised(llt.solve(Eigen::MatrixXd::Identity(kPoseSize * m, kPoseSize * m)));
  log_det_precision_ = -2.0 * llt.matrixLLT().diagonal().array().log().sum();
  gain_ = llt.solve(with_velocity.transpose()).transpose();
  last_covariance_ = Symmetrised(V - gain_ * with_velocity.transpose());
}

}  // namespace vo
