#include "vo/map/existence.h"

#include <algorithm>
#include <cmath>

namespace vo {

double PredictScore(double score, const ScoreParams& params) {
  return params.stay_visible * score + params.become_visible * (1.0 - score);
}

double UpdateScore(double predicted_score, std::optional<double> mahalanobis_sq, const ScoreParams& params) {
  const double PD_PG = params.detection * params.gate_probability;
  double delta = PD_PG;
  if (mahalanobis_sq) {
    const double V_Lambda =
        params.gate / (2.0 * params.gate_probability) * std::exp(-0.5 * *mahalanobis_sq);  // (46)(48)
    const double N_hat = 1.0 - PD_PG * predicted_score;                                    // (47)
    delta = PD_PG * (1.0 - V_Lambda / N_hat);                                              // (45)
  }
  return std::clamp((1.0 - delta) / (1.0 - delta * predicted_score) * predicted_score, 0.0, 1.0);  // (49)
}

}  // namespace vo
