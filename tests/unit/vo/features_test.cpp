#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/unit/vo/texture.h"
#include "vo/features/brisk.h"
#include "vo/features/corner_detector.h"
#include "vo/features/matcher.h"

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector2i;

using vo_test::Texture;

int HammingDistance(const vo::Descriptor& a, const vo::Descriptor& b) {
  int distance = 0;
  for (std::size_t i = 0; i < a.size(); ++i) distance += std::popcount(a[i] ^ b[i]);
  return distance;
}

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

TEST(CornerDetector, BlankAndFaintWalls) {
  EXPECT_TRUE(vo::DetectCorners(cv::Mat(480, 640, CV_8UC1, cv::Scalar(90)), {}, 20, {}).empty());
  cv::Mat faint(480, 640, CV_8UC1, cv::Scalar(90));
  cv::rectangle(faint, {300, 200}, {340, 240}, cv::Scalar(105), cv::FILLED);
  cv::GaussianBlur(faint, faint, {5, 5}, 1.0);  // blur of a lens; ideal corners tie and suppress each other
  vo::FeatureParams high;
  high.fast_threshold_min = high.fast_threshold_start = 30;
  EXPECT_TRUE(vo::DetectCorners(faint, {}, 20, high).empty());
  EXPECT_GE(vo::DetectCorners(faint, {}, 20, {}).size(), 2u);
}

// Rotation and scale of OpenCV's sampling pattern for a keypoint, quantised as in its tables.
Matrix2d OpenCvMap(const cv::KeyPoint& keypoint) {
  const double step = std::log2(30.0) / 64;
  const int scale = std::max(static_cast<int>(std::log2(keypoint.size / 7.2) / step + 0.5), 0);
  const int rotation = static_cast<int>(1024 * (keypoint.angle / 360.0) + 0.5) % 1024;
  return std::exp2(scale * step) * Eigen::Rotation2Dd(rotation * 2 * M_PI / 1024).toRotationMatrix();
}

// Mean grey level over a square, in 1024ths; each pixel has the weight of its covered share.
double MeanOverSquare(const cv::Mat& image, const Vector2d& centre, double half) {
  const auto share = [&](int pixel, double at) {
    return std::max(0.0, std::min(pixel + 0.5, at + half) - std::max(pixel - 0.5, at - half));
  };
  double sum = 0;
  for (int y = static_cast<int>(centre.y() - half); y <= centre.y() + half + 1; ++y)
    for (int x = static_cast<int>(centre.x() - half); x <= centre.x() + half + 1; ++x)
      sum += share(x, centre.x()) * share(y, centre.y()) * image.at<std::uint8_t>(y, x);
  return std::floor(1024 * sum / (4 * half * half) + 0.5);
}

// Descriptors at OpenCV's own rotation and scale. Two differences remain: OpenCV takes the two lower corners of larger
// squares one pixel too far right and one too high ("ptr += dy * imagecols + 1"), and computes its weights in single
// precision relative to the image's corner, where vo's are relative to the pixel.
TEST(Brisk, IsBriskAndNearlyOpenCvs) {
  int compared = 0, theirs_off = 0, ours_off = 0, apart = 0;
  for (const unsigned seed : {2u, 3u}) {
    const cv::Mat image = Texture(seed).Image(320, 240, {0, 0});
    vo::BriskImage brisk;
    brisk.Set(image);
    for (const float size : {8.f, 12.f, 20.f}) {
      std::vector<cv::KeyPoint> keypoints;
      for (int y = 60; y < 180; y += 7)
        for (int x = 60; x < 260; x += 5) keypoints.emplace_back(static_cast<float>(x), static_cast<float>(y), size);
      cv::Mat rows;
      cv::BRISK::create()->compute(image, keypoints, rows);
      ASSERT_GT(rows.rows, 500);
      for (int i = 0; i < rows.rows; ++i) {
        const cv::KeyPoint& k = keypoints[static_cast<std::size_t>(i)];
        const Vector2i pixel(static_cast<int>(k.pt.x), static_cast<int>(k.pt.y));
        const Matrix2d map = OpenCvMap(k);
        std::array<double, vo::kBriskPoints> means;
        for (std::size_t n = 0; n < means.size(); ++n) {
          const vo::BriskPoint& point = vo::BriskPattern()[n];
          means[n] = MeanOverSquare(image, pixel.cast<double>() + map * Vector2d(point.x, point.y),
                                    std::sqrt(map.determinant()) * point.half_width);
        }
        vo::Descriptor written_out{}, theirs;
        for (std::size_t n = 0; n < 512; ++n) {
          const vo::BriskPair pair = vo::BriskComparisons()[n];
          if (means[pair.first] > means[pair.second]) written_out[n / 64] |= std::uint64_t{1} << (n % 64);
        }
        std::memcpy(theirs.data(), rows.ptr(i), sizeof theirs);
        const vo::Descriptor ours = brisk.Describe(pixel, vo::BriskSampler(map));
        compared += 512;
        theirs_off += HammingDistance(theirs, written_out);
        ours_off += HammingDistance(ours, written_out);
        apart += HammingDistance(ours, theirs);
      }
    }
  }
  const auto share = [&](int different) { return different / static_cast<double>(compared); };
  std::printf("of %d bits differ: OpenCV's from BRISK %.1e, ours %.1e, ours from OpenCV's %.1e\n", compared,
              share(theirs_off), share(ours_off), share(apart));
  EXPECT_LT(share(ours_off), 1e-3);
  EXPECT_LT(share(apart), 0.01);
}

