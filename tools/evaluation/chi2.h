// Purpose: the chi-square distribution: its probability function and quantiles.
// Source:  regularised incomplete gamma function by series and continued fraction; quantile by safeguarded Newton steps
// from the
//          Wilson-Hilferty approximation. Relative error below 1e-9 (tested against tables and the exact dof = 2 form).
#pragma once

namespace evaluation {

// P(X <= x) of a chi-square variable with dof > 0 degrees of freedom (need not be whole).
double Chi2Cdf(double x, double dof);

// x with P(X <= x) = probability, 0 < probability < 1. Throws std::invalid_argument outside.
double Chi2Quantile(double probability, double dof);

struct Band {
  double low = 0, high = 0;
};

// Two-sided interval that the mean of `runs` independent chi-square variables of `dof` degrees falls in with
// `probability`: [q((1-probability)/2; dof*runs), q((1+probability)/2; dof*runs)] / runs. This is the ANEES band.
Band Chi2MeanBand(double dof, int runs, double probability = 0.95);

}  // namespace evaluation
