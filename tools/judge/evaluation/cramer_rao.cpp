#include "tools/judge/evaluation/cramer_rao.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "tools/judge/evaluation/draws.h"

namespace evaluation {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The exact Kalman filter of the linearised world. State: (pose, velocity), then three numbers per active point. Beside
// the covariance it propagates errors of any number of runs, one per column, each with its own noise.
class Linearised {
 public:
  Linearised(const PointWorldProblem& problem, int runs, std::uint64_t seed) : problem_(problem), random_(seed, 0) {
    P_ = problem.start_covariance;
    errors_ = SquareRootOf(P_).L * Noise(12, runs);
  }

  void Predict(std::size_t k) {
    const MotionJacobian motion =
        LinearisedMotion(problem_.truth[k - 1], problem_.truth[k], problem_.position_noise, problem_.orientation_noise);
    P_.topRows<12>() = (motion.F * P_.topRows<12>()).eval();
    P_.leftCols<12>() = (P_.leftCols<12>() * motion.F.transpose()).eval();
    P_.topLeftCorner<12, 12>() += motion.Q;
    errors_.topRows<12>() =
        (motion.F * errors_.topRows<12>() + SquareRootOf(motion.Q).L * Noise(12, errors_.cols())).eval();
  }

  void Update(std::size_t k) {
    std::vector<std::size_t> seen;  // of alive_
    for (std::size_t i = 0; i < alive_.size(); ++i) {
      Living& living = alive_[i];
      if (problem_.landmarks[living.landmark].frames[living.next] == k) {  // those without a next have left
        seen.push_back(i);
        ++living.next;
      }
    }
    if (seen.empty()) return;
    const auto rows = 2 * static_cast<Index>(seen.size());
    MatrixXd PHt(P_.rows(), rows), HPHt(rows, rows), innovation(rows, errors_.cols());
    std::vector<Eigen::Matrix<double, 2, 9>> H(seen.size());
    for (std::size_t j = 0; j < seen.size(); ++j) {
      const HomogeneousPoint& point = alive_[seen[j]].point;
      const ViewJacobian view = LinearisedView(point, problem_.truth[k]);
      H[j] << view.of_pose, view.of_point * point.across.transpose();
      const Index at = Start(seen[j]), row = 2 * static_cast<Index>(j);
      PHt.middleCols<2>(row).noalias() = P_.leftCols<6>() * H[j].leftCols<6>().transpose();
      PHt.middleCols<2>(row).noalias() += P_.middleCols<3>(at) * H[j].rightCols<3>().transpose();
      innovation.middleRows<2>(row) =
          H[j].leftCols<6>() * errors_.topRows<6>() + H[j].rightCols<3>() * errors_.middleRows<3>(at);
    }
    for (std::size_t j = 0; j < seen.size(); ++j) {
      const Index row = 2 * static_cast<Index>(j);
      HPHt.middleRows<2>(row).noalias() = H[j].leftCols<6>() * PHt.topRows<6>();
      HPHt.middleRows<2>(row).noalias() += H[j].rightCols<3>() * PHt.middleRows<3>(Start(seen[j]));
    }
    HPHt.diagonal().array() += problem_.sigma * problem_.sigma;
    innovation += problem_.sigma * Noise(rows, errors_.cols());
    const Eigen::LLT<MatrixXd> S(HPHt);
    const MatrixXd root = S.matrixL().solve(PHt.transpose());  // P H' S^-1 H P = root' root
    errors_.noalias() -= root.transpose() * S.matrixL().solve(innovation);
    P_.selfadjointView<Eigen::Lower>().rankUpdate(root.transpose(), -1);
    P_.triangularView<Eigen::StrictlyUpper>() = P_.transpose();
  }

