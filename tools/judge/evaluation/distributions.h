// Distributions of test statistics: chi-square, Student's t and the binomial.
// Source: Boost.Math, to nearly all digits of a double (tested against values of forty digits). Throws
// std::invalid_argument where a distribution is not defined.
#pragma once

#include <cstddef>

namespace evaluation {

// P(X <= x) and P(X > x) of a chi-square variable with dof > 0 degrees of freedom (need not be whole); each is accurate
// where it is small. NaN of a NaN.
double Chi2Cdf(double x, double dof);
double Chi2Survival(double x, double dof);

// x with P(X <= x) = probability, 0 < probability < 1.
double Chi2Quantile(double probability, double dof);

struct Band {
  double low = 0, high = 0;
};

// Two-sided interval that the mean of `runs` independent chi-square variables of `dof` degrees falls in with
// `probability`: [q((1-probability)/2; dof*runs), q((1+probability)/2; dof*runs)] / runs. This is the ANEES band.
Band Chi2MeanBand(double dof, int runs, double probability = 0.95);

// t with P(T <= t) = probability, 0 < probability < 1, of Student's t with dof > 0 degrees of freedom.
double StudentQuantile(double probability, double dof);

// The smallest c with P(more than c of n events of probability p) <= tail; 0 <= p <= 1, tail >= 0.
std::size_t BinomialLimit(std::size_t n, double p, double tail);

}  // namespace evaluation
