#include "vo/frontend/exposure_estimate.h"

#include <algorithm>
#include <cmath>

#include "vo/features/motion_blur.h"

namespace vo {
namespace {

constexpr double kStep = 4e-3;      // of the candidates [s]
constexpr double kShowing = 16e-3;  // exposure at which a match has to be blurred by ...
constexpr double kLeast_px = 2, kMost_px = 12;
constexpr std::size_t kPerFrame = 16, kPerFrameOnceKnown = 4;
constexpr double kKept = 0.9985;              // of the past, from match to match
constexpr double kEnough = 30, kKnown = 200;  // matches
constexpr double kSignificant = 3;            // standard errors
constexpr double kMaxShift_px = 1.5;
constexpr double kUnlike = 0.6;  // correlation of a patch that is not registered
constexpr double kNoise = 0.02;  // of the correlation, by noise alone

}  // namespace

void ExposureEstimate::Learn(std::span<const MovingMatch> matches, std::span<const LandmarkRecord> records,
                             const cv::Mat& smooth) {
  std::vector<const MovingMatch*> showing;
  for (const MovingMatch& match : matches) {
    const RelativeBlur blur = RelativeBlur::Of(kShowing * match.first_rate, kShowing * match.rate);
    const double px = std::max(blur.of_patch.norm(), blur.of_image.norm());
    if (px > kLeast_px && px < kMost_px) showing.push_back(&match);
  }
  if (showing.empty()) return;
  const std::size_t wanted = weight_ < kKnown ? kPerFrame : kPerFrameOnceKnown;
  const std::size_t stride = (showing.size() + wanted - 1) / wanted;
  for (std::size_t i = 0; i < showing.size(); i += stride) {
    const MovingMatch& match = *showing[i];
    const Patch& sharp = records[match.landmark].appearance.patch;
    double of_none = 0;
    for (int k = 0; k < kCandidates; ++k) {
      const double exposure = k * kStep;
      const RelativeBlur blur = RelativeBlur::Of(exposure * match.first_rate, exposure * match.rate);
      const std::optional<Patch> blurred = BlurredInView(sharp, match.warp, blur.of_patch);
      const auto registered =
          Register(blurred ? *blurred : sharp, match.warp, smooth, match.pixel, kMaxShift_px, blur.of_image);
      const double correlation = registered ? std::max(kUnlike, registered->correlation) : kUnlike;
      const double loss = std::log(1 + kNoise - correlation);
      if (k == 0) of_none = loss;
      sum_[k] = kKept * sum_[k] + loss - of_none;
      squares_[k] = kKept * squares_[k] + (loss - of_none) * (loss - of_none);
    }
    weight_ = kKept * weight_ + 1;
  }
  seconds_ = 0;
  if (weight_ < kEnough) return;
  const auto best = static_cast<int>(std::ranges::min_element(sum_) - sum_.begin());
  if (-sum_[best] < kSignificant * std::sqrt(squares_[best])) return;
  seconds_ = best * kStep;
  if (best == 0 || best + 1 == kCandidates) return;
  const double before = sum_[best - 1] - sum_[best], after = sum_[best + 1] - sum_[best];
  seconds_ += 0.5 * kStep * (before - after) / (before + after);
}

}  // namespace vo
