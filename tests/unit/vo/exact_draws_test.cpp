#include <gtest/gtest.h>

#include <cmath>

#include "vo/base/random.h"
#include "vo/filter/path_sampling.h"
#include "vo/geometry/pose.h"

namespace {

vo::ParticleColumns Normals(int particles, std::uint32_t replicate, vo::Stream stream = vo::Stream::pose) {
  vo::ParticleColumns normals(6, particles);
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(particles); ++i)
    for (std::uint32_t d = 0; d < 6; ++d) normals(d, i) = vo::Normal({7, stream, replicate, i}, d);
  return normals;
}

TEST(ExactDraws, HaveMeanZeroAndTheIdentityForCovariance) {
  for (const int n : {7, 8, 13, 14, 64}) {
    const vo::ParticleColumns draws = vo::ExactDraws(Normals(n, 1, vo::Stream::velocity), Normals(n, 1));
    EXPECT_LT(draws.rowwise().mean().norm(), 1e-13) << n;
    EXPECT_LT((draws * draws.transpose() / n - vo::Matrix6::Identity()).norm(), 1e-12) << n;
  }
  EXPECT_EQ(vo::ExactDraws(Normals(6, 1, vo::Stream::velocity), Normals(6, 1)), Normals(6, 1)) << "too few";
}

TEST(ExactDraws, AreIndependentFromFourteenParticlesOn) {
  for (const double scale : {1e-9, 1.0, 1e6}) {
    const vo::ParticleColumns offsets = scale * (Normals(14, 2, vo::Stream::velocity).array() + 3);
    const vo::ParticleColumns draws = vo::ExactDraws(offsets, Normals(14, 2));
    EXPECT_LT((draws * offsets.transpose()).norm() / offsets.norm(), 1e-12) << scale;
  }
}

TEST(ExactDraws, HaveNoUnitOfLength) {
  vo::ParticleColumns offsets = Normals(20, 4, vo::Stream::velocity);
  const vo::ParticleColumns draws = vo::ExactDraws(offsets, Normals(20, 4));
  offsets.topRows<3>() *= 1024;
  EXPECT_EQ(vo::ExactDraws(offsets, Normals(20, 4)), draws);
}

// Offsets without scatter: in all directions, as at the start, or in all but two.
TEST(ExactDraws, TakeOffsetsWithoutScatter) {
  vo::ParticleColumns offsets = vo::ParticleColumns::Constant(6, 20, 0.3);
  for (const int directions : {0, 2}) {
    offsets.topRows(directions) = Normals(20, 3, vo::Stream::velocity).topRows(directions);
    const vo::ParticleColumns draws = vo::ExactDraws(offsets, Normals(20, 3));
    ASSERT_TRUE(draws.allFinite());
    EXPECT_LT((draws * draws.transpose() / 20 - vo::Matrix6::Identity()).norm(), 1e-12);
    EXPECT_LT((draws * offsets.transpose()).norm(), 1e-12);
  }
}

// Marginal distribution of one particle's draw: mean 0, covariance I. Over R replicates sum z^2 of one coordinate has a
// variance of at most 2 R (the tails are lighter than a normal's). False-alarm rate 1e-3: 4 standard deviations on 6
// means and 6 variances. Control: draws that are 3 % too wide are rejected.
TEST(ExactDraws, OfOneParticleAreStandard) {
  constexpr int kReplicates = 40000;
  vo::Vector6 sum = vo::Vector6::Zero();
  vo::Vector6 squares = vo::Vector6::Zero();
  for (int r = 0; r < kReplicates; ++r) {
    const auto replicate = static_cast<std::uint32_t>(r);
    const vo::Vector6 z = vo::ExactDraws(Normals(16, replicate, vo::Stream::velocity), Normals(16, replicate)).col(3);
    sum += z;
    squares += z.cwiseAbs2();
  }
  const auto off = [](double value, double expected, double deviation) {
    return std::abs(value - expected) / deviation;
  };
  for (int d = 0; d < 6; ++d) {
    EXPECT_LT(off(sum[d], 0, std::sqrt(kReplicates)), 4) << d;
    EXPECT_LT(off(squares[d], kReplicates, std::sqrt(2.0 * kReplicates)), 4) << d;
    EXPECT_GT(off(1.03 * 1.03 * squares[d], kReplicates, std::sqrt(2.0 * kReplicates)), 4) << d;
  }
}

}  // namespace
