// Coarse-to-fine matching: pose from few matches, choice of the coarse features, and their effect on images.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "tests/unit/vo/texture.h"
#include "vo/features/corner_detector.h"
#include "vo/frontend/search_set.h"
#include "vo/geometry/so3.h"
#include "vo/odometry.h"

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const vo::Camera kCamera{640, 480, 500, 500, 319.5, 239.5};

// Known points 1 to 3 m in front of their anchor; the prediction of the camera's pose is off by 0.1 rad and 4 cm.
struct Scene {
  std::vector<vo::Landmark> landmarks;
  std::vector<int> anchor_of;
  std::vector<vo::Pose> anchors{vo::Pose{}};
  vo::PoseGaussian prediction;
  vo::Pose truth;
  vo::LocalMap map() const { return {landmarks, anchor_of, anchors}; }

  Vector2d SeenAt(int n) const { return vo::Project({truth, anchors[0]}, landmarks[n].mean).z; }
  std::vector<vo::Match> Matches(int count) const {
    std::vector<vo::Match> matches;
    for (int n = 0; n < count; ++n) matches.push_back({n, SeenAt(n), 1.96e-6 * Eigen::Matrix2d::Identity()});
    return matches;
  }
};

Scene MakeScene() {
  Scene scene;
  for (int n = 0; n < 60; ++n) {
    vo::Landmark landmark;
    landmark.mean = {0.45 * std::sin(2.4 * n), 0.3 * std::cos(1.7 * n), 0.33 + 0.67 * (n % 7) / 6.0};
    landmark.covariance.diagonal() << 1e-8, 1e-8, 1e-6;
    scene.landmarks.push_back(landmark);
    scene.anchor_of.push_back(0);
  }
  scene.prediction.mean = {Vector3d(0.02, -0.01, 0.03), vo::Exp({0.01, 0.02, -0.01})};
  scene.prediction.covariance.diagonal() << 1e-2, 1e-2, 1e-2, 1e-2, 1e-2, 1e-2;
  vo::Vector6 off;
  off << 0.03, -0.02, 0.02, 0.04, -0.06, 0.07;
  scene.truth = vo::Plus(scene.prediction.mean, off);
  return scene;
}

// Largest prediction error [px] of the landmarks beyond the first `coarse`.
double Worst(const Scene& scene, const vo::PoseGaussian& pose, int coarse) {
  const vo::MapView view(scene.map(), pose.mean);
  double worst = 0;
  for (int n = coarse; n < static_cast<int>(scene.landmarks.size()); ++n) {
    const auto where = vo::PredictPixel(pose, view, n, kCamera, 0.7);
    if (!where) return std::numeric_limits<double>::infinity();
    const Vector2d z = scene.SeenAt(n);
    worst = std::max(worst, (where->pixel - kCamera.Project({z.x(), z.y(), 1})).norm());
  }
  return worst;
}

TEST(CoarseFeatures, TellWhereAllOthersAre) {
  const Scene scene = MakeScene();
  const auto pose = vo::FitCoarsePose(scene.prediction, scene.map(), scene.Matches(16), {});
  ASSERT_TRUE(pose);
  EXPECT_LT(Worst(scene, *pose, 16), 0.05);  // exact matches; the prior has 1e-4 of their weight
  double plain = 0;
  for (int n = 16; n < 60; ++n) {
    const Vector2d z = vo::Project({scene.prediction.mean, scene.anchors[0]}, scene.landmarks[n].mean).z;
    plain += 500 * (z - scene.SeenAt(n)).norm() / 44;
  }
  EXPECT_GT(plain, 20) << "the prediction alone is far off";
}

TEST(CoarseFeatures, AreNotMovedByOutliers) {
  const Scene scene = MakeScene();
  std::vector<vo::Match> matches = scene.Matches(16);
  for (int n = 0; n < 16; n += 4) matches[n].z += Vector2d(0.05, -0.03);  // 29 px in one direction: a moving object
  const auto pose = vo::FitCoarsePose(scene.prediction, scene.map(), matches, {});
  ASSERT_TRUE(pose);
  EXPECT_LT(Worst(scene, *pose, 16), 0.7);
}

