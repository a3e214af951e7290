// Patches at equal blur, and the exposure time estimated from the blur of images.

#include "vo/features/motion_blur.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "tests/unit/vo/draws.h"
#include "tests/unit/vo/texture.h"
#include "vo/frontend/exposure_estimate.h"

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

// Image of the texture, which moves by `streak` during the exposure and is at `shift` at mid-exposure.
cv::Mat Exposed(const vo_test::Texture& texture, const Vector2d& shift, const Vector2d& streak) {
  constexpr int kTimes = 32, kSide = 80;
  cv::Mat sharp, sum = cv::Mat::zeros(kSide, kSide, CV_32F), moved, image;
  texture.Image(kSide, kSide, shift).convertTo(sharp, CV_32F);
  for (int k = 0; k < kTimes; ++k) {
    const Vector2d by = ((k + 0.5) / kTimes - 0.5) * streak;
    const cv::Matx23d translation(1, 0, by.x(), 0, 1, by.y());
    cv::warpAffine(sharp, moved, translation, sharp.size(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
    sum += moved / kTimes;
  }
  sum.convertTo(image, CV_8U);
  return vo::Smooth(image);
}

Vector2d RandomStreak(vo_test::Draws& draws, double longest_px) {
  const double angle = 6.2832 * draws.Uniform();
  return longest_px * draws.Uniform() * Vector2d(std::cos(angle), std::sin(angle));
}

TEST(MotionBlur, RelativeBlurMakesSecondMomentsEqual) {
  vo_test::Draws draws(1);
  for (int i = 0; i < 1000; ++i) {
    const Vector2d first = RandomStreak(draws, 10), now = RandomStreak(draws, 10);
    const vo::RelativeBlur blur = vo::RelativeBlur::Of(first, now);
    const Matrix2d of_patch = first * first.transpose() + blur.of_patch * blur.of_patch.transpose();
    const Matrix2d of_image = now * now.transpose() + blur.of_image * blur.of_image.transpose();
    EXPECT_LT((of_patch - of_image).norm(), 1e-12 * 100);
    EXPECT_NEAR(blur.of_patch.dot(blur.of_image), 0, 1e-12 * 100);  // orthogonal: minimal blur
  }
  EXPECT_EQ(vo::RelativeBlur::Of({3, 4}, {3, 4}).of_patch.norm(), 0);
}

// Registration of two views, each with motion blur of 4 to 10 px in a direction of its own. Control: without equal blur
// fewer patches are found, and the error is more than twice as large.
TEST(MotionBlur, PatchesAreRegisteredAtEqualBlur) {
  vo_test::Draws draws(2);
  const Vector2d middle(40, 40);
  double sum = 0, sum_as_they_are = 0;
  int found = 0, found_as_they_are = 0;
  constexpr int kViews = 100;
  for (int i = 0; i < kViews; ++i) {
    const vo_test::Texture texture(static_cast<unsigned>(100 + i), 0.9);
    Vector2d first = RandomStreak(draws, 6), now = RandomStreak(draws, 6);
    first *= (4 + first.norm()) / first.norm();
    now *= (4 + now.norm()) / now.norm();
    const Vector2d shift(draws.Symmetric() / 2, draws.Symmetric() / 2);
    const vo::Patch patch = vo::CutPatch(Exposed(texture, Vector2d::Zero(), first), middle.cast<int>());
    const cv::Mat image = Exposed(texture, -shift, now);
    const vo::RelativeBlur blur = vo::RelativeBlur::Of(first, now);
    if (const auto at =
            vo::Register(Blurred(patch, blur.of_patch), Matrix2d::Identity(), image, middle, 1.5, blur.of_image))
      ++found, sum += (at->pixel - middle - shift).squaredNorm();
    if (const auto at = vo::Register(patch, Matrix2d::Identity(), image, middle, 1.5))
      ++found_as_they_are, sum_as_they_are += (at->pixel - middle - shift).squaredNorm();
  }
  const double rms = std::sqrt(sum / found), rms_as_they_are = std::sqrt(sum_as_they_are / found_as_they_are);
  EXPECT_GE(found, 90);
  EXPECT_LT(rms, 0.25);
  EXPECT_LT(found_as_they_are, found);
  EXPECT_GT(rms_as_they_are, 2 * rms);
  RecordProperty("rms_px", std::to_string(rms) + " " + std::to_string(rms_as_they_are));
}

double EstimatedExposure(double exposure_s, int frames) {
  vo_test::Draws draws(3);
  vo::ExposureEstimate estimate;
  const Vector2d middle(40, 40);
  for (int i = 0; i < frames; ++i) {
    const vo_test::Texture texture(static_cast<unsigned>(500 + i), 0.9);
    const Vector2d first_rate = RandomStreak(draws, 500), rate = RandomStreak(draws, 500);  // [px/s]
    std::vector<vo::LandmarkRecord> records(1);
    records[0].appearance.patch =
        vo::CutPatch(Exposed(texture, Vector2d::Zero(), exposure_s * first_rate), middle.cast<int>());
    const cv::Mat image = Exposed(texture, Vector2d::Zero(), exposure_s * rate);
    estimate.Learn(std::vector<vo::MovingMatch>{{0, Matrix2d::Identity(), middle, first_rate, rate}}, records, image);
  }
  return estimate.seconds();
}

TEST(MotionBlur, ExposureTimeIsThatOfTheImages) {
  for (const double exposure_s : {0.008, 0.015, 0.022})
    EXPECT_NEAR(EstimatedExposure(exposure_s, 120), exposure_s, 0.002) << exposure_s;
  EXPECT_LT(EstimatedExposure(0, 120), 0.002);
  EXPECT_EQ(EstimatedExposure(0.015, 20), 0);  // too few matches
}

}  // namespace
