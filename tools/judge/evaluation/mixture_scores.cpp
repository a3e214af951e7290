#include "tools/judge/evaluation/mixture_scores.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "tools/judge/evaluation/distributions.h"
#include "tools/judge/evaluation/draws.h"

namespace evaluation {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double TotalWeight(const Mixture& mixture) {
  double total = 0;
  for (const MixtureComponent& component : mixture) total += component.weight;
  return total;
}

// Density of many points, factorised once.
class Density {
 public:
  explicit Density(const Mixture& mixture) {
    const double total = TotalWeight(mixture);
    for (const MixtureComponent& component : mixture) {
      if (!(component.weight > 0)) continue;
      const SquareRoot root = SquareRootOf(component.covariance);
      defined_ = defined_ && root.full;
      log_factor_.push_back(std::log(component.weight / total) - root.L.diagonal().array().log().sum() -
                            0.5 * static_cast<double>(root.L.rows()) * std::log(2 * M_PI));
      L_.push_back(root.L);
      offset_.push_back(component.offset);
    }
  }
  bool defined() const { return defined_; }
  // One per column.
  Eigen::VectorXd Log(const Eigen::MatrixXd& x) const {
    const auto n = static_cast<Eigen::Index>(L_.size());
    Eigen::MatrixXd terms(n, x.cols());
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Eigen::MatrixXd white = L_[k].triangularView<Eigen::Lower>().solve(x.colwise() - offset_[k]);
      terms.row(i) = (log_factor_[k] - 0.5 * white.colwise().squaredNorm().array()).matrix();
    }
    const Eigen::RowVectorXd largest = terms.colwise().maxCoeff();
    return (largest.array() + (terms.rowwise() - largest).array().exp().colwise().sum().log()).transpose();
  }

 private:
  std::vector<double> log_factor_;
  std::vector<Eigen::MatrixXd> L_;
  std::vector<Eigen::VectorXd> offset_;
  bool defined_ = true;
};

void Check(const Mixture& mixture, const Vector12d& error, int draws) {
  std::string problems;
  if (mixture.empty()) problems += " no component;";
  if (draws < 0 || draws == 1) problems += " draws must be none or at least two;";
  if (!error.allFinite()) problems += " the error is not finite;";
  for (std::size_t i = 0; i < mixture.size(); ++i) {
    const MixtureComponent& component = mixture[i];
    const std::string name = " component " + std::to_string(i);
    if (!(component.weight >= 0) || !std::isfinite(component.weight))
      problems += name + ": weight " + std::to_string(component.weight) + ";";
    if (component.offset.size() != 12 || component.covariance.rows() != 12 || component.covariance.cols() != 12)
      problems += name + ": not of twelve dimensions;";
    else if (!component.offset.allFinite() || !component.covariance.allFinite())
      problems += name + ": not finite;";
  }
  if (!mixture.empty() && !(TotalWeight(mixture) > 0)) problems += " no weight above zero;";
  if (!problems.empty()) throw std::invalid_argument("ScoreMixture:" + problems);
}

}  // namespace

Mixture Block(const Mixture& mixture, const StateBlock& block) {
  Mixture part;
  for (const MixtureComponent& component : mixture) {
    part.push_back({component.weight, component.offset.segment(block.start, block.size),
                    component.covariance.block(block.start, block.start, block.size, block.size)});
  }
  return part;
}

