#include "tests/consistency/own_model.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "sim/points/point_world.h"
#include "source_dir.h"
#include "tools/bench/points/point_bound.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/experiment.h"
#include "tools/bench/systems/prior.h"
#include "tools/bench/tracking/verdict_recorder.h"
#include "vo/point_odometry.h"

namespace own_model {
namespace {

using namespace vobench;

Overrides Setting(const Overrides& more) {
  Overrides all = {{"world.points.count", "12"},
                   {"time.duration", "333 ms"},
                   {"trajectory.position_noise", "0.6"},
                   {"trajectory.orientation_noise", "0.4"},
                   {"odometry.motion.position_noise", "0.6"},
                   {"odometry.motion.orientation_noise", "0.4"},
                   {"odometry.filter.particles", "128"},
                   {"odometry.filter.lag", "3"},
                   {"odometry.filter.weight", "evidence"},
                   {"odometry.filter.marginal_mode", "true"}};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

// Scales the covariance of estimate and mixture about the mean.
void Scale(double factor, vo::Estimate& estimate, std::vector<vo::BeliefComponent>& mixture) {
  if (factor == 1) return;
  estimate.covariance *= factor;
  const double root = std::sqrt(factor);
  for (vo::BeliefComponent& component : mixture) {
    component.pose = vo::Plus(estimate.pose, root * vo::Minus(component.pose, estimate.pose));
    component.velocity.head<3>() = estimate.v_WC + root * (component.velocity.head<3>() - estimate.v_WC);
    component.velocity.tail<3>() = estimate.w_WC_C + root * (component.velocity.tail<3>() - estimate.w_WC_C);
    component.covariance *= factor;
  }
}

}  // namespace

struct Played {
  std::uint64_t seed = 0;
  std::vector<vo::Estimate> estimates;
  std::vector<std::vector<vo::BeliefComponent>> mixtures;
  std::vector<sim::Truth> truth;
  evaluation::LinearisedRuns exact;
};

namespace {

Played PlayOne(const Experiment& experiment, std::uint64_t seed) {
  Played played;
  played.seed = seed;
  sim::Scenario scenario = experiment.scenario;
  scenario.seed = seed;
  sim::PointWorld world(scenario);
  const vo::Prior prior = PriorOf(experiment.prior, world, seed);
  vo::PointOdometry odometry(ToOdometry(world.camera().params()), experiment.odometry, prior, seed);
  std::vector<sim::PointFrame> frames;
  while (const auto frame = world.Next()) {
    played.estimates.push_back(odometry.Track(ToOdometry(*frame)));
    played.mixtures.push_back(odometry.Mixture());
    played.truth.push_back(frame->truth);
    frames.push_back(*frame);
  }
  played.exact = evaluation::SimulateLinearised(ProblemOf(world, frames, StartCovariance(prior)), 10, seed);
  return played;
}

evaluation::VerdictRun JudgedAs(const Played& played, const Tampering& tampering) {
  VerdictRecorder recorder(RankFrames(played.estimates.size(), 30));
  evaluation::EstimateRun run;
  Truth truth;
  for (std::size_t k = 0; k < played.estimates.size(); ++k) {
    vo::Estimate estimate = played.estimates[k];
    std::vector<vo::BeliefComponent> mixture = played.mixtures[k];
    Scale(tampering.covariance, estimate, mixture);
    recorder.Add(estimate, mixture);
    run.trajectory.push_back({estimate.stamp_ns, estimate.pose.p_WC, estimate.pose.q_WC});
    run.beliefs.push_back({{estimate.stamp_ns, estimate.v_WC, estimate.w_WC_C}, estimate.covariance});
    const auto late = static_cast<std::size_t>(tampering.delay);
    Append(estimate.stamp_ns, played.truth[k < late ? 0 : k - late], truth);
  }
  const std::vector<evaluation::FrameConsistency> frames =
      evaluation::ComputeConsistency(run, truth.poses, truth.velocities, evaluation::AssociationOptions().gap_ns);
  std::vector<evaluation::Vector12d> errors;
  for (const auto& frame : frames) errors.push_back(frame.error);
  evaluation::VerdictRun judged = recorder.Finish(errors, NeesByBlock(run, frames), played.seed);
  for (std::size_t k = 0; k < judged.size(); ++k) judged[k].bound = played.exact.bound[k];
  return judged;
}

}  // namespace

vobench::Overrides WithoutDelay() {
  return {{"time.duration", "100 ms"}, {"odometry.filter.lag", "0"}, {"odometry.filter.particles", "128"}};
}

Runs Play(int runs, const Overrides& settings, std::uint64_t first_seed) {
  const Experiment experiment = ReadExperiment(VOBENCH_SOURCE_DIR "/scenes/points.yaml", Setting(settings));
  auto all = std::make_shared<std::vector<Played>>();
  for (int run = 0; run < runs; ++run) {
    all->push_back(PlayOne(experiment, first_seed + static_cast<std::uint64_t>(run)));
  }
  return all;
}

evaluation::ConsistencyVerdict Judge(const Runs& runs, const Tampering& tampering) {
  std::vector<evaluation::VerdictRun> judged;
  std::vector<evaluation::LinearisedRuns> exact;
  for (const Played& played : *runs) {
    judged.push_back(JudgedAs(played, tampering));
    exact.push_back(played.exact);
  }
  evaluation::VerdictOptions options = VerdictOptionsFor(RankFrames(runs->front().estimates.size(), 30), exact);
  options.false_alarm = kFalseAlarm;
  options.trials = 2000;
  return evaluation::JudgeConsistency(judged, options);
}

bool PassesButCoverage(const evaluation::ConsistencyVerdict& verdict) {
  return std::all_of(verdict.checks.begin(), verdict.checks.end(), [](const evaluation::Check& check) {
    return check.pass || check.name.starts_with("RMSE / bound") || check.name.starts_with("coverage");
  });
}

std::string Failures(const evaluation::ConsistencyVerdict& verdict, bool all) {
  std::ostringstream text;
  for (const evaluation::Check& check : verdict.checks) {
    if (check.pass && !all) continue;
    text << "  " << (check.pass ? "pass " : "FAIL ") << check.name << ' ' << check.value
         << (check.at_least ? " >= " : " <= ") << check.threshold << '\n';
  }
  return text.str();
}

}  // namespace own_model
