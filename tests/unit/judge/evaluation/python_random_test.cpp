// Known answers, printed by Python 3.11.
#include "tools/judge/evaluation/compat/python_random.h"

#include <gmock/gmock.h>

namespace evaluation::compat {
namespace {

using testing::ElementsAre;

std::vector<std::size_t> Draws(PythonRandom random, std::size_t n, int count) {
  std::vector<std::size_t> draws;
  for (int i = 0; i < count; ++i) draws.push_back(random.Below(n));
  return draws;
}

TEST(PythonRandom, DrawsAsPythonDoes) {
  EXPECT_THAT(Draws(PythonRandom(0), 786, 6), ElementsAre(394, 776, 430, 41, 265, 523));
  EXPECT_THAT(Draws(PythonRandom(12345), 100, 6), ElementsAre(53, 93, 1, 38, 47, 24));
}

TEST(PythonRandom, SamplesFromAPool) {
  EXPECT_THAT(PythonRandom(0).Sample(20, 7), ElementsAre(12, 13, 1, 8, 15, 6, 19));
  PythonRandom random(7);
  const std::vector<std::size_t> sample = random.Sample(30000, 10000);
  EXPECT_THAT((std::vector<std::size_t>(sample.end() - 3, sample.end())), ElementsAre(11963, 27859, 13942));
  EXPECT_EQ(random.Below(1000000), 866478u) << "as many draws were used";
}

TEST(PythonRandom, SamplesWithASetFromMany) {
  EXPECT_THAT(PythonRandom(0).Sample(1000000, 6), ElementsAre(885440, 403958, 794772, 933488, 441001, 42450));
  PythonRandom random(7);
  const std::vector<std::size_t> sample = random.Sample(100000, 10000);
  EXPECT_THAT((std::vector<std::size_t>(sample.end() - 3, sample.end())), ElementsAre(58253, 76028, 40423));
  EXPECT_EQ(random.Below(1000000), 556070u);
}

}  // namespace
}  // namespace evaluation::compat
