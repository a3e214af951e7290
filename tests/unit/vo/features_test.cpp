#include <cstring>

#include <Eigen/LU>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tests/unit/vo/texture.h"
#include "vo/features/corner_detector.h"
#include "vo/features/matcher.h"

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector2i;

using vo_test::Texture;

TEST(CornerDetector, FillsEveryCellAndKeepsItsDistance) {
  const cv::Mat image = Texture(1).Image(640, 480, {0, 0});
  vo::FeatureParams params;
  const int border = 20;
  const std::vector<Vector2d> occupied = {{100, 100}, {103, 105}, {330, 240}};
  const auto corners = vo::DetectCorners(image, occupied, border, params);
  EXPECT_EQ(static_cast<int>(corners.size()), 48 * params.per_cell - 3);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    EXPECT_GE(corners[i].minCoeff(), border);
    EXPECT_LT(corners[i].x(), 640 - border);
    EXPECT_LT(corners[i].y(), 480 - border);
    for (const Vector2d& p : occupied) EXPECT_GE((corners[i].cast<double>() - p).norm(), params.min_distance_px);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GE((corners[i] - corners[j]).cast<double>().norm(), params.min_distance_px);
  }
}

TEST(CornerDetector, FindsNothingOnABlankWallAndNearlyBlankOnlyWithALowThreshold) {
  EXPECT_TRUE(vo::DetectCorners(cv::Mat(480, 640, CV_8UC1, cv::Scalar(90)), {}, 20, {}).empty());
  cv::Mat faint(480, 640, CV_8UC1, cv::Scalar(90));
  cv::rectangle(faint, {300, 200}, {340, 240}, cv::Scalar(105), cv::FILLED);
  cv::GaussianBlur(faint, faint, {5, 5}, 1.0);  // as a lens does; ideal corners tie and suppress each other
  vo::FeatureParams high;
  high.fast_threshold_min = high.fast_threshold_start = 30;
  EXPECT_TRUE(vo::DetectCorners(faint, {}, 20, high).empty());
  EXPECT_GE(vo::DetectCorners(faint, {}, 20, {}).size(), 2u);
}

TEST(BriskField, EqualsOpenCvPixelByPixelAndAsksOnce) {
  const cv::Mat image = Texture(2).Image(200, 160, {0, 0});
  vo::BriskField field(12);
  field.SetImage(image);
  const std::vector<Vector2i> pixels = {{80, 70}, {81, 70}, {80, 70}, {5, 5}, {-3, 500}, {100, 90}};
  field.Compute(pixels);
  field.Compute(pixels);
  auto brisk = cv::BRISK::create();
  for (const Vector2i& p : {Vector2i(80, 70), Vector2i(81, 70), Vector2i(100, 90)}) {
    std::vector<cv::KeyPoint> keypoints = {cv::KeyPoint(static_cast<float>(p.x()), static_cast<float>(p.y()), 12)};
    cv::Mat row;
    brisk->compute(image, keypoints, row);
    ASSERT_NE(field.At(p), nullptr);
    EXPECT_EQ(std::memcmp(field.At(p)->data(), row.data, 64), 0);
  }
  EXPECT_EQ(field.At({5, 5}), nullptr);
  EXPECT_EQ(field.At({-3, 500}), nullptr);
  EXPECT_EQ(field.At({82, 70}), nullptr);
  // The border it states is the border there is.
  const int b = field.border_px();
  field.Compute({{b, b}, {b - 1, b}, {199 - b, 159 - b}, {200 - b, 80}});
  EXPECT_NE(field.At({b, b}), nullptr);
  EXPECT_EQ(field.At({b - 1, b}), nullptr);
  EXPECT_NE(field.At({199 - b, 159 - b}), nullptr);
  EXPECT_EQ(field.At({200 - b, 80}), nullptr);
}

TEST(Hamming, CountsBits) {
  vo::Descriptor a{}, b{};
  EXPECT_EQ(vo::HammingDistance(a, b), 0);
  b[0] = 1;
  b[7] = ~0ULL;
  EXPECT_EQ(vo::HammingDistance(a, b), 65);
}

