// Agreement below which a prediction has failed.
#include "vo/frontend/adaptive_association.h"

#include <gtest/gtest.h>

namespace {

TEST(UsualAgreement, AHalfIsDoubtfulWhereMoreIsUsual) {
  vo::UsualAgreement usual;
  for (int k = 0; k < 50; ++k) EXPECT_EQ(usual.Least(0.9), 0.5);
  EXPECT_EQ(usual.Least(0.45), 0.5);
}

TEST(UsualAgreement, WhereLittleIsUsualLittleIsEnough) {
  vo::UsualAgreement usual;
  int failed = 0;
  for (int k = 0; k < 50; ++k) failed += 0.45 < usual.Least(0.45);
  EXPECT_GT(failed, 3);
  EXPECT_LT(failed, 20);
  EXPECT_EQ(usual.Least(0.1), 0.4) << "0.8 of 0.45 is less";
  for (int k = 0; k < 50; ++k) EXPECT_EQ(usual.Least(0.1), 0.4);
}

}  // namespace
