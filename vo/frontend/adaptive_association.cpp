#include "vo/frontend/adaptive_association.h"

#include <algorithm>
#include <utility>

#include "vo/frontend/image_alignment.h"

namespace vo {
namespace {

constexpr double kFailedRatio = 4;        // innovation ratio of a failed prediction
constexpr double kFailedAgreement = 0.4;  // fewer of the searched agree
constexpr int kWidenings = 2;
constexpr double kAlignedNoise = 4;  // factor on the densities about an aligned rotation
constexpr double kClearlyMore = 1.2;
constexpr std::size_t kClearlyMoreMatches = 3;
constexpr double kLeastMatches = 8, kLeastAgreement = 0.1, kLeastAgreementAtTheStart = 0.25;

InnovationRatios RatiosOf(const Association& association) {
  return RatiosOf(association.predicted, association.agreed);
}

bool Failed(const Association& association) {
  const InnovationRatios ratios = RatiosOf(association);
  return std::max(ratios.position, ratios.orientation) > kFailedRatio ||
         static_cast<double>(association.matches.size()) <
             kFailedAgreement * static_cast<double>(association.searched.size());
}

// The whole map follows from the first matches: at the start more of the searched have to agree.
bool HasMatches(const Association& association, bool initialising) {
  const double agreement = initialising ? kLeastAgreementAtTheStart : kLeastAgreement;
  return static_cast<double>(association.matches.size()) >=
         std::max(kLeastMatches, agreement * static_cast<double>(association.searched.size()));
}

}  // namespace

bool AdaptiveAssociation::Repeat(Filter& filter, const MotionInput& repeated,
                                 const std::function<Association(const MotionInput&)>& associate, MotionInput& input,
                                 Association& association) const {
  filter.PredictAgain(repeated);
  Association again = associate(repeated);
  const auto before = static_cast<double>(association.matches.size());
  if (static_cast<double>(again.matches.size()) > kClearlyMore * before + kClearlyMoreMatches) {
    input = repeated;
    association = std::move(again);
    return true;
  }
  filter.PredictAgain(input);
  return false;
}

Association AdaptiveAssociation::PredictAndAssociate(Filter& filter, double dt, double coasting_s, const cv::Mat& grey,
                                                     const std::function<Association(const MotionInput&)>& associate) {
  MotionInput input = noise_.Input();
  input.coasting_s = coasting_s;
  filter.Predict(dt, input);
  Association association = associate(input);
  int repeated = 0;
  for (int k = 0; k < kWidenings && Failed(association); ++k) {
    ++repeated;
    if (!Repeat(filter, Widened(input, RatiosOf(association)), associate, input, association)) break;
  }
  if (Failed(association) && !matched_.empty()) {
    if (const auto R = AlignRotation(camera_, Thumbnails(matched_), Thumbnails(grey))) {
      MotionInput aligned = input;
      aligned.position_noise *= kAlignedNoise;
      aligned.orientation_noise *= kAlignedNoise;
      aligned.turn = R->conjugate();
      ++repeated;
      Repeat(filter, aligned, associate, input, association);
    }
  }
  association.repeated = repeated;
  if (HasMatches(association, filter.answer().initialising)) {
    noise_.Learn(RatiosOf(association), input);
    grey.copyTo(matched_);  // the memory is the caller's
  } else {
    association.RejectAll();
  }
  return association;
}

}  // namespace vo