TEST(CoarseFeatures, CovarianceMatchesErrors) {
  Scene scene = MakeScene();
  scene.landmarks[40].covariance(2, 2) = 0.04;  // a depth of large variance
  const auto pose = vo::FitCoarsePose(scene.prediction, scene.map(), scene.Matches(16), {});
  ASSERT_TRUE(pose);
  const vo::MapView view(scene.map(), pose->mean);
  const auto sigma = [&](int n) {
    return std::sqrt(vo::PredictPixel(*pose, view, n, kCamera, 0.7)->covariance.trace() / 2);
  };
  EXPECT_LT(sigma(41), 1.2);
  EXPECT_GT(sigma(40), 2 * sigma(41));
}

TEST(CoarseFeatures, SayNothingWhenFewOrAtOdds) {
  const Scene scene = MakeScene();
  EXPECT_FALSE(vo::FitCoarsePose(scene.prediction, scene.map(), scene.Matches(5), {}));
  std::vector<vo::Match> matches = scene.Matches(16);
  for (int n = 0; n < 16; ++n)
    matches[n].z += 0.1 * Vector2d(std::sin(7.0 * n), std::cos(11.0 * n));  // in different directions
  EXPECT_FALSE(vo::FitCoarsePose(scene.prediction, scene.map(), matches, {}));
}

TEST(CoarseFeatures, AreSettledPreciseAndSpread) {
  std::vector<vo::LandmarkRecord> records(100);
  std::vector<vo::Candidate> candidates(100);
  for (int n = 0; n < 100; ++n) {
    records[n].age = 30;
    records[n].score = n < 50 ? 0.5 : 0.99;  // two at each pixel: one of high score, one of low
    candidates[n].landmark = n;
    candidates[n].pixel = Vector2d(32 + 64 * (n % 10), 48 + 96 * (n % 50 / 10));
  }
  vo::FeatureParams params;
  params.coarse_features = 16;
  const std::vector<std::size_t> coarse =
      vo::SelectCoarseFeatures(candidates, records, kCamera, params, vo::Search::usual);
  ASSERT_EQ(coarse.size(), 16u);
  std::set<std::pair<int, int>> cells;
  for (const std::size_t i : coarse) {
    EXPECT_GE(i, 50u) << "the sure ones come first";
    cells.insert({static_cast<int>(candidates[i].pixel.x() / 160), static_cast<int>(candidates[i].pixel.y() / 120)});
  }
  EXPECT_EQ(cells.size(), 16u) << "one in each part of the image";

  for (int n = 10; n < 100; ++n) records[n].age = 9;
  EXPECT_TRUE(vo::SelectCoarseFeatures(candidates, records, kCamera, params, vo::Search::usual).empty())
      << "ten settled landmarks are not sixteen";
  for (int n = 10; n < 100; ++n) records[n].frames_unmatched = n % 10 == 0 ? 0 : 1;
  const std::vector<std::size_t> young =
      vo::SelectCoarseFeatures(candidates, records, kCamera, params, vo::Search::wide);
  EXPECT_EQ(young.size(), 16u);
  for (const std::size_t i : young) EXPECT_TRUE(i < 10 || i % 10 == 0) << i << ": not matched in the last frame";
  params.coarse_features = 0;
  EXPECT_TRUE(vo::SelectCoarseFeatures(candidates, records, kCamera, params, vo::Search::usual).empty());
}

TEST(BucketRoundRobin, TakesOneOfEachCellBeforeASecond) {
  const std::vector<Vector2d> pixels = {{10, 10}, {20, 20}, {30, 30}, {500, 400}, {510, 410}, {500, 10}};
  EXPECT_EQ(vo::BucketRoundRobin(pixels, 2, 2, 640, 480), (std::vector<std::size_t>{0, 3, 5, 1, 4, 2}));
}

// Pose of a camera 2 m in front of a textured wall. In frame 12 it rotates by 0.025 rad (12 px), against the motion
// model.
vo::Pose JoltedAt(int k) { return {Vector3d(0.01 * k, 0.004 * k, 0), vo::Exp({0, k < 12 ? 0.0 : 0.025, 0})}; }

cv::Mat ViewFrom(const vo::Pose& pose, const vo_test::Texture& texture) {
  cv::Mat image(kCamera.height, kCamera.width, CV_8UC1);
  const Eigen::Matrix3d R = pose.q_WC.toRotationMatrix();
  for (int y = 0; y < kCamera.height; ++y)
    for (int x = 0; x < kCamera.width; ++x) {
      const Vector3d ray = R * Vector3d((x - kCamera.cx) / kCamera.fx, (y - kCamera.cy) / kCamera.fy, 1);
      const Vector3d X = pose.p_WC + ray * (2 - pose.p_WC.z()) / ray.z();
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(texture.At(X.head<2>()));
    }
  return image;
}

