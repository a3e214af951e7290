// Detection of new features where little of the image has texture, and their selection where the map has little room.
#include "vo/frontend/new_features.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <vector>

#include "tests/unit/vo/texture.h"

namespace {

const vo::Camera kCamera{640, 480, 500, 500, 319.5, 239.5};

// Features of an image with texture in its left quarter, two of the eight columns of cells.
std::vector<vo::NewFeature> Detected(const std::vector<Eigen::Vector2d>& occupied, std::size_t enough) {
  cv::Mat image(480, 640, CV_8UC1, cv::Scalar(90));
  vo_test::Texture(1).Image(160, 480, {0, 0}).copyTo(image.colRange(0, 160));
  return vo::NewFeatureDetector(kCamera, {}, 20).Detect(vo::PreparedFrame({0, image}), occupied, enough);
}

TEST(NewFeatureDetector, UsesTheTextureMoreDenselyWhereThereIsLittle) {
  const std::size_t wanted = 12 * vo::FeatureParams().per_cell;
  const std::vector<vo::NewFeature> few = Detected({}, 0), more = Detected({}, 100);
  EXPECT_EQ(few.size(), wanted);
  EXPECT_GT(more.size(), 1.5 * wanted);
  EXPECT_LE(more.size(), 2 * wanted);
  for (std::size_t i = 0; i < more.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GE((more[i].pixel - more[j].pixel).cast<double>().norm(), vo::FeatureParams().min_distance_px);
}

TEST(NewFeatureDetector, LandmarksInViewCount) {
  std::vector<Eigen::Vector2d> elsewhere;
  for (int i = 0; i < 70; ++i) elsewhere.emplace_back(300 + 5 * (i % 10), 100 + 5 * (i / 10));
  EXPECT_EQ(Detected(elsewhere, 100).size(), Detected(elsewhere, 0).size());
  elsewhere.resize(20);
  EXPECT_GT(Detected(elsewhere, 100).size(), Detected(elsewhere, 0).size());
}

// Eight features in the corner of each quadrant, quadrant by quadrant; the last one lies on the target.
std::vector<vo::NewFeature> Clusters() {
  std::vector<vo::NewFeature> features;
  for (int quadrant = 0; quadrant < 4; ++quadrant)
    for (int i = 0; i < 8; ++i)
      features.push_back({{320 * (quadrant % 2) + 10 * i, 240 * (quadrant / 2) + 10 * i}, std::nullopt});
  features.back().depth = vo::KnownDepth{1.25, 0.01};
  return features;
}

TEST(LimitToCapacity, KeepsAllWhereThereIsRoom) {
  EXPECT_EQ(vo::LimitToCapacity(Clusters(), 32, kCamera).size(), 32u);
  EXPECT_TRUE(vo::LimitToCapacity(Clusters(), 0, kCamera).empty());
}

TEST(LimitToCapacity, SpreadsOverTheImage) {
  const std::vector<vo::NewFeature> kept = vo::LimitToCapacity(Clusters(), 5, kCamera);
  ASSERT_EQ(kept.size(), 5u);
  std::set<std::pair<bool, bool>> quadrants;
  for (const vo::NewFeature& feature : kept) quadrants.insert({feature.pixel.x() >= 320, feature.pixel.y() >= 240});
  EXPECT_EQ(quadrants.size(), 4u);
}

TEST(LimitToCapacity, TargetComesFirst) {
  const std::vector<vo::NewFeature> kept = vo::LimitToCapacity(Clusters(), 1, kCamera);
  ASSERT_EQ(kept.size(), 1u);
  ASSERT_TRUE(kept[0].depth);
  EXPECT_EQ(kept[0].depth->inverse_depth, 1.25);
}

}  // namespace
