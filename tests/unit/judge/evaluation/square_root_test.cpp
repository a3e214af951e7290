#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/judge/evaluation/random.h"
#include "tools/judge/evaluation/draws.h"

namespace evaluation {
namespace {

TEST(SquareRoot, OfAPositiveCovarianceIsItsLowerTriangle) {
  Eigen::Matrix2d P, L;
  P << 4, 1, 1, 2;
  L << 2, 0, 0.5, std::sqrt(1.75);
  const SquareRoot root = SquareRootOf(P);
  EXPECT_TRUE(root.full);
  EXPECT_LT((root.L - L).norm(), 1e-15);
}

TEST(SquareRoot, OfASingularOneIsStillARoot) {
  TestRandom random(100);
  Eigen::MatrixXd A(5, 3);
  for (int i = 0; i < 3; ++i) A.col(i) = random.Normals(5);
  A.row(2).setZero();
  const Eigen::MatrixXd P = A * A.transpose();
  const SquareRoot root = SquareRootOf(P);
  EXPECT_FALSE(root.full);
  EXPECT_LT((root.L * root.L.transpose() - P).norm(), 1e-14 * P.norm());
  EXPECT_EQ(root.L.row(2).norm(), 0);
  EXPECT_EQ(SquareRootOf(Eigen::Matrix3d::Zero()).L, Eigen::Matrix3d::Zero());
}

// Threshold: a pivot of 1e-12 of the correlation matrix, independent of units.
TEST(SquareRoot, Threshold) {
  for (const double pivot : {0.97e-12, 1.03e-12}) {
    Eigen::Matrix2d P;
    P << 1e-8, std::sqrt(1 - pivot), std::sqrt(1 - pivot), 1e8;
    EXPECT_EQ(SquareRootOf(P).full, pivot > 1e-12) << pivot;
  }
  EXPECT_TRUE(SquareRootOf(1e-30 * Eigen::Matrix2d::Identity()).full);
}

// Negative eigenvalues count as zero: for correlations of 1.5 they are 2.5 and -0.5.
TEST(SquareRoot, LeavesOutWhatIsNegative) {
  Eigen::Matrix2d P;
  P << 1, 1.5, 1.5, 1;
  const SquareRoot root = SquareRootOf(P);
  EXPECT_FALSE(root.full);
  EXPECT_LT((root.L * root.L.transpose() - 1.25 * Eigen::Matrix2d::Ones()).norm(), 1e-14);
  P << -1, 0, 0, 4;
  EXPECT_LT(
      (SquareRootOf(P).L * SquareRootOf(P).L.transpose() - Eigen::Matrix2d(Eigen::Vector2d(0, 4).asDiagonal())).norm(),
      1e-14);
}

}  // namespace
}  // namespace evaluation
