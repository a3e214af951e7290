// Pose from landmarks that are recognised without a prediction: two textured walls with exact geometry.
#include "vo/frontend/relocalisation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "tests/unit/vo/texture.h"
#include "tests/unit/vo/two_walls.h"
#include "vo/features/corner_detector.h"
#include "vo/features/matcher.h"

namespace {

using vo_test::kCamera;

constexpr int kBorder_px = 30;

struct Place {
  std::vector<vo::Descriptor> descriptors;
  std::vector<Eigen::Vector3d> points;

  std::vector<vo::KnownPoint> Known() const {
    std::vector<vo::KnownPoint> known;
    for (std::size_t i = 0; i < points.size(); ++i) known.push_back({&descriptors[i], points[i]});
    return known;
  }
};

// Corners of the walls in the image of a camera at `pose`.
Place PlaceSeenFrom(const vo::Pose& pose, const vo_test::Texture& texture) {
  const vo::FeatureParams params = vo_test::SmallImageParams().features;
  const vo::PreparedFrame frame({0, vo_test::ViewFrom(pose, texture)});
  Place place;
  for (const Eigen::Vector2i& corner : vo::DetectCorners(frame.grey, {}, kBorder_px, params)) {
    const Eigen::Vector3d ray = pose.q_WC * kCamera.Undistort(corner.cast<double>()).homogeneous();
    place.descriptors.push_back(frame.brisk.Describe(corner, vo::FirstSampler(params)));
    place.points.push_back(vo_test::OnTheWalls(pose, ray));
  }
  return place;
}

std::optional<vo::Relocalisation> Find(const Place& place, const vo::Pose& pose, const vo_test::Texture& texture) {
  const vo::Relocaliser relocaliser(kCamera, vo_test::SmallImageParams().features, kBorder_px);
  return relocaliser.Find(vo::PreparedFrame({0, vo_test::ViewFrom(pose, texture)}), place.Known());
}

// Accuracy of the pose: 4 px for all landmarks, within reach of the ordinary search.
TEST(Relocaliser, FindsThePose) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const vo_test::Texture texture(seed, 40.0, 24);
    const Place place = PlaceSeenFrom({}, texture);
    const vo::Pose pose{{0.1, -0.05, 0.08}, vo::Exp({0.03, 0.06, 0.02})};
    const std::optional<vo::Relocalisation> found = Find(place, pose, texture);
    ASSERT_TRUE(found) << seed;
    EXPECT_GE(found->inliers.size(), vo::Relocaliser::kLeastInliers);
    EXPECT_TRUE(std::ranges::is_sorted(found->inliers));
    for (const Eigen::Vector3d& X : place.points) {
      const Eigen::Vector3d seen = pose.q_WC.conjugate() * (X - pose.p_WC);
      const Eigen::Vector3d predicted = found->pose.q_WC.conjugate() * (X - found->pose.p_WC);
      EXPECT_LT((kCamera.Project(predicted) - kCamera.Project(seen)).norm(), 4) << seed;
    }
  }
}

// False-alarm rate on other walls: 100 attempts without success bound it at 3 % (95 % confidence).
TEST(Relocaliser, RecognisesNoOtherPlace) {
  const Place place = PlaceSeenFrom({}, vo_test::Texture(1, 40.0, 24));
  for (unsigned seed = 2; seed <= 101; ++seed) EXPECT_FALSE(Find(place, {}, vo_test::Texture(seed, 40.0, 24))) << seed;
}

TEST(Relocaliser, NeedsPoints) {
  Place place = PlaceSeenFrom({}, vo_test::Texture(1, 40.0, 24));
  place.points.resize(vo::Relocaliser::kLeastInliers - 1);
  EXPECT_FALSE(Find(place, {}, vo_test::Texture(1, 40.0, 24)));
  EXPECT_FALSE(Find({}, {}, vo_test::Texture(1, 40.0, 24)));
}

}  // namespace
