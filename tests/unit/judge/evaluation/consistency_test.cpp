// NEES, ANEES and their bands. Seeds are fixed and not chosen by the outcome; each statistical test states its
// false-alarm rate and has an inconsistent control that must fail.
#include "tools/judge/evaluation/consistency.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "tests/unit/judge/evaluation/random.h"
#include "tools/judge/evaluation/association.h"
#include "tools/judge/evaluation/ate.h"

namespace evaluation {
namespace {

Matrix12d RandomCovariance(TestRandom& random) {
  Matrix12d A;
  for (int i = 0; i < 12; ++i) A.col(i) = random.Normals(12);
  Vector12d size;
  size << 0.03, 0.1, 0.02, 0.02, 0.004, 0.05, 0.2, 0.05, 0.1, 0.1, 0.3, 0.05;  // all differ: a permutation shows
  return size.asDiagonal() * Matrix12d(A * A.transpose() / 12 + 0.1 * Matrix12d::Identity()) * size.asDiagonal();
}

struct World {
  EstimateRun run;
  Trajectory truth;
  Velocities velocities;
};

// Consistent world: independent frames, each error drawn from the frame's own covariance. q = q^ Exp(dphi).
World HonestWorld(TestRandom& random, int frames, std::vector<Vector12d>* errors = nullptr,
                  bool left_perturbation = false) {
  World world;
  world.truth = random.Walk(frames);
  for (const StampedPose& pose : world.truth) {
    const Matrix12d P = RandomCovariance(random);
    const Vector12d e = P.llt().matrixL() * random.Normals(12);
    const StampedVelocity velocity{pose.stamp_ns, random.Normals(3), random.Normals(3)};
    const Eigen::Quaterniond inverse = Exp(-e.segment<3>(3));
    world.run.trajectory.push_back(
        {pose.stamp_ns, pose.p_WC - e.segment<3>(0), left_perturbation ? inverse * pose.q_WC : pose.q_WC * inverse});
    world.run.beliefs.push_back(
        {{pose.stamp_ns, velocity.v_WC - e.segment<3>(6), velocity.w_WC_C - e.segment<3>(9)}, P});
    world.velocities.push_back(velocity);
    if (errors != nullptr) errors->push_back(e);
  }
  return world;
}

std::vector<FrameConsistency> Judge(const World& world) {
  return ComputeConsistency(world.run, world.truth, world.velocities, 20'000'000);
}

TEST(ComputeConsistency, FindsTheErrorsThatWereMade) {
  TestRandom random(20);
  std::vector<Vector12d> errors;
  const World world = HonestWorld(random, 50, &errors);
  const auto frames = Judge(world);
  ASSERT_EQ(frames.size(), 50u);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EXPECT_LT((frames[k].error - errors[k]).norm(), 1e-12);
    const Matrix12d& P = world.run.beliefs[k].covariance;
    const auto by_inverse = [&](int start, int n) {
      const Eigen::MatrixXd block = P.block(start, start, n, n);
      return errors[k].segment(start, n).dot(block.inverse() * errors[k].segment(start, n));
    };
    EXPECT_NEAR(frames[k].nees_pose / by_inverse(0, 6), 1, 1e-8);
    EXPECT_NEAR(frames[k].nees_velocity / by_inverse(6, 6), 1, 1e-8);
    EXPECT_NEAR(frames[k].nees_joint / by_inverse(0, 12), 1, 1e-8);
    EXPECT_NEAR(frames[k].sigma[4], std::sqrt(P(4, 4)), 1e-15);
  }
}

// Association of frames and beliefs by stamps: a frame without a belief is left out, wherever it is.
TEST(ComputeConsistency, JudgesTheFramesThatHaveABelief) {
  TestRandom random(30);
  World world = HonestWorld(random, 6);
  const auto all = Judge(world);
  world.run.beliefs.erase(world.run.beliefs.begin() + 5);
  world.run.beliefs.erase(world.run.beliefs.begin() + 2);
  world.run.beliefs.erase(world.run.beliefs.begin());
  const auto frames = Judge(world);
  ASSERT_EQ(frames.size(), 3u);
  const std::size_t left[] = {1, 3, 4};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(frames[i].stamp_ns, world.truth[left[i]].stamp_ns);
    EXPECT_EQ(frames[i].nees_joint, all[left[i]].nees_joint);
  }
  world.run.beliefs.clear();
  EXPECT_TRUE(Judge(world).empty());
}

// Mean of n independent NEES inside its band, which consistent errors leave with probability 1e-6.
bool InBand(const std::vector<FrameConsistency>& frames, double FrameConsistency::*member, int dof) {
  double sum = 0;
  for (const FrameConsistency& frame : frames) sum += frame.*member;
  const Band band = Chi2MeanBand(dof, static_cast<int>(frames.size()), 1 - 1e-6);
  const double mean = sum / static_cast<double>(frames.size());
  return mean > band.low && mean < band.high;
}

