// Points that may move on their own: the choice of provisional matches, their effect on filter and consensus, and a
// group that moves through images.
#include "vo/frontend/moving_points.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/unit/vo/at_once.h"
#include "tests/unit/vo/texture.h"
#include "tests/unit/vo/two_walls.h"
#include "tests/unit/vo/wall.h"
#include "vo/filter/algorithm1.h"
#include "vo/filter/consensus.h"
#include "vo/geometry/so3.h"
#include "vo/odometry.h"

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

int CountProvisional(int proven, int others) {
  constexpr int kProvingMatches = 5;
  std::vector<vo::LandmarkRecord> records(static_cast<std::size_t>(proven + others));
  std::vector<vo::Match> matches;
  for (int n = 0; n < proven + others; ++n) {
    records[static_cast<std::size_t>(n)].inliers = n < proven ? kProvingMatches : kProvingMatches - 1;
    matches.push_back({.landmark = n});
    matches.back().provisional = n % 2 == 0;  // left by an earlier call
  }
  vo::MarkProvisional(records, kProvingMatches, matches);
  int count = 0;
  for (const vo::Match& match : matches) {
    EXPECT_TRUE(!match.provisional || match.landmark >= proven);
    count += match.provisional;
  }
  return count;
}

TEST(MovingPoints, AreProvisionalWhereEnoughOthersHaveProvenToBeAtRest) {
  EXPECT_EQ(CountProvisional(15, 0), 0);
  EXPECT_EQ(CountProvisional(15, 5), 5);
  EXPECT_EQ(CountProvisional(14, 5), 0) << "too few";
  EXPECT_EQ(CountProvisional(40, 60), 60);
  EXPECT_EQ(CountProvisional(39, 61), 0) << "fewer than two fifths";
  EXPECT_EQ(CountProvisional(0, 0), 0);
}

constexpr int kLandmarks = 30, kProvisional = 10;

vo::Algorithm1 MakeFilter(vo::Proposal proposal) {
  vo::ParticleFilterSettings settings;
  settings.filter = vo_test::SampledAtOnce();
  settings.filter.proposal = proposal;
  settings.seed = 4;
  vo::FilterPrior prior;
  prior.velocity_covariance = 0.04 * vo::Matrix6::Identity();
  vo::Algorithm1 filter(settings, prior);
  filter.AddLandmarks(vo_test::WallFirstViews(kLandmarks));
  return filter;
}

// Matches of frame 1; those of the last kProvisional landmarks are displaced by `moved`.
std::vector<vo::Match> MatchesOfAMovingGroup(const Vector2d& moved) {
  std::vector<vo::Match> matches = vo_test::WallMatches(kLandmarks, 1);
  for (int n = kLandmarks - kProvisional; n < kLandmarks; ++n) matches[static_cast<std::size_t>(n)].z += moved;
  return matches;
}

// Provisional matches update their landmarks, but not the pose: equal to an update without them, bit for bit.
TEST(MovingPoints, ProvisionalMatchesTellOfTheLandmarkAlone) {
  for (const vo::Proposal proposal : {vo::Proposal::iterated, vo::Proposal::ekf, vo::Proposal::ukf}) {
    const std::vector<vo::Match> matches = MatchesOfAMovingGroup({0.004, 0.003});
    vo::Algorithm1 without = MakeFilter(proposal), with = MakeFilter(proposal), acting = MakeFilter(proposal);
    for (vo::Algorithm1* filter : {&without, &with, &acting}) filter->Predict(1.0 / 30);
    without.Update(std::span(matches).first(kLandmarks - kProvisional));
    acting.Update(matches);
    std::vector<vo::Match> marked = matches;
    for (int n = kLandmarks - kProvisional; n < kLandmarks; ++n) marked[static_cast<std::size_t>(n)].provisional = true;
    std::reverse(marked.begin(), marked.end());  // the order is irrelevant
    std::reverse(marked.begin() + kProvisional, marked.end());
    with.Update(marked);
    EXPECT_EQ(with.belief().pose.p_WC, without.belief().pose.p_WC);
    EXPECT_EQ(with.belief().covariance, without.belief().covariance);
    EXPECT_NE(with.belief().pose.p_WC, acting.belief().pose.p_WC);

    const std::vector<vo::Filter::LandmarkBelief> a = with.LandmarkBeliefs(), b = without.LandmarkBeliefs();
    for (std::size_t n = 0; n < kLandmarks; ++n) {
      const bool provisional = n >= kLandmarks - kProvisional;
      EXPECT_EQ(a[n].inverse_depth != b[n].inverse_depth, provisional) << n;
    }
  }
}