std::vector<vo::Estimate> Track(const std::vector<cv::Mat>& images, int coarse) {
  vo::Params params;
  params.features.coarse_features = coarse;
  params.motion.orientation_noise = 4;
  vo::Prior prior;
  prior.v_WC = {0.3, 0.12, 0};
  prior.velocity_covariance = 1e-3 * vo::Matrix6::Identity();
  vo::Odometry odometry(kCamera, params, prior, 1);
  std::vector<vo::Estimate> estimates;
  for (std::size_t k = 0; k < images.size(); ++k)
    estimates.push_back(odometry.Track({static_cast<std::int64_t>(k) * 33'333'333, images[k]}));
  return estimates;
}

TEST(CoarseFeatures, FollowAJoltAndTooManyAreNone) {
  const vo_test::Texture texture(1, 80.0, 24);
  std::vector<cv::Mat> images;
  for (int k = 0; k < 14; ++k) images.push_back(ViewFrom(JoltedAt(k), texture));
  const std::vector<vo::Estimate> with = Track(images, 16), without = Track(images, 0),
                                  too_many = Track(images, 100'000);
  EXPECT_GE(with[12].diagnostics.matched, 0.8 * with[11].diagnostics.matched);
  EXPECT_GE(with[12].diagnostics.matched, without[12].diagnostics.matched);
  EXPECT_LT(vo::Log(with[12].pose.q_WC.conjugate() * JoltedAt(12).q_WC).norm(),
            0.0125);  // half of the rotation; 0.025 without any response
  bool differs = false;
  for (std::size_t k = 0; k < images.size(); ++k) {
    EXPECT_EQ(without[k].pose.p_WC, too_many[k].pose.p_WC) << k;
    EXPECT_EQ(without[k].covariance, too_many[k].covariance) << k;
    differs = differs || without[k].pose.p_WC != with[k].pose.p_WC;
  }
  EXPECT_TRUE(differs) << "coarse features change the estimate";
}

// Share of the landmarks matched before a dark interval that are matched after it. The interval is a third of a second,
// in which the camera rotates by 0.12 rad (58 px) against the motion model.
double OldAfterTheDark(const std::vector<cv::Mat>& images, int search_relocalise_px) {
  vo::Params params;
  params.features.search_relocalise_px = search_relocalise_px;
  vo::Prior prior;
  prior.v_WC = {0.3, 0.12, 0};
  prior.velocity_covariance = 1e-3 * vo::Matrix6::Identity();
  vo::Odometry odometry(kCamera, params, prior, 1);
  std::set<int> old;
  std::int64_t stamp = 0;
  const auto matched = [&] {
    std::set<int> ids;
    for (const vo::FeatureView& view : odometry.Features())
      if (view.status == vo::FeatureView::Status::matched) ids.insert(view.id);
    return ids;
  };
  for (const cv::Mat& image : images) {
    odometry.Track({stamp, image});
    stamp += 33'333'333;
    if (old.size() < matched().size()) old = matched();
  }
  int found = 0;
  for (const int id : matched()) found += old.contains(id);
  return static_cast<double>(found) / static_cast<double>(old.size());
}

TEST(CoarseFeatures, FindTheOldLandmarksAfterADarkTime) {
  const vo_test::Texture texture(1, 80.0, 24);
  std::vector<cv::Mat> images;
  for (int k = 0; k < 20; ++k)
    images.push_back(ViewFrom({Vector3d(0.01 * k, 0.004 * k, 0), Eigen::Quaterniond::Identity()}, texture));
  images.insert(images.end(), 10, cv::Mat(kCamera.height, kCamera.width, CV_8UC1, cv::Scalar(90)));
  images.push_back(ViewFrom({Vector3d(0.3, 0.12, 0), vo::Exp({0, 0.12, 0})}, texture));
  EXPECT_GT(OldAfterTheDark(images, vo::FeatureParams().search_relocalise_px), 0.5);
  EXPECT_LT(OldAfterTheDark(images, vo::FeatureParams().search_uncertain_px), 0.1)
      << "the control: windows do not reach";
}

}  // namespace
