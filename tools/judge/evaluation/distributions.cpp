#include "tools/judge/evaluation/distributions.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <stdexcept>
#include <string>

namespace evaluation {
namespace {

void RequireDof(const char* who, double dof) {
  if (!(dof > 0) || std::isinf(dof))
    throw std::invalid_argument(std::string(who) + ": degrees of freedom must be positive, not " + std::to_string(dof));
}

void RequireInside(const char* who, double probability) {
  if (!(probability > 0) || !(probability < 1))
    throw std::invalid_argument(std::string(who) + ": needs 0 < probability < 1, not " + std::to_string(probability));
}

}  // namespace

double Chi2Cdf(double x, double dof) {
  RequireDof("Chi2Cdf", dof);
  const double inside = std::max(x, 0.0);
  if (!std::isfinite(inside)) return std::isnan(x) ? x : 1;
  return cdf(boost::math::chi_squared(dof), inside);
}

double Chi2Survival(double x, double dof) {
  RequireDof("Chi2Survival", dof);
  const double inside = std::max(x, 0.0);
  if (!std::isfinite(inside)) return std::isnan(x) ? x : 0;
  return cdf(complement(boost::math::chi_squared(dof), inside));
}

double Chi2Quantile(double probability, double dof) {
  RequireDof("Chi2Quantile", dof);
  RequireInside("Chi2Quantile", probability);
  return quantile(boost::math::chi_squared(dof), probability);
}

Band Chi2MeanBand(double dof, int runs, double probability) {
  if (runs < 1) throw std::invalid_argument("Chi2MeanBand: needs at least one run");
  const double m = runs;
  return {Chi2Quantile((1 - probability) / 2, dof * m) / m, Chi2Quantile((1 + probability) / 2, dof * m) / m};
}

double StudentQuantile(double probability, double dof) {
  RequireDof("StudentQuantile", dof);
  RequireInside("StudentQuantile", probability);
  return quantile(boost::math::students_t(dof), probability);
}

std::size_t BinomialLimit(std::size_t n, double p, double tail) {
  if (!(p >= 0 && p <= 1) || !(tail >= 0))
    throw std::invalid_argument("BinomialLimit: needs 0 <= p <= 1 and tail >= 0");
  const boost::math::binomial events(static_cast<double>(n), p);
  std::size_t most = 0;
  while (cdf(complement(events, static_cast<double>(most))) > tail) ++most;
  return most;
}

}  // namespace evaluation