TEST(Register, FindsAFractionOfAPixelDespiteGainAndOffset) {
  const Texture texture(3);
  const cv::Mat first = texture.Image(120, 100, {0, 0});
  const Vector2i centre(60, 50);
  double worst = 0;
  for (const Vector2d& shift : {Vector2d(0, 0), Vector2d(0.37, -0.61), Vector2d(-0.5, 0.25), Vector2d(0.9, 0.8)}) {
    cv::Mat second = texture.Image(120, 100, shift);
    second.convertTo(second, CV_8U, 0.7, 20);
    const auto found = vo::Register(vo::CutPatch(first, centre), Matrix2d::Identity(), second, centre.cast<double>(), 2.0);
    ASSERT_TRUE(found);
    worst = std::max(worst, (found->pixel - (centre.cast<double>() - shift)).norm());
    EXPECT_GT(found->correlation, 0.99);
  }
  EXPECT_LT(worst, 0.05);  // 0.033 measured: bilinear interpolation of 8-bit grey
}

TEST(Register, FollowsAPredictedChangeOfView) {
  const Texture texture(4);
  const cv::Mat first = texture.Image(120, 100, {0, 0});
  const Vector2i centre(60, 50);
  Matrix2d warp;  // d present / d first
  warp << 1.25, 0.3, -0.3, 1.2;
  const Vector2d seen_at(60.3, 50.4);
  const Matrix2d inverse = warp.inverse();
  const cv::Mat second = texture.Image(120, 100, centre.cast<double>() - inverse * seen_at, inverse);
  const vo::Patch patch = vo::CutPatch(first, centre);
  const auto with = vo::Register(patch, warp, second, {60, 50}, 2.0);
  ASSERT_TRUE(with);
  EXPECT_LT((with->pixel - seen_at).norm(), 0.05);
  EXPECT_GT(with->correlation, 0.99);
  const auto without = vo::Register(patch, Matrix2d::Identity(), second, {60, 50}, 2.0);
  EXPECT_TRUE(!without || without->correlation < with->correlation - 0.02) << "an ignored change of view must show";
}

TEST(Register, RefusesABlankPatchAnEdgeAndTheBorder) {
  const cv::Mat blank(100, 120, CV_8UC1, cv::Scalar(90));
  EXPECT_FALSE(vo::Register(vo::CutPatch(blank, {60, 50}), Matrix2d::Identity(), blank, {60, 50}, 2));
  cv::Mat edge = blank.clone();
  edge.colRange(60, 120).setTo(200);  // slides along itself
  EXPECT_FALSE(vo::Register(vo::CutPatch(edge, {60, 50}), Matrix2d::Identity(), edge, {60, 50}, 2));
  const cv::Mat image = Texture(5).Image(120, 100, {0, 0});
  EXPECT_FALSE(vo::Register(vo::CutPatch(image, {60, 50}), Matrix2d::Identity(), image, {2, 50}, 2));
}

TEST(Matcher, FindsShiftsThatFitTheWindowsAndNoOthers) {
  const Texture texture(6);
  const cv::Mat first = texture.Image(320, 240, {0, 0});
  const auto corners = vo::DetectCorners(first, {}, 60, {.grid_columns = 4, .grid_rows = 3, .per_cell = 2});
  ASSERT_GE(corners.size(), 20u);
  vo::BriskField field(12);
  field.SetImage(first);
  field.Compute(corners);
  std::vector<vo::Appearance> appearances;
  for (const Vector2i& c : corners) appearances.push_back({*field.At(c), vo::CutPatch(first, c)});
  const auto found_share = [&](const Vector2d& shift, double sigma) {
    const cv::Mat second = texture.Image(320, 240, -shift);
    field.SetImage(second);
    std::vector<vo::SearchRequest> requests;
    for (std::size_t i = 0; i < corners.size(); ++i)
      requests.push_back({&appearances[i], corners[i].cast<double>(), sigma * sigma * Matrix2d::Identity()});
    const auto found = vo::FindFeatures(requests, second, field, {});
    int right = 0;
    for (std::size_t i = 0; i < corners.size(); ++i)
      right += found[i] && (*found[i] - corners[i].cast<double>() - shift).norm() < 0.1;
    return right / static_cast<double>(corners.size());
  };
  EXPECT_GE(found_share({2.3, -1.6}, 1), 0.95);   // in 9 x 9
  EXPECT_GE(found_share({-7.4, 6.5}, 1), 0.80);   // in 17 x 17; half-pixel shifts cost BRISK some bits
  EXPECT_EQ(found_share({15.0, -14.0}, 1), 0.0);  // outside both, and the prediction was sure
  EXPECT_GE(found_share({15.0, -14.0}, 8), 0.90); // unsure: the window grows
}

}  // namespace