TEST(Brisk, WindowDistancesWithEveryInstructionSet) {
  const cv::Mat image = Texture(4).Image(200, 160, {0, 0});
  vo::BriskImage brisk;
  brisk.Set(image);
  Matrix2d map;
  map << 1.9, 0.4, -0.5, 1.6;
  for (const Matrix2d& m : {Matrix2d(1.6667 * Matrix2d::Identity()), map, Matrix2d(0.3 * map)}) {
    const vo::BriskSampler sampler(m);
    const vo::Descriptor wanted = brisk.Describe({100, 80}, sampler);
    // Rows of all lengths, some beyond the edges.
    std::vector<vo::PixelRun> region;
    for (int y = -3; y < 165; y += 4) region.push_back({y, 100 - y, 100 + y / 3});
    region.push_back({80, -20, 300});
    std::vector<vo::BriskImage::Found> expected;
    for (const vo::PixelRun& run : region)
      for (int x = run.first_x; x <= run.last_x; ++x)
        if (brisk.Describable({x, run.y}, sampler))
          expected.push_back({{x, run.y}, HammingDistance(wanted, brisk.Describe({x, run.y}, sampler))});
    ASSERT_GT(expected.size(), 500u);
    for (const vo::InstructionSet set : vo::AvailableInstructionSets()) {
      std::vector<vo::BriskImage::Found> all;
      const auto best = brisk.Nearest(wanted, sampler, region, set, &all);
      ASSERT_EQ(all.size(), expected.size()) << vo::Name(set);
      for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(all[i].pixel, expected[i].pixel);
        ASSERT_EQ(all[i].distance, expected[i].distance) << vo::Name(set) << ' ' << all[i].pixel.transpose();
      }
      ASSERT_TRUE(best);
      EXPECT_EQ(best->pixel, Vector2i(100, 80));
      EXPECT_EQ(best->distance, 0);
    }
    const std::vector<vo::PixelRun> outside = {{80, -20, 3}, {-4, 50, 60}};
    EXPECT_FALSE(brisk.Nearest(wanted, sampler, outside));
  }
  EXPECT_THROW(brisk.Describe({3, 3}, vo::BriskSampler(map)), std::invalid_argument);
}

TEST(Register, FindsAFractionOfAPixelDespiteGainAndOffset) {
  const Texture texture(3);
  const cv::Mat first = texture.Image(120, 100, {0, 0});
  const Vector2i centre(60, 50);
  double worst = 0;
  for (const Vector2d& shift : {Vector2d(0, 0), Vector2d(0.37, -0.61), Vector2d(-0.5, 0.25), Vector2d(0.9, 0.8)}) {
    cv::Mat second = texture.Image(120, 100, shift);
    second.convertTo(second, CV_8U, 0.7, 20);
    const auto found =
        vo::Register(vo::CutPatch(first, centre), Matrix2d::Identity(), second, centre.cast<double>(), 2.0);
    ASSERT_TRUE(found);
    worst = std::max(worst, (found->pixel - (centre.cast<double>() - shift)).norm());
    EXPECT_GT(found->correlation, 0.99);
  }
  EXPECT_LT(worst, 0.05);  // 0.033 measured: bilinear interpolation of 8-bit grey
}

