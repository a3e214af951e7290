#include "vo/filter/path_gaussian.h"

#include <algorithm>

#include "vo/geometry/covariance.h"
#include "vo/geometry/so3.h"

namespace vo {
namespace {

// mean + by_pose (poses - their means) + N(0, prior.last_covariance())
struct LastVelocity {
  Vector6 mean;  // (v in W, w in C)
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_pose;
};

LastVelocity VelocityAtTheEnd(const PathPrior& prior, const Pose& start, const Vector6& velocity,
                              const PathGaussian& path) {
  const int m = prior.size();
  Eigen::VectorXd off(kPoseSize * m);
  LastVelocity last{Vector6::Zero(), Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, kPoseSize * m)};
  for (int k = 0; k < m; ++k) {
    const Vector6 u = StepTo(k, path, start);
    off.segment<6>(kPoseSize * k) = u - prior.MeanStep(k, velocity);
    Matrix6 J = Matrix6::Identity();
    J.bottomRightCorner<3, 3>() = InverseRightJacobian(u.tail<3>());
    const auto gain = prior.gain().middleCols<6>(kPoseSize * k);
    last.by_pose.middleCols<6>(kPoseSize * k) += gain * J;
    if (k == 0) continue;
    J.bottomRightCorner<3, 3>() = InverseRightJacobian(-u.tail<3>());
    last.by_pose.middleCols<6>(kPoseSize * (k - 1)) -= gain * J;
  }
  last.mean = prior.LastMean(velocity) + prior.gain() * off;
  return last;
}

}  // namespace

PathPrior::PathPrior(const std::vector<MotionModel>& steps, const Matrix6& velocity_covariance,
                     const std::vector<MotionModel>& of_rates) {
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
  llt_.compute(covariance);
  precision_ = Symmetrised(llt_.solve(Eigen::MatrixXd::Identity(kPoseSize * m, kPoseSize * m)));
  log_det_precision_ = -2.0 * llt_.matrixLLT().diagonal().array().log().sum();
  gain_ = llt_.solve(with_velocity.transpose()).transpose();
  last_covariance_ = Symmetrised(V - gain_ * with_velocity.transpose());
  SetRates(of_rates);
}

void PathPrior::SetRates(const std::vector<MotionModel>& steps) {
  if (steps.empty()) return;
  const int m = size();
  Eigen::MatrixXd rates = Eigen::MatrixXd::Zero(3 * (m + 1), 3 * (m + 1));
  const auto add = [&](int i, int j, double share, int step) {
    rates.block<3, 3>(3 * i, 3 * j) += share * steps[step].Q.bottomRightCorner<3, 3>();
  };
  for (int k = 0; k < m; ++k) {
    add(k, k, 1.0 / 12, k);
    add(k + 1, k + 1, 1.0 / 12, k);
    add(k, k + 1, -1.0 / 12, k);
    add(k + 1, k, -1.0 / 12, k);
  }
  add(0, 0, 1.0 / 4, 0);
  add(m, m, 1.0 / 4, m - 1);
  if (m > 1) add(m - 1, m - 1, 1.0 / 4, m - 1);
  rate_precision_ = Symmetrised(rates.llt().solve(Eigen::MatrixXd::Identity(rates.rows(), rates.cols())));
}

Eigen::VectorXd PathPrior::ShiftBy(const std::vector<StepTurn>& turns) const {
  if (std::ranges::all_of(turns, [](const StepTurn& turn) { return turn.input.isZero(0); })) return {};
  Eigen::VectorXd s = Eigen::VectorXd::Zero(precision_.rows());
  for (Eigen::Index k = 0; k < size(); ++k) {
    auto s_k = s.segment<6>(kPoseSize * k);
    s_k.tail<3>() = turns[static_cast<std::size_t>(k)].input;
    llt_.matrixLLT().block<6, 6>(kPoseSize * k, kPoseSize * k).triangularView<Eigen::Lower>().solveInPlace(s_k);
  }
  return llt_.matrixL() * s;
}

BeliefComponent ComponentAtTheEnd(const PathPrior& prior, const Pose& start, const Vector6& velocity,
                                  const PathGaussian& path) {
  const LastVelocity last = VelocityAtTheEnd(prior, start, velocity, path);
  BeliefComponent component;
  component.pose = path.mean.back();
  component.velocity = last.mean;
  const Eigen::Matrix<double, 6, Eigen::Dynamic> cross = last.by_pose * path.covariance;
  component.covariance.topLeftCorner<6, 6>() = path.covariance.bottomRightCorner<6, 6>();
  component.covariance.bottomLeftCorner<6, 6>() = cross.rightCols<6>();
  component.covariance.topRightCorner<6, 6>() = cross.rightCols<6>().transpose();
  component.covariance.bottomRightCorner<6, 6>() =
      prior.last_covariance() + Symmetrised(cross * last.by_pose.transpose());
  return component;
}

