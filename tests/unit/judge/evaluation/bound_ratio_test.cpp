#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tools/judge/evaluation/cramer_rao.h"

namespace evaluation {
namespace {

// Two runs, of two frames and one. Errors of each block: of length 5, 2, 1 and 0.
TEST(CompareWithBound, ByHand) {
  Vector12d e = Vector12d::Zero();
  e << 3, 4, 0, 0, 0, -2, 1, 0, 0, 0, 0, 0;
  Matrix12d B = 0.5 * Matrix12d::Identity();
  B.topLeftCorner<3, 3>() *= 4;
  B(0, 1) = B(1, 0) = 0.3;
  const BoundRatio ratio = CompareWithBound({{e, e}, {2 * e}}, {{B, 3 * B}, {B}});
  const double squares[] = {6 * 25, 6 * 4, 6, 0}, traces[] = {5 * 6, 5 * 1.5, 5 * 1.5, 5 * 1.5};
  for (std::size_t b = 0; b < 4; ++b) {
    EXPECT_NEAR(ratio.overall[b], std::sqrt(squares[b] / traces[b]), 1e-12) << b;
    EXPECT_NEAR(ratio.rmse[b], std::sqrt(squares[b] / 3), 1e-12) << b;
    EXPECT_NEAR(ratio.bound[b], std::sqrt(traces[b] / 3), 1e-12) << b;
  }
  EXPECT_TRUE(std::isnan(CompareWithBound({{e}}, {{Matrix12d::Zero()}}).overall[0]));
  EXPECT_NEAR(CompareWithBound({{e}}, {{0.01 * B}}).overall[1], std::sqrt(4 / 0.015), 1e-12) << "a trace below one";
  EXPECT_THROW(CompareWithBound({{e}}, {}), std::logic_error);
  EXPECT_THROW(CompareWithBound({{e}}, {{B, B}}), std::logic_error);
}

}  // namespace
}  // namespace evaluation
