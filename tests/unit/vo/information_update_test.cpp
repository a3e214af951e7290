#include "vo/filter/information_update.h"

#include <gtest/gtest.h>

#include "vo/filter/path_linearisation.h"

namespace vo {
namespace {

using Eigen::MatrixXd;

constexpr double kRounding = 1e-13;  // of sums of some ten products of numbers up to 1

// A matrix of numbers in [-1, 1], the same on every machine.
MatrixXd Numbers(int rows, int columns, unsigned seed) {
  MatrixXd X(rows, columns);
  for (double& x : X.reshaped()) {
    seed = 1664525u * seed + 1013904223u;
    x = seed * 0x1p-31 - 1;
  }
  return X;
}

MatrixXd Lower(const MatrixXd& A) { return A.triangularView<Eigen::Lower>(); }

TEST(InformationUpdate, SubtractsTheSquare) {
  for (int rows = 1; rows <= 35; ++rows) {
    for (const int columns : {1, 3, 36}) {
      const MatrixXd wide_Y = Numbers(rows + 5, columns, 1), wide_A = Numbers(rows + 7, rows + 7, 2);
      const auto Y = wide_Y.middleRows(3, rows);
      MatrixXd first;
      for (const InstructionSet set : AvailableInstructionSets()) {
        MatrixXd A = wide_A;
        SubtractSquare(Y, A.block(4, 4, rows, rows), set);
        MatrixXd expected = wide_A;
        expected.block(4, 4, rows, rows) -= Y * Y.transpose();
        ASSERT_LT(Lower(A - expected).cwiseAbs().maxCoeff(), kRounding) << rows << " x " << columns << Name(set);
        if (first.size() == 0) first = A;
        ASSERT_EQ(Lower(A), Lower(first)) << Name(set);  // to the bit
      }
    }
  }
}

template <int kSize>
void ExpectProductsAdded() {
  const MatrixXd X = Numbers(kRateSlotSize, 2, 3), Z = Numbers(kRateSlotSize, 2, 4), J = Numbers(2, kSize, 5),
                 K = Numbers(2, kSize, 6), before = Numbers(40, 40, 7);
  const int i = 20, j = 3;
  for (const InstructionSet set : AvailableInstructionSets()) {
    for (const bool anchored : {false, true}) {
      MatrixXd A = before, expected = before;
      AddProducts<kSize>(
          {X.data(), J.data(), anchored ? Z.data() : nullptr, K.data(), &A(i, i), &A(j, j), &A(i, j), 40}, set);
      expected.block<kSize, kSize>(i, i) += X.topRows<kSize>() * J;
      if (anchored) {
        expected.block<kSize, kSize>(j, j) += Z.topRows<kSize>() * K;
        expected.block<kSize, kSize>(i, j) += X.topRows<kSize>() * K;
      }
      EXPECT_LT((A - expected).cwiseAbs().maxCoeff(), kRounding) << Name(set) << anchored;
    }
  }
}

TEST(InformationUpdate, AddsTheProductsOfAView) {
  ExpectProductsAdded<kPoseSize>();
  ExpectProductsAdded<kRateSlotSize>();
}

}  // namespace
}  // namespace vo