// False-alarm rate: 5e-6 (five means). Averaging over frames is valid here: they are independent by construction.
TEST(ComputeConsistency, ConsistentErrorsAreInsideTheirBands) {
  TestRandom random(21);
  const auto frames = Judge(HonestWorld(random, 2000));
  EXPECT_TRUE(InBand(frames, &FrameConsistency::nees_pose, 6));
  EXPECT_TRUE(InBand(frames, &FrameConsistency::nees_velocity, 6));
  EXPECT_TRUE(InBand(frames, &FrameConsistency::nees_joint, 12));
  const std::vector<FrameConsistency> moving(frames.begin() + 1, frames.end());  // scale unobservable at the start
  EXPECT_TRUE(InBand(moving, &FrameConsistency::nees_pose_scale_free, 5));
  EXPECT_TRUE(InBand(moving, &FrameConsistency::nees_joint_scale_free, 11));
  EXPECT_FALSE(InBand(moving, &FrameConsistency::nees_joint_scale_free, 12)) << "11 degrees are told from 12";
}

TEST(ComputeConsistency, HalvedCovarianceIsRejected) {
  TestRandom random(21);
  World world = HonestWorld(random, 2000);
  for (StampedBelief& belief : world.run.beliefs) belief.covariance *= 0.5;
  const auto frames = Judge(world);
  EXPECT_FALSE(InBand(frames, &FrameConsistency::nees_pose, 6));
  EXPECT_FALSE(InBand(frames, &FrameConsistency::nees_velocity, 6));
  EXPECT_FALSE(InBand(frames, &FrameConsistency::nees_joint, 12));
}

TEST(ComputeConsistency, ErrorOnTheWrongSideIsRejected) {
  TestRandom random(22);
  EXPECT_FALSE(InBand(Judge(HonestWorld(random, 2000, nullptr, true)), &FrameConsistency::nees_pose, 6));
}

TEST(ComputeConsistency, ADelayOfOneFrameIsRejected) {
  TestRandom random(23);
  World world = HonestWorld(random, 2000);
  for (std::size_t k = world.truth.size() - 1; k > 0; --k) {
    world.truth[k].p_WC = world.truth[k - 1].p_WC;
    world.truth[k].q_WC = world.truth[k - 1].q_WC;
  }
  EXPECT_FALSE(InBand(Judge(world), &FrameConsistency::nees_pose, 6));
}

// Share of frames inside the 95 % band of one run: binomial, five standard deviations (false-alarm rate 6e-7).
TEST(SummariseNees, TheBandHoldsItsShare) {
  TestRandom random(24);
  std::vector<double> nees;
  for (const FrameConsistency& frame : Judge(HonestWorld(random, 3000))) nees.push_back(frame.nees_joint);
  const NeesSummary summary = SummariseNees(nees, 12);
  EXPECT_EQ(summary.frames, 3000u);
  EXPECT_NEAR(summary.share_inside, 0.95, 5 * std::sqrt(0.95 * 0.05 / 3000));
  EXPECT_NEAR(SummariseNees(nees, 12).median, Chi2Quantile(0.5, 12), 5 * 1.2533 * std::sqrt(24.0 / 3000));
  for (double& value : nees) value *= 2;  // P x 0.5
  EXPECT_LT(SummariseNees(nees, 12).share_inside, 0.95 - 5 * std::sqrt(0.95 * 0.05 / 3000));
}

// Scale-free NEES: invariant under any error of scale, chi-square with one degree of freedom less.
TEST(NeesWithoutDirection, IsBlindToTheDirectionAndToNothingElse) {
  TestRandom random(25);
  double sum = 0;
  const int n = 2000;
  for (int i = 0; i < n; ++i) {
    const Matrix12d P = RandomCovariance(random);
    const Eigen::VectorXd e = P.llt().matrixL() * random.Normals(12);
    const Eigen::VectorXd g = random.Normals(12);
    const double nees = NeesWithoutDirection(e, P, g);
    EXPECT_NEAR(NeesWithoutDirection(e + 0.3 * g, P, g) / nees, 1, 1e-6);
    EXPECT_LE(nees, Nees(e, P) * (1 + 1e-12));
    sum += nees;
  }
  const Band band = Chi2MeanBand(11, n, 1 - 1e-6);  // false alarm rate 1e-6
  EXPECT_GT(sum / n, band.low);
  EXPECT_LT(sum / n, band.high);
}

