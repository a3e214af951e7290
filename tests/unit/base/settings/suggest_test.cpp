#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <string>

#include "tools/base/settings/state.h"

namespace settings {
namespace {

TEST(EditDistance, KnownPairs) {
  EXPECT_EQ(EditDistance("", ""), 0u);
  EXPECT_EQ(EditDistance("", "abc"), 3u);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3u);
  EXPECT_EQ(EditDistance("widht", "width"), 1u) << "a swap of neighbours is one mistake";
  EXPECT_EQ(EditDistance("expossure", "exposure"), 1u);
}

TEST(EditDistance, IsADistance) {
  EXPECT_TRUE(rc::check([](const std::string& a, const std::string& b) {
    RC_ASSERT(EditDistance(a, b) == EditDistance(b, a));
    RC_ASSERT((EditDistance(a, b) == 0) == (a == b));
    RC_ASSERT(EditDistance(a, b) <= std::max(a.size(), b.size()));
    RC_ASSERT(EditDistance(a + "x", b + "x") <= EditDistance(a, b));
  }));
}

TEST(Suggest, TheNearestKnownKey) {
  EXPECT_EQ(Suggest("exposhure", {"gain", "exposure", "white"}), "; did you mean 'exposure'?");
  EXPECT_EQ(Suggest("expo", {"gain", "exposure"}), "; did you mean 'exposure'?") << "a beginning of it";
  EXPECT_EQ(Suggest("zoom", {"gain", "exposure", "room_size"}), "; known: exposure, gain, room_size");
  EXPECT_EQ(Suggest("q", {"p"}), "; known: p") << "one letter for another is no likeness";
  EXPECT_EQ(Suggest("x", {}), "; none is known here");
}

}  // namespace
}  // namespace settings