  // Adds points anchored here, removes those not measured any more.
  void Exchange(std::size_t k) {
    std::vector<Living> kept;
    std::vector<Index> index(12);
    std::iota(index.begin(), index.end(), 0);
    for (std::size_t i = 0; i < alive_.size(); ++i) {
      if (alive_[i].next == problem_.landmarks[alive_[i].landmark].frames.size()) continue;
      for (Index d = 0; d < 3; ++d) index.push_back(Start(i) + d);
      kept.push_back(alive_[i]);
    }
    if (kept.size() < alive_.size()) {
      P_ = P_(index, index).eval();
      errors_ = errors_(index, Eigen::all).eval();
    }
    alive_ = std::move(kept);
    std::vector<std::size_t> born;
    for (std::size_t n = 0; n < problem_.landmarks.size(); ++n)
      if (problem_.landmarks[n].anchor_frame == k && !problem_.landmarks[n].frames.empty()) born.push_back(n);
    if (born.empty()) return;
    const Index old = P_.rows(), more = 3 * static_cast<Index>(born.size());
    MatrixXd of_poses(more, 6), noise = MatrixXd::Zero(more, more);
    for (std::size_t j = 0; j < born.size(); ++j) {
      const PointLandmark& landmark = problem_.landmarks[born[j]];
      const HomogeneousPoint point = PointOf(landmark, problem_.truth[k]);
      const AnchorJacobian anchor = LinearisedAnchor(landmark, problem_.truth[k]);
      const Vector3d sigma(problem_.anchor_sigma, problem_.anchor_sigma, landmark.inverse_depth_sigma);
      const Index at = 3 * static_cast<Index>(j);
      of_poses.middleRows<3>(at) = point.across * anchor.of_pose;
      noise.block<3, 3>(at, at) = point.across * anchor.of_landmark * sigma.asDiagonal();
      alive_.push_back({born[j], 0, point});
    }
    P_.conservativeResize(old + more, old + more);
    P_.bottomLeftCorner(more, old) = of_poses * P_.topLeftCorner(6, old);
    P_.topRightCorner(old, more) = P_.bottomLeftCorner(more, old).transpose();
    P_.bottomRightCorner(more, more) =
        of_poses * P_.topLeftCorner<6, 6>() * of_poses.transpose() + noise * noise.transpose();
    errors_.conservativeResize(old + more, Eigen::NoChange);
    errors_.bottomRows(more) = of_poses * errors_.topRows<6>() + noise * Noise(more, errors_.cols());
  }

  Matrix12d covariance() const { return P_.topLeftCorner<12, 12>(); }
  const MatrixXd& errors() const { return errors_; }

 private:
  struct Living {
    std::size_t landmark, next;  // next: of its frames
    HomogeneousPoint point;
  };
  static Index Start(std::size_t i) { return 12 + 3 * static_cast<Index>(i); }
  MatrixXd Noise(Index rows, Index columns) {
    MatrixXd noise(rows, columns);
    for (double& value : noise.reshaped()) value = random_.Normal();
    return noise;
  }

  const PointWorldProblem& problem_;
  Draws random_;
  std::vector<Living> alive_;
  MatrixXd P_, errors_;
};

}  // namespace

LinearisedRuns SimulateLinearised(const PointWorldProblem& problem, int runs, std::uint64_t seed) {
  Validate(problem);
  Linearised filter(problem, runs, seed);
  LinearisedRuns result;
  result.error.resize(static_cast<std::size_t>(runs));
  for (std::size_t k = 0; k < problem.truth.size(); ++k) {
    if (k > 0) filter.Predict(k);
    filter.Update(k);
    result.bound.push_back(filter.covariance());
    for (std::size_t m = 0; m < result.error.size(); ++m)
      result.error[m].push_back(filter.errors().col(static_cast<Index>(m)).head<12>());
    filter.Exchange(k);
  }
  return result;
}

std::vector<std::vector<double>> NeesOf(const LinearisedRuns& runs, int start, int size) {
  std::vector<std::vector<double>> nees(runs.error.size());
  for (std::size_t k = 0; k < runs.bound.size(); ++k) {
    const MatrixXd P = runs.bound[k].block(start, start, size, size);
    const bool usable = !std::isnan(Nees(Eigen::VectorXd::Zero(size), P));
    const Eigen::LLT<MatrixXd> factor(P);
    for (std::size_t m = 0; m < runs.error.size(); ++m) {
      const Eigen::VectorXd e = runs.error[m][k].segment(start, size);
      nees[m].push_back(usable ? factor.matrixL().solve(e).squaredNorm() : kNaN);
    }
  }
  return nees;
}

BoundRatio CompareWithBound(const std::vector<std::vector<Vector12d>>& errors,
                            const std::vector<std::vector<Matrix12d>>& bounds) {
  std::array<double, 4> squares{}, traces{};
  double count = 0;
  if (errors.size() != bounds.size()) throw std::logic_error("CompareWithBound: a run without its bound");
  for (std::size_t m = 0; m < errors.size(); ++m) {
    if (errors[m].size() != bounds[m].size()) throw std::logic_error("CompareWithBound: a frame without its bound");
    for (std::size_t k = 0; k < errors[m].size(); ++k) {
      for (std::size_t b = 0; b < 4; ++b) {
        const auto start = 3 * static_cast<Eigen::Index>(b);
        squares[b] += errors[m][k].segment<3>(start).squaredNorm();
        traces[b] += bounds[m][k].diagonal().segment<3>(start).sum();
      }
      ++count;
    }
  }
  BoundRatio result;
  for (std::size_t b = 0; b < 4; ++b) {
    result.overall[b] = traces[b] > 0 ? std::sqrt(squares[b] / traces[b]) : kNaN;
    result.rmse[b] = std::sqrt(squares[b] / count);
    result.bound[b] = std::sqrt(traces[b] / count);
  }
  return result;
}

}  // namespace evaluation