// Consensus on known points in front of a camera at rest. A third of them is displaced by (3, 2) kSigma, all in one
// direction.
TEST(MovingPoints, AGroupDoesNotMoveTheConsensus) {
  constexpr double kSigma = 0.002, kGate = 9.21;
  std::vector<vo::Landmark> landmarks;
  for (int n = 0; n < kLandmarks; ++n) {
    landmarks.emplace_back().mean << vo_test::WallRay(n), 0.3;
    landmarks.back().covariance.diagonal() << 1e-9, 1e-9, 1e-6;
  }
  const std::vector<int> anchor_of(kLandmarks, 0);
  const std::vector<vo::Pose> anchors(1);
  const vo::PoseGaussian prediction{{}, 1e-4 * vo::Matrix6::Identity()};
  const auto fit = [&](const Vector2d& moved, bool provisional) {
    std::vector<vo::Match> matches;
    for (int n = 0; n < kLandmarks; ++n) {
      const bool in_group = n >= kLandmarks - kProvisional;
      matches.push_back({n, vo_test::WallRay(n) + (in_group ? moved : Vector2d::Zero()),
                         kSigma * kSigma * Eigen::Matrix2d::Identity()});
      matches.back().provisional = provisional && in_group;
    }
    return vo::FindConsensus(prediction, {landmarks, anchor_of, anchors}, matches, kGate, {});
  };
  const auto group = [](const vo::Consensus& c) {
    return std::count(c.inlier.end() - kProvisional, c.inlier.end(), true);
  };
  const auto others = [](const vo::Consensus& c) {
    return std::count(c.inlier.begin(), c.inlier.end() - kProvisional, true);
  };
  const auto off = [](const vo::Consensus& c) { return vo::Minus(c.pose.mean, {}).norm(); };

  const vo::Consensus provisional = fit({3 * kSigma, 2 * kSigma}, true);
  EXPECT_LT(off(provisional), 1e-9);
  EXPECT_EQ(group(provisional), 0);
  EXPECT_EQ(others(provisional), kLandmarks - kProvisional);
  EXPECT_GT(off(fit({3 * kSigma, 2 * kSigma}, false)), 1e-4) << "as equals they pull";
  EXPECT_EQ(group(fit({0, 0}, true)), kProvisional) << "at rest they agree";
}

// Two walls, in front of which a textured board passes from the end of the start on. RMS position error [m] of the
// frames from then on, after the fit of a similarity, and the mean number of matches.
struct Outcome {
  double rms = 0, matched = 0;
};

Outcome PastABoard(int proving_matches, bool board) {
  constexpr int kFirst = 33, kFrames = 80;
  const vo_test::Texture wall(1, 40.0, 24), print(2, 60.0, 24);
  vo::Params params = vo_test::SmallImageParams();
  params.landmark.proving_matches = proving_matches;
  params.features.noise = vo::MatchNoise::registered;  // noise from residuals reduces the board's effect as well
  vo::Odometry odometry(vo_test::kCamera, params, vo_test::KnownStart(), 1);
  Eigen::Matrix3Xd x(3, kFrames), y(3, kFrames);
  Outcome outcome;
  for (int k = 0; k < kFrames; ++k) {
    cv::Mat image = vo_test::ViewFrom(vo_test::TruthAt(k), wall);
    // Board in the image: 120 x 150 px, moving by 1.5 px a frame to the right and 0.8 px down.
    const Vector2d corner(-60 + 1.5 * (k - kFirst), 10 + 0.8 * (k - kFirst));
    for (int v = 0; board && k >= kFirst && v < image.rows; ++v)
      for (int u = 0; u < image.cols; ++u) {
        const Vector2d on = Vector2d(u, v) - corner;
        if (on.x() >= 0 && on.x() < 120 && on.y() >= 0 && on.y() < 150)
          image.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(print.At(on / 130));
      }
    const vo::Estimate estimate = odometry.Track({k * vo_test::kFrameNs, image});
    if (k >= kFirst) outcome.matched += static_cast<double>(estimate.diagnostics.matched) / (kFrames - kFirst);
    x.col(k) = estimate.pose.p_WC;
    y.col(k) = vo_test::TruthAt(k).p_WC;
  }
  const Eigen::Matrix4d T = Eigen::umeyama(x, y, true);
  const Eigen::Matrix3Xd error = ((T.topLeftCorner<3, 3>() * x).colwise() + Vector3d(T.topRightCorner<3, 1>())) - y;
  outcome.rms = std::sqrt(error.rightCols(kFrames - kFirst).squaredNorm() / (kFrames - kFirst));
  return outcome;
}

TEST(MovingPoints, AMovingBoardDoesNotCarryTheCameraAway) {
  const Outcome proven = PastABoard(5, true), at_once = PastABoard(0, true), at_rest = PastABoard(5, false);
  EXPECT_LT(at_rest.rms, 0.004);
  EXPECT_LT(proven.rms, 0.004);
  EXPECT_GT(at_once.rms, 0.02) << "without proof the board takes part of the camera along";
  EXPECT_GT(proven.matched, 50);  // about 90 without the board, which hides a third of the image
}

}  // namespace
