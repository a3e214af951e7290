#include "tools/bench/report/thin.h"

#include <gmock/gmock.h>

#include <cmath>

namespace vobench::report {
namespace {

Series Wave(std::size_t size) {
  Series wave;
  for (std::size_t i = 0; i < size; ++i) {
    wave.x.push_back(static_cast<double>(i));
    wave.y.push_back(std::sin(0.001 * static_cast<double>(i)));
  }
  return wave;
}

double Highest(const Numbers& numbers) {
  double highest = -INFINITY;
  for (const double number : numbers) highest = std::fmax(highest, number);
  return highest;
}

TEST(Thin, KeepsEverySpikeAndGap) {
  Series wave = Wave(20'000);
  wave.y[7'777] = 9;
  wave.y[13'131] = -9;
  wave.y[15'000] = NAN;
  const Series thin = Thin(wave, false, 400);
  EXPECT_LT(thin.x.size(), 650u);
  EXPECT_GT(thin.x.size(), 200u);
  EXPECT_THAT(thin.y, testing::Contains(9));
  EXPECT_THAT(thin.y, testing::Contains(-9));
  EXPECT_THAT(thin.y, testing::Contains(testing::NanSensitiveDoubleEq(NAN)));
  EXPECT_EQ(thin.x.size(), thin.y.size());
  EXPECT_TRUE(std::is_sorted(thin.x.begin(), thin.x.end()));
  for (std::size_t i = 0; i < thin.x.size(); ++i) {  // points are points of the series
    const double y = wave.y[static_cast<std::size_t>(thin.x[i])];
    EXPECT_TRUE(thin.y[i] == y || (std::isnan(thin.y[i]) && std::isnan(y)));
  }
}

TEST(Thin, KeepsBothSidesOfABand) {
  Series band = Wave(5'000);
  band.draw = Draw::band;
  band.high = band.y;
  for (double& high : band.high) high += 1;
  band.high[1'234] = 50;
  band.y[4'321] = -50;
  const Series thin = Thin(band, false, 100);
  EXPECT_EQ(Highest(thin.high), 50);
  EXPECT_THAT(thin.y, testing::Contains(-50));
  EXPECT_EQ(thin.high.size(), thin.x.size());
}

TEST(Thin, KeepsTheCornersOfAPath) {
  Series path;  // a long straight line with one jump aside, visible in neither x nor y alone
  for (int i = 0; i < 4'000; ++i) {
    const double aside = i == 1'500 ? 0.5 : 0;
    path.x.push_back(0.01 * i + aside);
    path.y.push_back(0.01 * i - aside);
    path.t.push_back(i);
  }
  const Series thin = Thin(path, true, 100);
  EXPECT_LE(thin.x.size(), 101u);
  EXPECT_THAT(thin.t, testing::Contains(1'500));
  EXPECT_EQ(thin.t.back(), 3'999);
}

TEST(Thin, LeavesShortOnesAlone) {
  const Series wave = Wave(300);
  EXPECT_EQ(Thin(wave, false, 300).y, wave.y);
}

TEST(ThinTo, MakesAllFitAndNoMoreThanThat) {
  Figure figure;
  figure.series = {Wave(50'000), Wave(200), Wave(50'000)};
  figure.series[0].y[12'345] = 99;
  const std::vector<Figure> thin = ThinTo({figure}, 20'000);
  EXPECT_LE(Count(thin), 20'000u);
  EXPECT_GT(Count(thin), 8'000u);
  EXPECT_EQ(thin[0].series[1].x.size(), 200u);
  EXPECT_EQ(Highest(thin[0].series[0].y), 99);
  EXPECT_EQ(Count(ThinTo({figure}, 1'000'000)), Count({figure}));
}

}  // namespace
}  // namespace vobench::report