Moments MomentsOf(const Mixture& mixture) {
  const double total = TotalWeight(mixture);
  const Eigen::Index n = mixture.front().offset.size();
  Moments moments{Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
  for (const MixtureComponent& component : mixture) moments.mean += component.weight / total * component.offset;
  for (const MixtureComponent& component : mixture) {
    const Eigen::VectorXd d = component.offset - moments.mean;
    moments.covariance += component.weight / total * (component.covariance + d * d.transpose());
  }
  return moments;
}

double EffectiveComponents(const Mixture& mixture) {
  double squares = 0;
  for (const MixtureComponent& component : mixture) squares += component.weight * component.weight;
  const double total = TotalWeight(mixture);
  return total * total / squares;
}

Eigen::MatrixXd Draw(const Mixture& mixture, int draws, std::uint64_t seed, std::uint64_t stream) {
  evaluation::Draws random(seed, stream);
  const double total = TotalWeight(mixture);
  std::vector<Eigen::MatrixXd> roots(mixture.size());  // of those that are drawn
  Eigen::MatrixXd points(mixture.front().offset.size(), draws);
  for (Eigen::Index k = 0; k < points.cols(); ++k) {
    double left = total * random.Uniform();
    std::size_t i = 0;
    while (i + 1 < mixture.size() && left >= mixture[i].weight) left -= mixture[i++].weight;
    while (!(mixture[i].weight > 0)) --i;  // rounding past the last component, which has no weight
    if (roots[i].size() == 0) roots[i] = SquareRootOf(mixture[i].covariance).L;
    points.col(k) = mixture[i].offset + roots[i] * random.Normals(points.rows());
  }
  return points;
}

std::vector<int> Ranks(const Eigen::MatrixXd& draws, const Eigen::VectorXd& error) {
  std::vector<int> ranks;
  for (Eigen::Index i = 0; i < error.size(); ++i)
    ranks.push_back(static_cast<int>((draws.row(i).array() < error[i]).count()));
  return ranks;
}

double HpdMass(const Mixture& mixture, const Eigen::MatrixXd& draws, const Eigen::VectorXd& error) {
  const Density density(mixture);
  if (!density.defined()) return kNaN;
  if (mixture.size() == 1) {
    return Chi2Cdf(Nees(error - mixture[0].offset, mixture[0].covariance), static_cast<double>(error.size()));
  }
  if (draws.cols() == 0) return kNaN;
  const double at_error = density.Log(error)[0];
  const auto higher = (density.Log(draws).array() > at_error).count();
  return (static_cast<double>(higher) + 0.5) / (static_cast<double>(draws.cols()) + 1);
}

double EnergyScore(const Eigen::MatrixXd& draws, const Eigen::VectorXd& error) {
  const auto n = static_cast<double>(draws.cols());
  if (n < 2) return kNaN;
  double spread = 0;
  for (Eigen::Index i = 0; i < draws.cols(); ++i)
    spread += (draws.leftCols(i).colwise() - draws.col(i)).colwise().norm().sum();
  return (draws.colwise() - error).colwise().norm().mean() - spread / (n * (n - 1));
}

MixtureScores ScoreMixture(const Mixture& mixture, const Vector12d& error, std::uint64_t stream, int draws,
                           std::uint64_t seed) {
  Check(mixture, error, draws);
  MixtureScores scores;
  const Moments moments = MomentsOf(mixture);
  const Eigen::MatrixXd points = Draw(mixture, draws, seed, stream);
  for (std::size_t b = 0; b < kStateBlocks.size(); ++b) {
    const StateBlock& block = kStateBlocks[b];
    const Mixture part = Block(mixture, block);
    const Eigen::VectorXd e = error.segment(block.start, block.size);
    const Eigen::MatrixXd x = points.middleRows(block.start, block.size);
    scores.nees[b] = Nees(e - moments.mean.segment(block.start, block.size),
                          moments.covariance.block(block.start, block.start, block.size, block.size));
    scores.hpd_mass[b] = HpdMass(part, x, e);
    if (b < scores.energy.size()) scores.energy[b] = EnergyScore(x, e);
  }
  const std::vector<int> ranks = Ranks(points, error);
  std::copy(ranks.begin(), ranks.end(), scores.rank.begin());
  scores.draws = draws;
  scores.effective_components = EffectiveComponents(mixture);
  return scores;
}

}  // namespace evaluation
