#include "sim/sensor/response.h"

#include <algorithm>
#include <cmath>

namespace sim {

double EncodeResponse(Response response, double x) {
  if (response == Response::linear) return x;
  // Where the two pieces of Decode meet: the standard's own threshold, 0.0031308, is rounded.
  return x <= 0.04045 / 12.92 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

double ResponseCurve::Decode(Response response, double code) {
  if (response == Response::linear) return code;
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

ResponseCurve::ResponseCurve(Response response) {
  for (std::size_t i = 0; i < threshold_.size(); ++i) {
    threshold_[i] = static_cast<float>(Decode(response, (static_cast<double>(i) + 0.5) / 255));
  }
  for (std::size_t i = 0; i < guess_.size(); ++i) {
    const float x = static_cast<float>(i) / kCells;
    guess_[i] =
        static_cast<std::uint8_t>(std::upper_bound(threshold_.begin(), threshold_.end(), x) - threshold_.begin());
  }
}

}  // namespace sim
