#include "tools/evaluation/chi2.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace evaluation {
namespace {

constexpr double kTiny = 1e-300;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// ln of x^a e^-x / Gamma(a + 1), without the cancellation that lgamma(a) - a ln x + x has at large a.
double LogPrefactor(double a, double x) {
  if (a < 50) return a * std::log(x) - x - std::lgamma(a + 1);
  const double r = (x - a) / a;  // x = a (1 + r); Stirling: ln Gamma(a+1) = a ln a - a + ln(2 pi a)/2 + 1/(12a) - ...
  const double s = 1 / (a * a);
  const double stirling = (1.0 / 12 - s * (1.0 / 360 - s * (1.0 / 1260 - s / 1680))) / a;
  return a * (std::log1p(r) - r) - 0.5 * std::log(2 * M_PI * a) - stirling;
}

struct Tails {
  double lower = 0, upper = 0;  // P and Q of the regularised incomplete gamma function; the smaller one is accurate
};

Tails IncompleteGamma(double a, double x) {
  if (x <= 0) return {0, 1};
  const double prefactor = std::exp(LogPrefactor(a, x));
  if (x < a + 1) {
    double term = 1, sum = 1;
    for (double k = a + 1; term > sum * kEpsilon * 0.1; ++k) {
      term *= x / k;
      sum += term;
    }
    const double lower = std::min(1.0, prefactor * sum);
    return {lower, 1 - lower};
  }
  // Q(a, x) = x^a e^-x / Gamma(a) * 1/(x+1-a- 1(1-a)/(x+3-a- ...)), by Lentz's method.
  double b = x + 1 - a, c = 1 / kTiny, d = 1 / b, h = d;
  for (int i = 1; i < 1'000'000; ++i) {
    const double an = -i * (i - a);
    b += 2;
    d = an * d + b;
    if (std::abs(d) < kTiny) d = kTiny;
    c = b + an / c;
    if (std::abs(c) < kTiny) c = kTiny;
    d = 1 / d;
    const double factor = d * c;
    h *= factor;
    if (std::abs(factor - 1) < kEpsilon * 2) break;
  }
  const double upper = std::min(1.0, prefactor * a * h);
  return {1 - upper, upper};
}

// Standard normal quantile to a few digits (Abramowitz & Stegun 26.2.23): a start for Newton only.
double RoughNormalQuantile(double p) {
  const double t = std::sqrt(-2 * std::log(std::min(p, 1 - p)));
  const double z =
      t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
  return p < 0.5 ? -z : z;
}

}  // namespace

double Chi2Cdf(double x, double dof) {
  if (!(dof > 0))
    throw std::invalid_argument("Chi2Cdf: degrees of freedom must be positive, not " + std::to_string(dof));
  return IncompleteGamma(dof / 2, x / 2).lower;
}

double Chi2Quantile(double probability, double dof) {
  if (!(dof > 0) || !(probability > 0) || !(probability < 1)) {
    throw std::invalid_argument("Chi2Quantile: needs 0 < probability < 1 and positive degrees of freedom, not " +
                                std::to_string(probability) + " and " + std::to_string(dof));
  }
  const double a = dof / 2;
  const double cube = 1 - 2 / (9 * dof) + RoughNormalQuantile(probability) * std::sqrt(2 / (9 * dof));
  // Deep in the lower tail, where Wilson-Hilferty fails, P ~ (x/2)^a / Gamma(a+1) serves. In units of x/2 from here on.
  double x = a * cube * cube * cube;
  if (!(cube > 0) || probability < 1e-3) x = std::max(x, std::exp((std::log(probability) + std::lgamma(a + 1)) / a));
  if (!(x > 0)) x = a;
  double low = 0, high = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 200; ++i) {
    const Tails tails = IncompleteGamma(a, x);
    // Against the smaller tail, which has full relative accuracy.
    const double excess = probability < 0.5 ? tails.lower - probability : (1 - probability) - tails.upper;
    (excess < 0 ? low : high) = x;
    const double log_density = LogPrefactor(a, x) + std::log(a / x);
    double next = x - excess * std::exp(-log_density);
    if (!(next > low) || !(next < high)) next = std::isfinite(high) ? (low + high) / 2 : 2 * x;
    const bool settled = std::abs(next - x) <= 1e-14 * x;
    x = next;
    if (settled) break;
  }
  return 2 * x;
}

Band Chi2MeanBand(double dof, int runs, double probability) {
  if (runs < 1) throw std::invalid_argument("Chi2MeanBand: needs at least one run");
  const double m = runs;
  return {Chi2Quantile((1 - probability) / 2, dof * m) / m, Chi2Quantile((1 + probability) / 2, dof * m) / m};
}

}  // namespace evaluation
