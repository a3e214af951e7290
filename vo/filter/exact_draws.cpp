#include "vo/filter/exact_draws.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>

namespace vo {

ParticleColumns ExactDraws(const ParticleColumns& offsets, const ParticleColumns& normals) {
  const Eigen::Index n = normals.cols();
  ParticleColumns draws = normals.colwise() - normals.rowwise().mean();
  if (n >= normals.rows() + offsets.rows() + 2) {
    // Rows of the offsets that the others span already (particles that are all at one place) are left out by the rank.
    const Eigen::MatrixXd centred = (offsets.colwise() - offsets.rowwise().mean()).transpose();
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(centred);
    const Eigen::MatrixXd basis = (qr.householderQ() * Eigen::MatrixXd::Identity(n, qr.rank())).eval();
    draws -= (draws * basis) * basis.transpose();
  }
  const Eigen::MatrixXd covariance = draws * draws.transpose() / static_cast<double>(n);
  return covariance.llt().matrixL().solve(draws);
}

}  // namespace vo
