#include "tools/evaluation/chi2.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace evaluation {
namespace {

// Computed with 40 digits (bisection on the regularised incomplete gamma function in arbitrary precision).
TEST(Chi2Quantile, AgreesWithFortyDigits) {
  const struct {
    double dof, probability, quantile;
  } table[] = {
      {1, 0.025, 0.00098206911717525591}, {1, 0.5, 0.45493642311957275},    {1, 0.999, 10.827566170662732},
      {2, 0.95, 5.991464547107982},       {3, 0.5, 2.3659738843753383},     {3, 0.025, 0.21579528262389787},
      {3, 0.975, 9.3484036044961478},     {5, 0.025, 0.83121161348666242},  {5, 0.975, 12.832501994030028},
      {6, 1e-9, 0.0036358932000540313},   {6, 0.025, 1.2373442457912026},   {6, 0.975, 14.449375335447922},
      {11, 0.025, 3.8157482522360986},    {11, 0.975, 21.920049261021208},  {12, 0.025, 4.4037885069817016},
      {12, 0.975, 23.336664158645339},    {401, 0.025, 347.41248488086715}, {12000, 0.975, 12305.526158142953},
  };
  for (const auto& row : table) {
    EXPECT_NEAR(Chi2Quantile(row.probability, row.dof) / row.quantile, 1, 1e-11) << row.dof << " " << row.probability;
  }
  // 1 - probability is all that is left of the argument up here: 1e-8 with 8 digits.
  EXPECT_NEAR(Chi2Quantile(0.99999999, 99) / 199.23814234317295, 1, 1e-9);
}

TEST(Chi2Quantile, HasTheClosedFormOfTwoDegrees) {
  for (double p = 1e-6; p < 1; p = p < 0.1 ? p * 3 : p + 0.07) {
    EXPECT_NEAR(Chi2Quantile(p, 2) / (-2 * std::log1p(-p)), 1, 1e-12) << p;
  }
}

TEST(Chi2Quantile, IsTheInverseOfTheProbability) {
  for (const double dof : {0.5, 1.0, 3.0, 6.0, 12.0, 99.0, 100.0, 101.0, 400.0, 5000.0, 1e5}) {
    for (const double p : {1e-6, 1e-3, 0.025, 0.3, 0.5, 0.7, 0.975, 0.999}) {
      EXPECT_NEAR(Chi2Cdf(Chi2Quantile(p, dof), dof) / p, 1, 1e-9) << dof << " " << p;
    }
  }
}

// The probability function against the sum that it is for even degrees: P(X > x) = e^(-x/2) sum (x/2)^k / k!.
TEST(Chi2Cdf, IsThePoissonSumForEvenDegrees) {
  for (const int dof : {2, 6, 12, 60, 200}) {
    for (double x = 0.05 * dof; x < 3 * dof; x *= 1.3) {
      long double term = 1, sum = 1;
      for (int k = 1; k < dof / 2; ++k) sum += term *= static_cast<long double>(x) / 2 / k;
      const double expected = static_cast<double>(1 - std::exp(-static_cast<long double>(x) / 2) * sum);
      EXPECT_NEAR(Chi2Cdf(x, dof), expected, 1e-13) << dof << " " << x;
    }
  }
}

TEST(Chi2, RefusesNonsense) {
  EXPECT_THROW(Chi2Quantile(0, 3), std::invalid_argument);
  EXPECT_THROW(Chi2Quantile(1, 3), std::invalid_argument);
  EXPECT_THROW(Chi2Quantile(0.5, 0), std::invalid_argument);
  EXPECT_THROW(Chi2Cdf(1, -1), std::invalid_argument);
  EXPECT_THROW(Chi2MeanBand(3, 0), std::invalid_argument);
  EXPECT_EQ(Chi2Cdf(0, 3), 0);
  EXPECT_EQ(Chi2Cdf(-1, 3), 0);
}

// The two-sided 95 % bands of docs/metrics.md, to the digits printed there.
TEST(Chi2MeanBand, GivesTheTableOfTheManual) {
  const int runs[] = {1, 10, 25, 50, 100, 500, 1000};
  const struct {
    int dof;
    double band[7][2];
  } table[] = {
      {3,
       {{.216, 9.348}, {1.679, 4.698}, {2.118, 4.034}, {2.360, 3.716}, {2.539, 3.499}, {2.789, 3.218}, {2.850, 3.154}}},
      {6,
       {{1.237, 14.449},
        {4.048, 8.330},
        {4.719, 7.432},
        {5.078, 6.997},
        {5.340, 6.698},
        {5.700, 6.307},
        {5.787, 6.217}}},
      {9,
       {{2.700, 19.023},
        {6.565, 11.814},
        {7.414, 10.738},
        {7.862, 10.213},
        {8.188, 9.850},
        {8.632, 9.376},
        {8.739, 9.265}}},
      {12,
       {{4.404, 23.337},
        {9.157, 15.221},
        {10.156, 13.995},
        {10.680, 13.395},
        {11.059, 12.979},
        {11.574, 12.433},
        {11.698, 12.306}}},
  };
  for (const auto& row : table) {
    for (int i = 0; i < 7; ++i) {
      const Band band = Chi2MeanBand(row.dof, runs[i]);
      EXPECT_NEAR(band.low, row.band[i][0], 0.00050001) << row.dof << " " << runs[i];
      EXPECT_NEAR(band.high, row.band[i][1], 0.00050001) << row.dof << " " << runs[i];
    }
  }
}

}  // namespace
}  // namespace evaluation