void Extend(const PathPrior& prior, const MotionModel& step, const Pose& start, const Vector6& velocity,
            const std::optional<Eigen::Quaterniond>& turn, PathGaussian& path) {
  const Eigen::Index size = kPoseSize * prior.size();
  const LastVelocity last = VelocityAtTheEnd(prior, start, velocity, path);
  const Matrix6 F12 = step.F.topRightCorner<6, 6>();
  Vector6 u = F12 * last.mean;
  Eigen::Vector3d input = Eigen::Vector3d::Zero();
  if (turn) {
    input = LogNear(*turn, u.tail<3>()) - u.tail<3>();
    u.tail<3>() += input;
  }
  Matrix6 by_step = Matrix6::Identity();
  by_step.bottomRightCorner<3, 3>() = RightJacobian(u.tail<3>());
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_pose = by_step * F12 * last.by_pose;
  if (size > 0) {
    by_pose.topRightCorner<6, 6>().topLeftCorner<3, 3>() += Eigen::Matrix3d::Identity();
    by_pose.bottomRightCorner<3, 3>() += Exp(u.tail<3>()).conjugate().toRotationMatrix();
  }
  const Matrix6 noise = F12 * prior.last_covariance() * F12.transpose() + step.Q.topLeftCorner<6, 6>();
  const Eigen::Matrix<double, 6, Eigen::Dynamic> cross = by_pose * path.covariance;
  path.covariance.conservativeResize(size + 6, size + 6);
  path.covariance.bottomLeftCorner(6, size) = cross;
  path.covariance.topRightCorner(size, 6) = cross.transpose();
  path.covariance.bottomRightCorner<6, 6>() =
      Symmetrised(cross * by_pose.transpose() + by_step * noise * by_step.transpose());
  path.mean.push_back(Plus(path.mean.empty() ? start : path.mean.back(), u));
  path.turns.push_back({u.tail<3>(), input});
  path.rates.emplace_back(Eigen::Vector3d::Zero());
}

void Move(const Pose& motion, PathGaussian& path) {
  for (Pose& pose : path.mean) pose = motion * pose;
  const Eigen::Matrix3d R = motion.q_WC.toRotationMatrix();
  for (Eigen::Index k = 0; k < path.covariance.rows(); k += kPoseSize) {  // of each pose, dp is in W
    path.covariance.middleRows<3>(k) = (R * path.covariance.middleRows<3>(k)).eval();
    path.covariance.middleCols<3>(k) = (path.covariance.middleCols<3>(k) * R.transpose()).eval();
  }
  Symmetrise(path.covariance);
}

void DropLast(PathGaussian& path) {
  path.mean.pop_back();
  path.turns.pop_back();
  path.rates.pop_back();
  path.covariance.conservativeResize(path.covariance.rows() - kPoseSize, path.covariance.cols() - kPoseSize);
}

void ConditionOnScale(const Pose& start, PathGaussian& path) {
  constexpr double kLeft = 1e-4;  // of the variance: the covariance stays definite
  Eigen::VectorXd d = Eigen::VectorXd::Zero(path.covariance.rows());
  for (std::size_t k = 0; k < path.mean.size(); ++k)
    d.segment<3>(kPoseSize * static_cast<Eigen::Index>(k)) = path.mean[k].p_WC - start.p_WC;
  const double information = d.dot(path.covariance.llt().solve(d));
  if (information > 0) path.covariance -= (1 - kLeft) / information * d * d.transpose();
}

void ConditionOn(int slot, const Pose& s, PathGaussian& path) {
  const int rest = static_cast<int>(path.covariance.rows()) - 6;
  const Eigen::LLT<Matrix6> llt(path.covariance.topLeftCorner<6, 6>());
  const Vector6 d = llt.solve(Minus(s, path.mean[slot]));
  const Eigen::MatrixXd cross = path.covariance.bottomLeftCorner(rest, 6);
  for (int k = 0; k < rest / 6; ++k)
    path.mean[slot + 1 + k] = Plus(path.mean[slot + 1 + k], cross.middleRows<6>(kPoseSize * k) * d);
  path.mean[slot] = s;
  path.covariance = (path.covariance.bottomRightCorner(rest, rest) - cross * llt.solve(cross.transpose())).eval();
}

}  // namespace vo