TEST(NeesWithoutDirection, ByHand) {
  const Eigen::MatrixXd P = Eigen::Vector2d(0.25, 4).asDiagonal();
  const Eigen::Vector2d e(0.1, 0.2);
  for (const double length : {1e-3, 1.0, 1e3})
    EXPECT_NEAR(NeesWithoutDirection(e, P, length * Eigen::Vector2d::UnitX()), 0.04 / 4, 1e-15) << length;
  EXPECT_EQ(NeesWithoutDirection(Eigen::Vector2d(0.1, 0), P, Eigen::Vector2d::UnitX()), 0);
  EXPECT_TRUE(std::isnan(NeesWithoutDirection(e, P, Eigen::Vector2d::Zero())));
  EXPECT_TRUE(std::isnan(NeesWithoutDirection(e, -P, Eigen::Vector2d::UnitX())));
}

TEST(ComputeConsistency, ScaleFreeNees) {
  TestRandom random(26);
  World world = HonestWorld(random, 300);
  const Eigen::Vector3d start = world.truth[0].p_WC;
  const auto before = Judge(world);
  for (std::size_t k = 0; k < world.truth.size(); ++k) {  // the scale of the truth is 3 times the estimate's
    world.truth[k].p_WC = start + 3 * (world.truth[k].p_WC - start);
    world.velocities[k].v_WC *= 3;
  }
  const auto after = Judge(world);
  for (std::size_t k = 1; k < before.size(); ++k) {
    EXPECT_NEAR(after[k].nees_pose_scale_free / before[k].nees_pose_scale_free, 1, 1e-6);
    EXPECT_NEAR(after[k].nees_joint_scale_free / before[k].nees_joint_scale_free, 1, 1e-6);
  }
  EXPECT_FALSE(InBand(after, &FrameConsistency::nees_pose, 6));
  EXPECT_TRUE(std::isnan(before[0].nees_pose_scale_free)) << "at the start itself the scale does not show";
}

TEST(Nees, NeedsAPositiveDefiniteCovariance) {
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(6, 6);
  EXPECT_TRUE(std::isnan(Nees(Eigen::VectorXd::Zero(6), P)));
  P.setIdentity();
  P(0, 1) = P(1, 0) = 1;  // rank 5
  EXPECT_TRUE(std::isnan(Nees(Eigen::VectorXd::Ones(6), P)));
  P(0, 1) = P(1, 0) = 1.5;  // indefinite
  EXPECT_TRUE(std::isnan(Nees(Eigen::VectorXd::Ones(6), P)));
  P(0, 1) = P(1, 0) = 0.5;
  EXPECT_NEAR(Nees(Eigen::VectorXd::Unit(6, 0), P), 4.0 / 3, 1e-12);
  // Threshold: a pivot of 1e-12 of the correlation matrix.
  for (const double pivot : {0.97e-12, 1.03e-12}) {
    P(0, 1) = P(1, 0) = std::sqrt(1 - pivot);
    EXPECT_EQ(std::isnan(Nees(Eigen::VectorXd::Ones(6), P)), pivot < 1e-12) << pivot;
  }
  for (const double none : {std::nan(""), static_cast<double>(INFINITY)}) {
    P.setIdentity();
    P(0, 1) = none;  // and P(1, 0) is 0
    EXPECT_TRUE(std::isnan(Nees(Eigen::VectorXd::Ones(6), P))) << none;
  }
  for (const double variance : {-1.0, 0.0, std::nan("")}) {
    P.setIdentity();
    P(3, 3) = variance;
    EXPECT_TRUE(std::isnan(Nees(Eigen::VectorXd::Ones(6), P))) << variance;
  }
  // Invariance under the scale of units.
  EXPECT_NEAR(Nees(1e-9 * Eigen::VectorXd::Ones(6), 1e-18 * Eigen::MatrixXd::Identity(6, 6)), 6, 1e-9);
}

// Six degrees of freedom: the band is 1.237 to 14.449.
TEST(SummariseNees, Figures) {
  const NeesSummary summary = SummariseNees({4, 1, 20, 6, 3}, 6);
  EXPECT_EQ(summary.dof, 6);
  EXPECT_EQ(summary.frames, 5u);
  EXPECT_EQ(summary.unusable, 0u);
  EXPECT_NEAR(summary.mean, 6.8, 1e-14);
  EXPECT_EQ(summary.median, 4);
  EXPECT_EQ(summary.last, 3);
  EXPECT_EQ(summary.share_inside, 0.6);
}

TEST(SummariseNees, CountsWhatHasNoAnswer) {
  const NeesSummary summary = SummariseNees({std::nan(""), 6, 12}, 6);
  EXPECT_EQ(summary.frames, 2u);
  EXPECT_EQ(summary.unusable, 1u);
  EXPECT_EQ(summary.mean, 9);
  EXPECT_EQ(summary.last, 12);
  for (const std::vector<double>& none : {std::vector<double>{}, {std::nan("")}}) {
    const NeesSummary nothing = SummariseNees(none, 6);
    EXPECT_EQ(nothing.frames, 0u);
    for (const double value : {nothing.mean, nothing.median, nothing.last, nothing.share_inside})
      EXPECT_TRUE(std::isnan(value)) << "0 would be an answer";
  }
}

