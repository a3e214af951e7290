// Kalman filter of the velocity, the second Rao-Blackwellisation: conditional on the sampled path s_pf, the rest of the
// state s_kf is Gaussian. Each sampled step is a measurement whose noise is correlated with the process noise.
// Source:  (10), (18)-(25) and Algorithm 1, (37)-(43). Three places differ from print: Psi is a square root (18); the
//          cross terms of P_mm are H Gamma Lambda' and its transpose (41); the sign in (43) is minus.
// Shapes:  P = dimension of s_pf, K = dimension of s_kf. Works for any F with F22 invertible and any Q with Q22 > 0.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>

#include "vo/geometry/symmetric.h"

namespace vo {

template <int P, int K>
struct KalmanState {
  Eigen::Matrix<double, K, 1> mean = Eigen::Matrix<double, K, 1>::Zero();
  Eigen::Matrix<double, K, K> covariance = Eigen::Matrix<double, K, K>::Zero();
};

// Everything about one time step that does not depend on the particle.
template <int P, int K>
class VelocityFilter {
 public:
  using VectorP = Eigen::Matrix<double, P, 1>;
  using VectorK = Eigen::Matrix<double, K, 1>;
  using MatrixPP = Eigen::Matrix<double, P, P>;
  using MatrixPK = Eigen::Matrix<double, P, K>;
  using MatrixKP = Eigen::Matrix<double, K, P>;
  using MatrixKK = Eigen::Matrix<double, K, K>;
  using State = KalmanState<P, K>;

  VelocityFilter(const Eigen::Matrix<double, P + K, P + K>& F, const Eigen::Matrix<double, P + K, P + K>& Q)
      : F11_(F.template topLeftCorner<P, P>()),
        F12_(F.template topRightCorner<P, K>()),
        F21_(F.template bottomLeftCorner<K, P>()),
        Phi_(F.template bottomRightCorner<K, K>()),
        Q11_(Q.template topLeftCorner<P, P>()) {
    const MatrixPK Q12 = Q.template topRightCorner<P, K>();
    const MatrixKK Q22 = Q.template bottomRightCorner<K, K>();
    const MatrixKK F22_inverse = Phi_.inverse();
    Gamma_ = Q22.llt().matrixL();
    H_ = F12_ * F22_inverse;                                               // (22)
    Lambda_ = Q12 * MatrixKK(Gamma_.inverse()).transpose() - H_ * Gamma_;  // (22)
    Psi_Psi_ = Q11_ - Q12 * Q22.llt().solve(Q12.transpose());              // (19), as its square
    m_previous_ = H_ * F21_ - F11_;                                        // (26)
  }

  // (12)(13): the next s_pf before it is sampled.
  VectorP PredictedMean(const VectorP& s_pf, const State& s_kf) const { return F11_ * s_pf + F12_ * s_kf.mean; }
  MatrixPP PredictedCovariance(const State& s_kf) const { return Q11_ + F12_ * s_kf.covariance * F12_.transpose(); }

  struct Gain {
    VectorK mean;         // s_kf = mean + matrix * s_pf, before s_pf is known
    MatrixKP matrix;      // P_vm P_mm^-1
    MatrixKK covariance;  // of s_kf, given s_pf
    State Given(const VectorP& s_pf) const { return {mean + matrix * s_pf, covariance}; }
  };

  // (37)-(43) as a function of the s_pf still to be sampled.
  Gain Condition(const VectorP& s_pf_previous, const State& s_kf) const {
    Gain gain = ConditionCovariance(s_kf.covariance);
    ConditionMean(s_pf_previous, s_kf.mean, gain);
    return gain;
  }
  // The same in two parts. The first is alike for all particles whose covariance is, and leaves the mean to the second.
  Gain ConditionCovariance(const MatrixKK& covariance) const {
    const MatrixKK S = Phi_ * covariance * Phi_.transpose() + Gamma_ * Gamma_.transpose();  // (38)
    const MatrixKP P_vm = S * H_.transpose() + Gamma_ * Lambda_.transpose();                // (40)
    const MatrixPP cross = H_ * Gamma_ * Lambda_.transpose();
    const MatrixPP P_mm =
        H_ * S * H_.transpose() + Psi_Psi_ + Lambda_ * Lambda_.transpose() + cross + cross.transpose();  // (41)
    Gain gain;
    gain.matrix = P_mm.llt().solve(P_vm.transpose()).transpose();
    gain.covariance = Symmetrised(S - gain.matrix * P_vm.transpose());  // (43)
    return gain;
  }
  void ConditionMean(const VectorP& s_pf_previous, const VectorK& mean, Gain& gain) const {
    const VectorK predicted = Phi_ * mean + F21_ * s_pf_previous;                          // (37)
    gain.mean = predicted + gain.matrix * (m_previous_ * s_pf_previous - H_ * predicted);  // (39)(42)
  }

  State Update(const VectorP& s_pf_previous, const VectorP& s_pf, const State& s_kf) const {
    return Condition(s_pf_previous, s_kf).Given(s_pf);
  }

 private:
  MatrixPP F11_;
  MatrixPK F12_;
  MatrixKP F21_;
  MatrixKK Phi_;
  MatrixPP Q11_;
  MatrixKK Gamma_;
  MatrixPK H_;
  MatrixPK Lambda_;
  MatrixPP Psi_Psi_;
  MatrixPP m_previous_;
};

}  // namespace vo
