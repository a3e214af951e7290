#include "vo/frontend/adaptive_association.h"

#include <algorithm>
#include <utility>

#include "vo/frontend/image_alignment.h"

namespace vo {
namespace {

// Innovation ratio of a failed prediction, and the least agreement of the searched at the start.
constexpr double kFailedRatio = 11, kFailedAgreementAtTheStart = 0.65;
constexpr int kWidenings = 2;
constexpr double kAlignedNoise = 4;          // factor on the densities about an aligned rotation
constexpr double kAlignedSigma = 1.0 / 640;  // of an aligned rotation, of the image's width
constexpr double kRelocalisedNoise = 16;     // the same about the pose from recognised landmarks
constexpr int kLeastRecognised = 15;
constexpr double kLeastRecall = 0.4;         // of the landmarks expected from the recognised ones
constexpr double kDoubtfulAtTheStart = 0.5;  // agreement below which a wide search may change the mode
constexpr std::size_t kEnoughToBegin = 30;   // matches of that search
constexpr double kClearlyMore = 1.2;
constexpr std::size_t kClearlyMoreMatches = 3;
constexpr double kLeastMatches = 8, kLeastAgreement = 0.1, kLeastAgreementAtTheStart = 0.25;

InnovationRatios RatiosOf(const Association& association) {
  return RatiosOf(association.predicted, association.agreed);
}

double AgreementOf(const Association& association) {
  if (association.searched.empty()) return 1;
  return static_cast<double>(association.matches.size()) / static_cast<double>(association.searched.size());
}

bool Failed(const Association& association, double least_agreement) {
  const InnovationRatios ratios = RatiosOf(association);
  return std::max(ratios.position, ratios.orientation) > kFailedRatio || AgreementOf(association) < least_agreement;
}

// At the start the whole map depends on the first matches: more of the searched have to agree.
bool HasMatches(const Association& association, bool initialising) {
  const double agreement = initialising ? kLeastAgreementAtTheStart : kLeastAgreement;
  return static_cast<double>(association.matches.size()) >=
         std::max(kLeastMatches, agreement * static_cast<double>(association.searched.size()));
}

// Whether enough of the landmarks expected in a relocalised frame are matched.
bool ShowsThePlace(const Association& association) {
  return association.unseen_matched >= kLeastRecognised &&
         association.unseen_matched >= kLeastRecall * association.unseen;
}

// The best prediction of a frame so far, and its association.
struct Trial {
  Filter& filter;
  const AdaptiveAssociation::Associate& associate;
  MotionInput input;
  Association association;
  int repeated = 0;  // predictions kept after the first

