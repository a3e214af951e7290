#include <gtest/gtest.h>

#include "tests/unit/judge/evaluation/random.h"
#include "tools/judge/evaluation/whiteness.h"

namespace evaluation {
namespace {

// NIS of frames with a varying number of features; `memory` is the correlation of neighbouring innovations.
std::vector<FrameRecord> Frames(TestRandom& random, int count, double scale, double memory = 0) {
  std::vector<FrameRecord> frames;
  Eigen::VectorXd innovation = random.Normals(80);
  for (int k = 0; k < count; ++k) {
    innovation = memory * innovation + std::sqrt(1 - memory * memory) * random.Normals(80);
    FrameRecord frame;
    frame.stamp_ns = k;
    frame.nis_dof = 20 + 2 * (k % 30);
    frame.nis = scale * innovation.head(frame.nis_dof).squaredNorm();
    frames.push_back(frame);
  }
  frames.push_back({});  // coasted: no degrees of freedom, not counted
  return frames;
}

// Limits at five standard deviations: false-alarm rate below 1e-6 each.
TEST(SummariseNis, AcceptsAndRejects) {
  const int n = 2000;
  const double share_limit = 5 * std::sqrt(0.95 * 0.05 / n), mean_limit = 5 * std::sqrt(2.0 / (n * 49.0));
  TestRandom random(30);
  const NisSummary honest = SummariseNis(Frames(random, n, 1));
  EXPECT_EQ(honest.frames, static_cast<std::size_t>(n));
  EXPECT_NEAR(honest.mean_per_dof, 1, mean_limit);
  EXPECT_NEAR(honest.share_inside, 0.95, share_limit);
  ASSERT_EQ(honest.autocorrelation.size(), 5u);
  for (const double rho : honest.autocorrelation) EXPECT_LT(std::abs(rho), 5 / std::sqrt(n));
  EXPECT_NEAR(honest.whiteness_bound, 1.96 / std::sqrt(n), 1e-12);

  const NisSummary confident = SummariseNis(Frames(random, n, 2));  // S x 0.5
  EXPECT_GT(confident.mean_per_dof, 1 + mean_limit);
  EXPECT_LT(confident.share_inside, 0.95 - share_limit);
  EXPECT_GT(SummariseNis(Frames(random, n, 1, 0.7)).autocorrelation[0], 5 / std::sqrt(n));
}

TEST(SummariseNis, Empty) {
  const NisSummary summary = SummariseNis({FrameRecord{}});
  EXPECT_EQ(summary.frames, 0u);
  EXPECT_TRUE(std::isnan(summary.mean_per_dof)) << "0 would be an answer";
  EXPECT_TRUE(std::isnan(summary.share_inside));
  EXPECT_TRUE(summary.autocorrelation.empty());
  FrameRecord one;
  one.nis_dof = 1;
  EXPECT_EQ(SummariseNis({one}).frames, 1u);
}

// Eight frames and one that was coasted; the figures are SciPy's.
TEST(SummariseNis, Figures) {
  const double nis[] = {2.5, 0.9, 7.1, 0.02, 11.3, 4.0, 6.6, 3.3, 0.4};
  const int dof[] = {2, 4, 6, 2, 4, 0, 6, 2, 4};
  std::vector<FrameRecord> frames(9);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].nis = nis[i];
    frames[i].nis_dof = dof[i];
  }
  const NisSummary summary = SummariseNis(frames);
  EXPECT_EQ(summary.frames, 8u);
  EXPECT_NEAR(summary.mean_per_dof, 32.12 / 30, 1e-14);
  EXPECT_EQ(summary.share_inside, 5.0 / 8);
  EXPECT_NEAR(summary.whiteness_bound, 0.6929646455628166, 1e-15);
  const double rho[] = {-0.3526644221533532, 0.28087498896947266, -0.6426371351141558, 0.17208842593372453,
                        -0.08890358807019479};
  ASSERT_EQ(summary.autocorrelation.size(), 5u);
  for (std::size_t l = 0; l < 5; ++l) EXPECT_NEAR(summary.autocorrelation[l], rho[l], 1e-14) << l;

  frames.resize(4);  // no more lags than there are pairs
  const double of_four[] = {-0.7781933502551058, 0.49553192222523484, -0.21733857197012899};
  const NisSummary four = SummariseNis(frames);
  ASSERT_EQ(four.autocorrelation.size(), 3u);
  for (std::size_t l = 0; l < 3; ++l) EXPECT_NEAR(four.autocorrelation[l], of_four[l], 1e-14) << l;
  frames.resize(2);
  frames[1] = frames[0];
  EXPECT_TRUE(SummariseNis(frames).autocorrelation.empty()) << "no spread";
  frames[1].nis += 1e-3;
  EXPECT_NEAR(SummariseNis(frames).autocorrelation.at(0), -0.5, 1e-9) << "little is some";
}

}  // namespace
}  // namespace evaluation