// Normalised squared errors of registration with white noise in both images. Their mean is 1.95 per axis, not 1: the
// gradients are noisy too, and interpolation correlates the residuals; NoiseLevel compensates for both. Mean over 400
// registrations within 0.3: 3 standard deviations, false-alarm rate 3e-3.
TEST(Register, CovarianceMatchesErrors) {
  const Texture texture(7);
  const Vector2i centre(60, 50);
  const cv::Mat first = texture.Image(120, 100, {0, 0});
  cv::RNG random(11);
  double sum = 0;
  int count = 0;
  for (int draw = 0; draw < 400; ++draw) {
    const Vector2d shift{random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)};
    cv::Mat views[2] = {first.clone(), texture.Image(120, 100, shift)};
    for (cv::Mat& view : views) {
      cv::Mat noise(view.size(), CV_16S);
      random.fill(noise, cv::RNG::NORMAL, 0, 6);
      cv::add(view, noise, view, cv::noArray(), CV_8U);
      view = vo::Smooth(view);
    }
    const auto found =
        vo::Register(vo::CutPatch(views[0], centre), Matrix2d::Identity(), views[1], centre.cast<double>(), 2.0);
    if (!found) continue;
    const Vector2d error = found->pixel - (centre.cast<double>() - shift);
    sum += error.dot(found->covariance.inverse() * error);
    count += 2;
  }
  std::printf("registration: NEES / dof %.2f over %d\n", sum / count, count / 2);
  EXPECT_GT(count, 700);
  EXPECT_NEAR(sum / count, 1.95, 0.3);
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

TEST(Register, RefusesABlankPatchAndTheBorder) {
  const cv::Mat blank(100, 120, CV_8UC1, cv::Scalar(90));
  EXPECT_FALSE(vo::Register(vo::CutPatch(blank, {60, 50}), Matrix2d::Identity(), blank, {60, 50}, 2));
  const cv::Mat image = Texture(5).Image(120, 100, {0, 0});
  EXPECT_FALSE(vo::Register(vo::CutPatch(image, {60, 50}), Matrix2d::Identity(), image, {2, 50}, 2));
}

// Bright half-plane, or quarter-plane (`corner`), in an image of 120 x 100: integrated over each pixel, with noise of
// three grey levels, smoothed.
cv::Mat Edge(double angle, const Vector2d& through, double contrast, bool corner, std::uint64_t seed) {
  const Vector2d across(-std::sin(angle), std::cos(angle)), along(std::cos(angle), std::sin(angle));
  cv::Mat image(100, 120, CV_8UC1);
  cv::RNG random(seed);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) {
      int bright = 0;
      for (int v = 0; v < 8; ++v)
        for (int u = 0; u < 8; ++u) {
          const Vector2d p = Vector2d(x + (u - 3.5) / 8, y + (v - 3.5) / 8) - through;
          bright += across.dot(p) > 0 && (!corner || along.dot(p) > 0);
        }
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(60 + contrast * bright / 64 + random.gaussian(3));
    }
  return vo::Smooth(image);
}

// Covariance at an edge (aperture problem): no information along it, neither from pixel steps nor from noise; full
// information across it, and in both directions at a corner. A match 30 px off along the edge with a standard deviation
// of half a pixel rotates the start of a sequence by 7 mrad.
TEST(Register, NoInformationAlongAnEdge) {
  const Vector2i centre(60, 50);
  cv::RNG random(5);
  double least_along = 1e9, most_across = 0, most_of_a_corner = 0;
  for (int degrees = 0; degrees < 180; degrees += 4)
    for (const double contrast : {20.0, 60.0, 150.0})
      for (const bool corner : {false, true}) {
        const double angle = degrees * std::numbers::pi / 180;
        const Vector2d across(-std::sin(angle), std::cos(angle)), along(std::cos(angle), std::sin(angle));
        const double slid = corner ? 0 : random.uniform(-30.0, 30.0);
        const double offset = random.uniform(-0.5, 0.5), moved = random.uniform(-0.5, 0.5);
        const Vector2d through = centre.cast<double>() + offset * across;
        const cv::Mat first = Edge(angle, through, contrast, corner, random.next());
        const cv::Mat second = Edge(angle, through + moved * across + slid * along, contrast, corner, random.next());
        const auto found =
            vo::Register(vo::CutPatch(first, centre), Matrix2d::Identity(), second, centre.cast<double>(), 2.0);
        ASSERT_TRUE(found) << degrees << ' ' << contrast;
        const auto sigma = [&](const Vector2d& axis) { return std::sqrt(axis.dot(found->covariance * axis)); };
        if (corner) {
          if (contrast >= 60) most_of_a_corner = std::max({most_of_a_corner, sigma(across), sigma(along)});
          continue;
        }
        least_along = std::min(least_along, sigma(along));
        if (contrast >= 60) most_across = std::max(most_across, sigma(across));
        EXPECT_LT(std::abs(across.dot(found->pixel - centre.cast<double>()) - moved), 4 * sigma(across) + 0.03)
            << degrees << ' ' << contrast;
      }
  std::printf("along edges at least %.2f px, across at most %.3f; corners at most %.3f\n", least_along, most_across,
              most_of_a_corner);
  EXPECT_GT(least_along, 3.5);  // the window's half width is 4
  EXPECT_LT(most_across, 0.3);  // gradients of a sharp edge are up to four degrees off
  EXPECT_LT(most_of_a_corner, 0.1);
}

