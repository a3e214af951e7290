#include "tools/judge/evaluation/distributions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace evaluation {
namespace {

// Reference values of 40 digits: bisection on the regularised incomplete gamma function in arbitrary precision.
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
  // Cancellation in 1 - probability: 1e-8 with 8 digits.
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

// Distribution function for even degrees of freedom: P(X > x) = e^(-x/2) sum (x/2)^k / k!.
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

// Upper tail where 1 - P cancels: e^(-x/2) for two degrees of freedom.
TEST(Chi2Survival, IsAccurateFarOut) {
  for (const double x : {1.0, 10.0, 100.0, 1000.0}) {
    EXPECT_NEAR(Chi2Survival(x, 2) / std::exp(-x / 2), 1, 1e-13) << x;
    EXPECT_NEAR(Chi2Survival(x, 7) + Chi2Cdf(x, 7), 1, 1e-15) << x;
  }
}

TEST(Chi2, RefusesNonsense) {
  EXPECT_THROW(Chi2Quantile(0, 3), std::invalid_argument);
  EXPECT_THROW(Chi2Quantile(1, 3), std::invalid_argument);
  EXPECT_THROW(Chi2Quantile(0.5, 0), std::invalid_argument);
  EXPECT_THROW(Chi2Cdf(1, -1), std::invalid_argument);
  EXPECT_THROW(Chi2MeanBand(3, 0), std::invalid_argument);
  EXPECT_THROW(Chi2Cdf(1, 0), std::invalid_argument);
  EXPECT_THROW(Chi2Survival(1, 0), std::invalid_argument);
  EXPECT_THROW(Chi2Cdf(1, INFINITY), std::invalid_argument);
  EXPECT_NO_THROW(Chi2MeanBand(3, 1));
  for (const double x : {-1.0, 0.0, static_cast<double>(-INFINITY)}) {
    EXPECT_EQ(Chi2Cdf(x, 3), 0);
    EXPECT_EQ(Chi2Survival(x, 3), 1);
  }
  EXPECT_EQ(Chi2Cdf(INFINITY, 3), 1);
  EXPECT_EQ(Chi2Survival(INFINITY, 3), 0);
  EXPECT_TRUE(std::isnan(Chi2Cdf(NAN, 3)));
  EXPECT_TRUE(std::isnan(Chi2Survival(NAN, 3)));
}

// Reference values of 40 digits: bisection on the incomplete beta function; closed forms for one and two degrees of
// freedom.
TEST(StudentQuantile, AgreesWithFortyDigits) {
  for (const double p : {0.001, 0.3, 0.9, 0.995}) {
    EXPECT_NEAR(StudentQuantile(p, 1) / std::tan(M_PI * (p - 0.5)), 1, 1e-12) << p;
    EXPECT_NEAR(StudentQuantile(p, 2) / ((2 * p - 1) / std::sqrt(2 * p * (1 - p))), 1, 1e-12) << p;
  }
  const struct {
    double dof, probability, quantile;
  } table[] = {
      {5, 0.975, 2.5705818356363148},  {9, 0.995, 3.2498355415921257},   {19, 0.025, -2.0930240544083097},
      {99, 0.995, 2.6264054572808272}, {3.5, 0.9995, 10.20482863165621}, {1000, 0.6, 0.25341451583949871},
  };
  for (const auto& row : table)
    EXPECT_NEAR(StudentQuantile(row.probability, row.dof) / row.quantile, 1, 1e-12)
        << row.dof << " " << row.probability;
  EXPECT_EQ(StudentQuantile(0.5, 10), 0);
  EXPECT_THROW(StudentQuantile(0.5, 0), std::invalid_argument);
  EXPECT_THROW(StudentQuantile(0, 10), std::invalid_argument);
  EXPECT_THROW(StudentQuantile(1, 10), std::invalid_argument);
}

TEST(BinomialLimit, AgreesWithTheSums) {
  // n = 3, p = 0.5: P(> 2) = 1/8, P(> 1) = 1/2.
  EXPECT_EQ(BinomialLimit(3, 0.5, 0.6), 1u);
  EXPECT_EQ(BinomialLimit(3, 0.5, 0.2), 2u);
  EXPECT_EQ(BinomialLimit(3, 0.5, 0.1), 3u);
  EXPECT_EQ(BinomialLimit(100, 0.05, 0.01), 11u);  // P(> 10) = 0.0115, P(> 11) = 0.0043
  EXPECT_EQ(BinomialLimit(20, 0.05, 0.01), 4u);    // this and the next: SciPy's binom.sf
  EXPECT_EQ(BinomialLimit(7, 0.3, 0.05), 4u);
  EXPECT_EQ(BinomialLimit(50, 0.5, 0.001), 36u);
  EXPECT_EQ(BinomialLimit(0, 0.05, 0.01), 0u);
  EXPECT_EQ(BinomialLimit(5, 0, 0), 0u);
  EXPECT_EQ(BinomialLimit(5, 1, 0.5), 5u);
  EXPECT_THROW(BinomialLimit(5, -0.1, 0.5), std::invalid_argument);
  EXPECT_THROW(BinomialLimit(5, 1.1, 0.5), std::invalid_argument);
  EXPECT_THROW(BinomialLimit(5, 0.5, -0.1), std::invalid_argument);
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
