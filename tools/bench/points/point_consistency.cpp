#include "tools/bench/points/point_consistency.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "tools/base/settings/fields.h"
#include "tools/bench/points/point_bound.h"

namespace vobench {
namespace {

constexpr int kExactRuns = 10;  // of each world, as the reference of the verdict

void Check(const ConsistencyOptions& options) {
  settings::FieldCheck check;
  check.Require(options.runs >= 10, "runs", options.runs, "must be 10 or more");
  check.Require(options.false_alarm > 0 && options.false_alarm < 0.5, "false_alarm", options.false_alarm,
                "must be above 0 and below 0.5");
  if (!check.problems.empty()) throw std::invalid_argument(settings::Join(check.problems, "\n"));
}

// A covariance that is not positive definite has no scores: JudgeConsistency counts it as a frame without a belief.
evaluation::MixtureScores Scores(const evaluation::Vector12d& error, const evaluation::Matrix12d& covariance,
                                 const BlockNees& nees, std::uint64_t stream) {
  evaluation::MixtureScores scores;
  if (!std::isnan(nees.back())) {
    scores = evaluation::ScoreMixture({{1, Eigen::VectorXd::Zero(12), covariance}}, error, stream);
  }
  scores.nees = nees;
  return scores;
}

}  // namespace

evaluation::ConsistencyVerdict TestConsistency(const sim::Scenario& scenario, const MakePointFilter& make,
                                               const ConsistencyOptions& options) {
  Check(options);
  std::vector<evaluation::VerdictRun> runs;
  std::vector<evaluation::LinearisedRuns> exact;
  for (std::uint64_t seed = options.seed; runs.size() < static_cast<std::size_t>(options.runs); ++seed) {
    sim::Scenario of_seed = scenario;
    of_seed.seed = seed;
    sim::PointWorld world(of_seed);
    const PointPlay play = Play(world, make(world));
    exact.push_back(evaluation::SimulateLinearised(
        ProblemOf(world, play.frames, play.estimates.beliefs.front().covariance), kExactRuns, seed));
    const std::vector<evaluation::FrameConsistency> frames = ConsistencyOf(play);
    const std::vector<BlockNees> nees = NeesByBlock(play.estimates, frames);
    evaluation::VerdictRun& run = runs.emplace_back();
    for (std::size_t k = 0; k < frames.size(); ++k) {
      evaluation::JudgedFrame& judged = run.emplace_back();
      judged.error = frames[k].error;
      judged.scores = Scores(judged.error, play.estimates.beliefs[k].covariance, nees[k], seed << 32 | k);
      judged.bound = exact.back().bound[k];
    }
  }
  evaluation::VerdictOptions how;
  how.false_alarm = options.false_alarm;
  how.trials = std::max(how.trials, static_cast<int>(std::ceil(2 / options.false_alarm)));
  how.linearised = exact;
  return evaluation::JudgeConsistency(runs, how);
}

std::string FailedChecks(const evaluation::ConsistencyVerdict& verdict) {
  std::ostringstream text;
  text.precision(4);
  for (const evaluation::Check& check : verdict.checks) {
    if (check.pass || check.name.starts_with("RMSE / bound")) continue;
    text << check.name << ": " << check.value << ", not " << (check.at_least ? ">= " : "<= ") << check.threshold
         << "\n";
  }
  return text.str();
}

}  // namespace vobench