TEST(ComputeConsistency, FirstPoseGauge) {
  TestRandom random(27);
  World world = HonestWorld(random, 40);
  world.run.trajectory[0] = world.truth[0];  // exact start
  const auto before = Judge(world);
  Similarity away;
  away.R = random.Orientation().toRotationMatrix();
  away.t = random.Normals(3);
  world.truth = Apply(away, world.truth);
  for (StampedVelocity& velocity : world.velocities) velocity.v_WC = away.R * velocity.v_WC;
  const auto after = ComputeConsistency(world.run, world.truth, world.velocities, 20'000'000, Gauge::first_pose);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t k = 0; k < after.size(); ++k) EXPECT_LT((after[k].error - before[k].error).norm(), 1e-9);
  EXPECT_GT((Judge(world)[5].error - before[5].error).norm(), 0.1);
}

TEST(ComputeConsistency, WithoutTrueVelocitiesOnlyThePoseIsJudged) {
  TestRandom random(28);
  const World world = HonestWorld(random, 5);
  const auto frames = ComputeConsistency(world.run, world.truth, std::nullopt, 20'000'000);
  EXPECT_FALSE(std::isnan(frames[1].nees_pose));
  EXPECT_TRUE(std::isnan(frames[1].nees_velocity));
  EXPECT_TRUE(std::isnan(frames[1].nees_joint));
  EXPECT_TRUE(std::isnan(frames[1].error[7]));
}

TEST(Anees, AveragesOverRunsAtEachTime) {
  const auto points = Anees({{1, 2, 3}, {2, 3}}, {{4, 6, std::nan("")}, {8, 5}}, 6);
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[1].stamp_ns, 2);
  EXPECT_EQ(points[1].runs, 2);
  EXPECT_EQ(points[1].anees, 7);
  EXPECT_NEAR(points[1].band.high, Chi2Quantile(0.975, 12) / 2, 1e-12);
  EXPECT_EQ(points[2].runs, 1);
  EXPECT_EQ(points[2].anees, 5);
  EXPECT_NEAR(points[2].band.low, Chi2Quantile(0.025, 6), 1e-12);
  EXPECT_THROW(Anees({{1}}, {{4}, {5}}, 6), std::logic_error);
  EXPECT_THROW(Anees({{1, 2}}, {{4}}, 6), std::logic_error);
}

// NEES needs unaligned errors. Random-walk drift with its exact covariance from a known start: unaligned, ANEES is
// consistent at every frame. After SE(3) alignment the same errors appear several times over-confident at the start
// (where the alignment leaves an error and the covariance has none) and several times under-confident at the end.
// False-alarm rate of the unaligned figures: 1e-6 each.
TEST(Anees, AlignmentBeforehandDestroysIt) {
  TestRandom random(29);
  const int runs = 400, steps = 100;
  const int early = 5, late = steps;
  double early_none = 0, late_none = 0, early_se3 = 0, late_se3 = 0;
  for (int m = 0; m < runs; ++m) {
    MatchedTrajectories matched;
    matched.truth = random.Walk(steps + 1);
    Eigen::Vector3d drift = Eigen::Vector3d::Zero();
    for (const StampedPose& pose : matched.truth) {
      matched.estimate.push_back({pose.stamp_ns, pose.p_WC + drift, pose.q_WC});
      drift += 0.01 * random.Normals(3);
    }
    const Trajectory aligned = Apply(Align(matched, Alignment::se3), matched.estimate);
    const auto nees = [&](const Trajectory& estimate, int k) {
      const auto i = static_cast<std::size_t>(k);
      return Nees(matched.truth[i].p_WC - estimate[i].p_WC, 1e-4 * k * Eigen::MatrixXd::Identity(3, 3)) / runs;
    };
    early_none += nees(matched.estimate, early);
    late_none += nees(matched.estimate, late);
    early_se3 += nees(aligned, early);
    late_se3 += nees(aligned, late);
  }
  const Band band = Chi2MeanBand(3, runs, 1 - 1e-6);
  EXPECT_GT(early_none, band.low);
  EXPECT_LT(early_none, band.high);
  EXPECT_GT(late_none, band.low);
  EXPECT_LT(late_none, band.high);
  EXPECT_GT(early_se3, 2 * band.high);
  EXPECT_LT(late_se3, band.low / 1.5);
}

}  // namespace
}  // namespace evaluation
