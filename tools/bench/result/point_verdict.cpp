#include "tools/bench/result/point_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/base/text.h"
#include "tools/bench/report/text.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/geometry/so3.h"

namespace vobench {
namespace {

constexpr int kDraws = 99;       // ranks 0 ... 99
constexpr double kTail = 0.025;  // of an honest bar, on either side of its band

std::string Threshold(const evaluation::Check& check) {
  return fmt::format("{} {}", check.at_least ? ">=" : "<=", report::Readable(check.threshold));
}

// "ANEES position 2.4 (an exact filter's: 0.86 to 1.16)", worst first.
std::vector<std::string> OutOfBand(const evaluation::ConsistencyVerdict& verdict, bool above) {
  std::vector<std::pair<double, std::string>> found;
  for (std::size_t b = 0; b < verdict.anees.size(); ++b) {
    const evaluation::AneesVerdict& anees = verdict.anees[b];
    const double mean = anees.measured.mean;
    if (above ? mean <= anees.mean_high : mean >= anees.mean_low) continue;
    found.emplace_back(above ? -mean : mean, fmt::format("ANEES of {} {} (an exact filter's: {:.2f} to {:.2f})",
                                                         evaluation::kStateBlocks[b].name, report::Readable(mean),
                                                         anees.mean_low, anees.mean_high));
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> texts;
  for (auto& [key, text] : found) texts.push_back(std::move(text));
  return texts;
}

}  // namespace

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

evaluation::JudgedRun VerdictRecorder::Finish(const std::vector<evaluation::Vector12d>& errors,
                                              const std::vector<BlockNees>& nees, std::uint64_t seed) const {
  if (errors.size() != frames_.size() || nees.size() != frames_.size()) {
    throw std::invalid_argument("VerdictRecorder: errors of " + std::to_string(errors.size()) + " and NEES of " +
                                std::to_string(nees.size()) + " frames, of " + std::to_string(frames_.size()));
  }
  evaluation::JudgedRun run;
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
  options.nis_by_feature = true;
  return options;
}

std::string VerdictSentence(const std::string& system, const std::string& setting,
                            const evaluation::ConsistencyVerdict& verdict) {
  const std::string name = report::DisplayName(system);
  std::vector<std::string> failed;
  for (const evaluation::Check& check : verdict.checks) {
    if (!check.pass && !check.name.starts_with("RMSE / bound")) failed.push_back(check.name);
  }
  if (failed.empty()) {
    return fmt::format("{} is consistent with its own model at {}.", name, setting);
  }
  const auto join = [](std::vector<std::string> texts) {
    const std::string more = texts.size() > 3 ? fmt::format(" and {} more", texts.size() - 3) : "";
    texts.resize(std::min<std::size_t>(texts.size(), 3));
    return base::Join(texts, ", ") + more;
  };
  const auto above = OutOfBand(verdict, true), below = OutOfBand(verdict, false);
  if (!above.empty() && below.empty())
    return fmt::format("{} is over-confident at {}: {}.", name, setting, join(above));
  if (above.empty() && !below.empty()) return fmt::format("{} is timid at {}: {}.", name, setting, join(below));
  return fmt::format("{} is not consistent with its own model at {}: {} failed.", name, setting, join(failed));
}

std::string VerdictTable(const std::string& system, const std::string& setting, std::size_t runs, std::size_t frames,
                         const evaluation::ConsistencyVerdict& verdict) {
  std::string text = fmt::format("\n{} at {}: consistency over {} runs of {} frames\n", report::DisplayName(system),
                                 setting, runs, frames);
  text += fmt::format("{:<34}{:>10}{:>14}  {:<6}{:>12}\n", "check", "value", "threshold", "", "false alarm");
  for (const evaluation::Check& check : verdict.checks) {
    text += fmt::format("{:<34}{:>10}{:>14}  {:<6}{:>12}\n", check.name, report::Readable(check.value),
                        Threshold(check), check.pass ? "pass" : "FAIL",
                        check.false_alarm > 0 ? fmt::format("{:.0f} %", 100 * check.false_alarm) : "-");
  }
  if (verdict.nis_mean) {
    text += fmt::format("NIS / dof {:.4f} +- {:.4f} over {} runs", verdict.nis_mean->per_dof,
                        verdict.nis_mean->standard_error, verdict.nis_mean->runs);
  }
  if (verdict.whiteness && !verdict.whiteness->mean_autocorrelation.empty()) {
    text += fmt::format("; its autocorrelation at one frame {:+.3f}", verdict.whiteness->mean_autocorrelation.front());
  }
  text += fmt::format(
      "\nEnergy score [cm, deg, cm/s, deg/s]: {:.3f}, {:.4f}, {:.3f}, {:.3f}; effective components {:.1f}\n",
      100 * verdict.energy[0], 180 / M_PI * verdict.energy[1], 100 * verdict.energy[2], 180 / M_PI * verdict.energy[3],
      verdict.effective_components);
  text += fmt::format("An honest filter fails one of these checks in at most {:.0f} % of such tables.\n",
                      100 * verdict.false_alarm());
  return text + VerdictSentence(system, setting, verdict) + "\n";
}

std::vector<report::RankTable> RankTables(const std::string& system, const std::vector<std::size_t>& rank_frames,
                                          const evaluation::ConsistencyVerdict& verdict) {
  constexpr std::size_t kDimensions = 12;
  std::vector<report::RankTable> tables;
  for (std::size_t i = 0; i < verdict.rank_histograms.size(); ++i) {
    const evaluation::RankHistogram& histogram = verdict.rank_histograms[i];
    if (histogram.runs == 0) continue;
    const std::size_t dimension = i % kDimensions;
    report::RankTable& table = tables.emplace_back();
    table.system = system;
    table.frame = rank_frames.at(i / kDimensions);
    table.dimension = fmt::format("{} {}", evaluation::kStateBlocks[dimension / 3].name, "xyz"[dimension % 3]);
    table.p_value = histogram.p_value;
    for (std::size_t bar = 0; bar < histogram.counts.size(); ++bar) {
      const double share = histogram.shares[bar];
      const auto runs = static_cast<std::size_t>(histogram.runs);
      table.counts.push_back(histogram.counts[bar]);
      table.low.push_back(static_cast<double>(runs - evaluation::BinomialLimit(runs, 1 - share, kTail)));
      table.high.push_back(static_cast<double>(evaluation::BinomialLimit(runs, share, kTail)));
    }
  }
  return tables;
}

std::string VerdictCsv(const std::string& system, const evaluation::ConsistencyVerdict& verdict) {
  std::string text;
  for (const evaluation::Check& check : verdict.checks) {
    text += fmt::format("{},\"{}\",{:.6g},{},{:.6g},{},{:.6g}\n", system, check.name, check.value,
                        check.at_least ? ">=" : "<=", check.threshold, check.pass ? "pass" : "fail", check.false_alarm);
  }
  return text;
}

}  // namespace vobench