  // The same with another prediction, which is kept where `better` than the present one.
  template <class Better>
  bool Repeat(const MotionInput& other, const Better& better, Search search = Search::usual) {
    filter.PredictAgain(other);
    Association again = associate(other, search);
    if (better(again)) {
      ++repeated;
      input = other;
      association = std::move(again);
      return true;
    }
    filter.PredictAgain(input);
    return false;
  }
  bool initialising() const { return filter.answer().initialising; }
  bool HasMatches() const { return vo::HasMatches(association, initialising()); }
  double matches() const { return static_cast<double>(association.matches.size()); }
  bool HasClearlyMore(const Association& again) const {
    return static_cast<double>(again.matches.size()) > kClearlyMore * matches() + kClearlyMoreMatches;
  }
};

bool HasSamePixels(const cv::Mat& a, const cv::Mat& b) {  // of one byte
  bool same = a.size() == b.size();
  for (int y = 0; same && y < a.rows; ++y) same = std::equal(a.ptr(y), a.ptr(y) + a.cols, b.ptr(y));
  return same;
}

}  // namespace

double UsualAgreement::Least(double agreement) {
  constexpr double kFailed = 0.4, kDoubtful = 0.5, kClearlyBelow = 0.8, kGain = 0.1;
  const double least = std::clamp(kClearlyBelow * usual_, kFailed, kDoubtful);
  usual_ += kGain * (agreement - usual_);
  return least;
}

MotionInput AdaptiveAssociation::Aligned(const MotionInput& input, const Eigen::Quaterniond& turn, double dt,
                                         bool initialising) const {
  MotionInput aligned = input;
  aligned.turn = turn;
  aligned.orientation_noise *= kAlignedNoise;
  if (initialising) {
    aligned.position_noise *= kAlignedNoise;
  } else {
    const double sigma = kAlignedSigma * camera_.width / camera_.fx / motion_.orientation_noise;
    aligned.orientation_noise = std::max(aligned.orientation_noise, 3 * sigma * sigma / (dt * dt * dt));  // (9)
  }
  return aligned;
}

MotionInput AdaptiveAssociation::Input(const Filter& filter, double coasting_s) {
  const Belief& belief = filter.answer().belief;
  MotionInput input = noise_.Input(belief.pose.q_WC);
  const auto psd = [](double noise, double factor) { return factor * (noise * noise); };
  if (coasting_s == 0) {
    position_time_ = VelocityTime(belief.velocity.head<3>(), psd(motion_.position_noise, input.position_noise));
    orientation_time_ =
        VelocityTime(belief.velocity.tail<3>(), psd(motion_.orientation_noise, input.orientation_noise));
  }
  input.coasting_s = coasting_s;
  input.position_time = position_time_;
  input.orientation_time = orientation_time_;
  return input;
}

void AdaptiveAssociation::Predict(Filter& filter, double dt, double coasting_s) {
  filter.Predict(dt, Input(filter, coasting_s));
}

bool AdaptiveAssociation::IsRepeated(const cv::Mat& grey) {
  constexpr int kMost = 2;  // in a row
  const bool same = HasSamePixels(grey, last_);
  repetitions_ = same ? repetitions_ + 1 : 0;
  return same && repetitions_ <= kMost;
}

Association AdaptiveAssociation::PredictAndAssociate(Filter& filter, double dt, double coasting_s, const cv::Mat& grey,
                                                     const Associate& associate, const Relocalise& relocalise) {
  const std::optional<MotionInput> known = std::exchange(begin_with_, std::nullopt);
  const MotionInput first = known ? *known : Input(filter, coasting_s);
  filter.Predict(dt, first);
  Trial trial{filter, associate, first, associate(first, Search::usual)};
  Pose predicted = trial.association.predicted.mean;  // by the motion model alone
  const double usual = usual_agreement_.Least(AgreementOf(trial.association));
  const double least = trial.initialising() ? kFailedAgreementAtTheStart : usual;
  const auto failed = [&] { return Failed(trial.association, least); };
  const auto clearly_more = [&](const Association& again) { return trial.HasClearlyMore(again); };
  const bool first_failed = known || failed();
  const auto widen = [&] {
    for (int k = 0; k < kWidenings && failed(); ++k)
      if (!trial.Repeat(Widened(trial.input, RatiosOf(trial.association)), clearly_more)) break;
  };
  const auto align = [&] {
    if (!failed() || last_.empty()) return;
    const auto R = AlignRotation(camera_, Thumbnails(last_), Thumbnails(grey));
    if (!R) return;
    trial.Repeat(Aligned(first, R->conjugate(), dt, trial.initialising()), [&](const Association& again) {
      return trial.HasClearlyMore(again) || (!trial.initialising() && !trial.HasMatches() &&  // the better prediction
                                             again.matches.size() >= trial.association.matches.size());
    });
  };
  if (trial.initialising()) {  // its velocity is not known yet
    widen();
    align();
  } else {
    align();
    widen();
  }
  if (failed() && (!trial.initialising() || AgreementOf(trial.association) < kDoubtfulAtTheStart)) {
    const auto enough = [&](const Association& again) {
      return trial.HasClearlyMore(again) && (!trial.initialising() || again.matches.size() >= kEnoughToBegin);
    };
    trial.Repeat(Widened(trial.input, RatiosOf(trial.association)), enough, Search::wide);
  }
  if (const auto recognised = relocalise(trial.association, failed())) {
    MotionInput moved = trial.input;
    moved.position_noise *= kRelocalisedNoise;
    moved.orientation_noise *= kRelocalisedNoise;
    moved.correction = recognised;
    if (trial.Repeat(moved, ShowsThePlace)) predicted = trial.association.predicted.mean;
  }
  repeated_input_ = known || trial.repeated > 0 ? std::optional(trial.input) : std::nullopt;
  trial.association.repeated = trial.repeated + (known ? 1 : 0);
  if (!trial.HasMatches()) {
    trial.association.RejectAll();
    return std::move(trial.association);
  }
  const InnovationRatios shown = RatiosOf(trial.association);
  noise_.Learn({predicted, trial.association.predicted.covariance}, trial.association.agreed, trial.input,
               first_failed || trial.repeated > 0);
  if (const auto more = Inflated(trial.input, shown)) filter.PredictAgain(*more);
  return std::move(trial.association);
}

}  // namespace vo
