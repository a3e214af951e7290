// Which of the detected features become landmarks where the map has little room.
#include "vo/frontend/new_features.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <vector>

namespace {

const vo::Camera kCamera{640, 480, 500, 500, 319.5, 239.5};

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
