#include "tools/bench/tracking/verdict_recorder.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vo/filter/pose_gaussian.h"
#include "vo/geometry/so3.h"

namespace vobench {

std::vector<std::size_t> RankFrames(std::size_t frames, double rate_hz) {
  if (frames < 2) return {};
  const auto last = static_cast<double>(frames - 1);
  const double count = std::clamp(std::floor(last / rate_hz + 0.5), 1.0, 10.0);
  std::vector<std::size_t> chosen;
  for (double i = 1; i <= count; ++i) chosen.push_back(static_cast<std::size_t>(std::lround(last * i / count)));
  return chosen;
}

evaluation::Mixture MixtureAbout(const vo::Estimate& estimate, const std::vector<vo::BeliefComponent>& mixture) {
  evaluation::Mixture about;
  for (const vo::BeliefComponent& component : mixture) {
    evaluation::Vector12d offset;
    offset << vo::Minus(component.pose, estimate.pose), component.velocity.head<3>() - estimate.v_WC,
        component.velocity.tail<3>() - estimate.w_WC_C;
    evaluation::Matrix12d J = evaluation::Matrix12d::Identity();  // from the tangent space at the component
    J.block<3, 3>(3, 3) = vo::InverseRightJacobian(offset.segment<3>(3));
    about.push_back({component.weight, offset, J * component.covariance * J.transpose()});
  }
  return about;
}

void VerdictRecorder::Add(const vo::Estimate& estimate, const std::vector<vo::BeliefComponent>& mixture) {
  Frame& frame = frames_.emplace_back();
  frame.nis = estimate.diagnostics.nis;
  frame.nis_dof = estimate.diagnostics.nis_dof;
  if (mixture.empty()) return;  // before the first update
  double squares = 0;
  for (const vo::BeliefComponent& component : mixture) squares += component.weight * component.weight;
  frame.effective_components = 1 / squares;
  if (std::find(rank_frames_.begin(), rank_frames_.end(), frames_.size() - 1) != rank_frames_.end()) {
    frame.mixture = MixtureAbout(estimate, mixture);
  }
}

evaluation::VerdictRun VerdictRecorder::Finish(const std::vector<evaluation::Vector12d>& errors,
                                               const std::vector<BlockNees>& nees, std::uint64_t seed) const {
  if (errors.size() != frames_.size() || nees.size() != frames_.size()) {
    throw std::invalid_argument("VerdictRecorder: errors of " + std::to_string(errors.size()) + " and NEES of " +
                                std::to_string(nees.size()) + " frames, of " + std::to_string(frames_.size()));
  }
  constexpr int kDraws = 99;  // ranks 0 ... 99
  evaluation::VerdictRun run;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    const Frame& frame = frames_[k];
    evaluation::JudgedFrame& judged = run.emplace_back();
    if (!frame.mixture.empty()) {
      judged.scores = evaluation::ScoreMixture(frame.mixture, errors[k], seed << 32 | k, kDraws);
    }
    judged.error = errors[k];
    judged.scores.nees = nees[k];
    judged.scores.effective_components = frame.effective_components;
    judged.nis = frame.nis;
    judged.nis_dof = frame.nis_dof;
    if (frame.nis_dof > 0) judged.innovation = (frame.nis - frame.nis_dof) / std::sqrt(2.0 * frame.nis_dof);
  }
  return run;
}

evaluation::VerdictOptions VerdictOptionsFor(std::vector<std::size_t> rank_frames,
                                             std::span<const evaluation::LinearisedRuns> linearised) {
  evaluation::VerdictOptions options;
  options.linearised = linearised;
  options.rank_frames = std::move(rank_frames);
  return options;
}

}  // namespace vobench