TEST(Matcher, FindsShiftsThatFitTheWindowsAndNoOthers) {
  const Texture texture(6);
  const cv::Mat first = texture.Image(320, 240, {0, 0});
  const auto corners = vo::DetectCorners(first, {}, 60, {.grid_columns = 4, .grid_rows = 3, .per_cell = 2});
  ASSERT_GE(corners.size(), 20u);
  vo::BriskImage brisk;
  brisk.Set(first);
  std::vector<vo::Appearance> appearances;
  for (const Vector2i& c : corners)
    appearances.push_back({brisk.Describe(c, vo::FirstSampler({})), vo::CutPatch(first, c)});
  const auto found_share = [&](const Vector2d& shift, double sigma) {
    const cv::Mat second = texture.Image(320, 240, -shift);
    brisk.Set(second);
    std::vector<vo::SearchRequest> requests;
    for (std::size_t i = 0; i < corners.size(); ++i)
      requests.push_back({&appearances[i], corners[i].cast<double>(), sigma * sigma * Matrix2d::Identity()});
    const auto found = vo::FindFeatures(requests, second, brisk, {});
    int right = 0;
    for (std::size_t i = 0; i < corners.size(); ++i)
      right += found[i].found && (found[i].found->pixel - corners[i].cast<double>() - shift).norm() < 0.1;
    return right / static_cast<double>(corners.size());
  };
  EXPECT_GE(found_share({2.3, -1.6}, 1), 0.95);           // in 9 x 9
  EXPECT_GE(found_share({-7.4, 6.5}, 1), 0.80);           // in 17 x 17; half-pixel shifts cost BRISK some bits
  EXPECT_EQ(found_share({15.0, -14.0}, 1), 0.0);          // outside both windows, small covariance
  EXPECT_GE(found_share({15.0, -14.0}, 8), 0.90);         // large covariance: larger window
  for (const double nothing_known : {1e9, 1e100, 1e160})  // no information
    EXPECT_EQ(found_share({15.0, -14.0}, nothing_known), found_share({15.0, -14.0}, 80)) << nothing_known;
}

TEST(Matcher, WindowCoversAnyPrediction) {
  EXPECT_EQ(vo::WindowSide(Matrix2d::Identity()), 7);
  EXPECT_EQ(vo::WindowSide(Vector2d(4, 100).asDiagonal()), 51);
  for (const double sigma : {1e6, 1e9, 1e100, 1e160})
    EXPECT_GE(vo::WindowSide(sigma * sigma * Matrix2d::Identity()), 100'000) << sigma;
}

TEST(Matcher, OutOfTheImageIsOutOfSight) {
  const cv::Mat image = Texture(6).Image(320, 240, {0, 0});
  vo::BriskImage brisk;
  brisk.Set(image);
  const vo::BriskSampler sampler = vo::FirstSampler({});
  const Vector2i corner(sampler.margin(), 120);
  const vo::Appearance appearance{brisk.Describe(corner, sampler), vo::CutPatch(image, corner)};
  vo::SearchRequest as_it_was{&appearance, corner.cast<double>(), Matrix2d::Identity()}, nearer = as_it_was;
  nearer.warp = 2 * Matrix2d::Identity();
  const auto results = vo::FindFeatures({as_it_was, nearer}, image, brisk, {});
  EXPECT_TRUE(results[0].in_sight && results[0].found);
  EXPECT_FALSE(results[1].in_sight || results[1].found);
  nearer.predicted = {160, 120};  // inside the image, where the landmark is not
  const auto elsewhere = vo::FindFeatures({nearer}, image, brisk, {});
  EXPECT_TRUE(elsewhere[0].in_sight);
}

}  // namespace
