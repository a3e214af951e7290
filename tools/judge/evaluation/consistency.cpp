#include "tools/judge/evaluation/consistency.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <stdexcept>

#include "tools/judge/evaluation/association.h"
#include "tools/judge/evaluation/ate.h"
#include "tools/judge/evaluation/so3.h"

namespace evaluation {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// Smallest pivot, of the matrix of correlations, that counts as positive.
constexpr double kPivot = 1e-12;

// P^-1 b for the columns of b; none when P is not positive definite. Solved on the correlations, whose pivots have no
// unit.
std::optional<Eigen::MatrixXd> Solve(const Eigen::MatrixXd& P, const Eigen::MatrixXd& b) {
  if (!P.allFinite()) return std::nullopt;
  const Eigen::VectorXd weight = P.diagonal().cwiseSqrt().cwiseInverse();  // not finite for a variance <= 0
  const Eigen::MatrixXd correlation = weight.asDiagonal() * P * weight.asDiagonal();
  const Eigen::LDLT<Eigen::MatrixXd> factors(correlation);
  if (!(factors.vectorD().array() > kPivot).all()) return std::nullopt;
  return weight.asDiagonal() * factors.solve(Eigen::MatrixXd(weight.asDiagonal() * b));
}

}  // namespace

double Nees(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  const auto solved = Solve(covariance, error);
  return solved ? error.dot(solved->col(0)) : kNaN;
}

double NeesWithoutDirection(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance,
                            const Eigen::VectorXd& direction) {
  Eigen::MatrixXd both(error.size(), 2);
  both << error, direction;
  const auto solved = Solve(covariance, both);
  if (!solved) return kNaN;
  const double gg = direction.dot(solved->col(1)), eg = error.dot(solved->col(1));
  if (!(gg > 0)) return kNaN;
  return std::max(0.0, error.dot(solved->col(0)) - eg * eg / gg);
}

std::vector<FrameConsistency> ComputeConsistency(const EstimateRun& run, const Trajectory& truth,
                                                 const std::optional<Velocities>& truth_velocities, std::int64_t gap_ns,
                                                 Gauge gauge) {
  const Trajectory& answers = run.answers();
  const AssociationOptions association{AssociationRule::one_to_one, gap_ns};
  // Moves the truth into the estimate's world: the two are exchanged.
  const Similarity to_estimate =
      gauge == Gauge::as_is ? Similarity{} : Align(MatchTrajectories(truth, answers, association), Alignment::first);
  std::vector<FrameConsistency> frames;
  const auto matches = Associate(StampsOf(answers), StampsOf(truth), association);
  if (matches.empty()) return frames;
  const Eigen::Vector3d true_start = Apply(to_estimate, truth[matches.front().truth]).p_WC;
  for (const Match& match : matches) {
    const StampedPose& estimate = answers[match.estimate];
    const auto found = std::ranges::lower_bound(run.beliefs, estimate.stamp_ns, {},
                                                [](const StampedBelief& belief) { return belief.velocity.stamp_ns; });
    if (found == run.beliefs.end() || found->velocity.stamp_ns != estimate.stamp_ns) continue;
    const StampedBelief& belief = *found;
    const StampedPose true_pose = Apply(to_estimate, truth[match.truth]);
    const auto true_velocity =
        truth_velocities ? VelocityAt(*truth_velocities, true_pose.stamp_ns) : std::optional<StampedVelocity>();

    FrameConsistency frame;
    frame.stamp_ns = estimate.stamp_ns;
    frame.error.setConstant(kNaN);
    frame.error.segment<3>(0) = true_pose.p_WC - estimate.p_WC;
    frame.error.segment<3>(3) = Log(estimate.q_WC.conjugate() * true_pose.q_WC);
    if (true_velocity) {
      frame.error.segment<3>(6) = to_estimate.R * true_velocity->v_WC - belief.velocity.v_WC;
      frame.error.segment<3>(9) = true_velocity->w_WC_C - belief.velocity.w_WC_C;
    }
    const Matrix12d& P = belief.covariance;
    frame.sigma = P.diagonal().cwiseMax(0).cwiseSqrt();

    Vector12d scale_direction = Vector12d::Zero();
    scale_direction.segment<3>(0) = true_pose.p_WC - true_start;
    if (true_velocity) scale_direction.segment<3>(6) = to_estimate.R * true_velocity->v_WC;
    frame.nees_pose = Nees(frame.error.head<6>(), P.topLeftCorner<6, 6>());
    frame.nees_pose_scale_free =
        NeesWithoutDirection(frame.error.head<6>(), P.topLeftCorner<6, 6>(), scale_direction.head<6>());
    frame.nees_velocity = true_velocity ? Nees(frame.error.tail<6>(), P.bottomRightCorner<6, 6>()) : kNaN;
    frame.nees_joint = true_velocity ? Nees(frame.error, P) : kNaN;
    frame.nees_joint_scale_free = true_velocity ? NeesWithoutDirection(frame.error, P, scale_direction) : kNaN;
    frames.push_back(frame);
  }
  return frames;
}

NeesSummary SummariseNees(const std::vector<double>& nees, int dof) {
  NeesSummary summary;
  summary.dof = dof;
  std::vector<double> usable;
  std::copy_if(nees.begin(), nees.end(), std::back_inserter(usable), [](double v) { return !std::isnan(v); });
  summary.frames = usable.size();
  summary.unusable = nees.size() - usable.size();
  if (usable.empty()) return summary;
  const Statistics statistics = Summarise(usable);
  summary.mean = statistics.mean;
  summary.median = statistics.median;
  summary.last = usable.back();
  const Band band = Chi2MeanBand(dof, 1);
  const auto inside =
      std::count_if(usable.begin(), usable.end(), [&](double v) { return v >= band.low && v <= band.high; });
  summary.share_inside = static_cast<double>(inside) / static_cast<double>(usable.size());
  return summary;
}

std::vector<AneesPoint> Anees(const std::vector<std::vector<std::int64_t>>& stamps,
                              const std::vector<std::vector<double>>& values, int dof) {
  std::map<std::int64_t, std::pair<int, double>> sums;
  for (std::size_t m = 0; m < values.size(); ++m) {
    if (m >= stamps.size() || stamps[m].size() != values[m].size())
      throw std::logic_error("Anees: a value without its stamp");
    for (std::size_t k = 0; k < values[m].size(); ++k) {
      if (std::isnan(values[m][k])) continue;
      auto& [count, sum] = sums[stamps[m][k]];
      ++count;
      sum += values[m][k];
    }
  }
  std::map<int, Band> bands;
  std::vector<AneesPoint> points;
  for (const auto& [stamp, entry] : sums) {
    const auto& [count, sum] = entry;
    if (!bands.contains(count)) bands[count] = Chi2MeanBand(dof, count);
    points.push_back({stamp, count, sum / count, bands[count]});
  }
  return points;
}

std::vector<AneesPoint> AneesByFrame(const std::vector<std::vector<double>>& values, int dof, std::int64_t first) {
  std::vector<std::vector<std::int64_t>> frames;
  for (const auto& run : values) {
    std::vector<std::int64_t>& numbers = frames.emplace_back(run.size());
    std::iota(numbers.begin(), numbers.end(), first);
  }
  return Anees(frames, values, dof);
}

}  // namespace evaluation
