// What --compat prints on small trajectories of our own. The texts in compat/expected.txt were printed when every
// golden value of the reference tools was met (tests/unit/judge/evaluation/golden_test.cpp, which needs files that are not
// ours).
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "source_dir.h"
#include "tools/bench/errors.h"
#include "tools/judge/evaluation/compat/evo.h"
#include "tools/judge/evaluation/compat/tum.h"
#include "tools/judge/evaluation/text_file.h"
#include "tools/vobench/arguments.h"

namespace vobench {
namespace {
namespace fs = std::filesystem;
using evaluation::Trajectory;
using testing::HasSubstr;

fs::path Folder() { return fs::path(VOBENCH_SOURCE_DIR) / "tests/unit/vobench/compat"; }
Trajectory Estimate() { return evaluation::ReadTrajectory(Folder() / "estimate.txt"); }
Trajectory TruthRead() { return evaluation::ReadTrajectory(Folder() / "truth.txt"); }

std::string Printed(const std::string& request) { return ParseCompat(request).Run(Estimate(), TruthRead()); }

// "$ REQUEST" and what it prints, again and again.
std::vector<std::pair<std::string, std::string>> Expected() {
  std::ifstream file(Folder() / "expected.txt");
  std::vector<std::pair<std::string, std::string>> all;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("$ ")) {
      all.emplace_back(line.substr(2), "");
    } else {
      all.back().second += line + "\n";
    }
  }
  return all;
}

TEST(Compat, PrintsTheGoldenTexts) {
  const auto expected = Expected();
  EXPECT_EQ(expected.size(), 14u);
  for (const auto& [request, text] : expected) EXPECT_EQ(Printed(request), text) << request;
}

// The script's own draw has these means, of as many pairs. The difference of two such means is within four of its
// standard errors in all but one case of 16 000; the mean over pairs of one second is not.
TEST(Compat, TumRandomPairs) {
  using namespace evaluation::compat;
  constexpr double kPosition_m = 0.060970, kOrientation_deg = 0.740837;
  const evaluation::Rpe drawn = ComputeTumRpe(Estimate(), TruthRead(), {});
  EXPECT_LE(drawn.pairs.size(), 10000u);
  EXPECT_GT(drawn.pairs.size(), 9000u) << "four of 160 poses fall into the gap of the truth";
  const double root = std::sqrt(static_cast<double>(drawn.pairs.size()) / 2);
  const evaluation::Statistics &position = drawn.position_statistics, &orientation = drawn.orientation_statistics;
  EXPECT_NEAR(position.mean, kPosition_m, 4 * position.std / root);
  EXPECT_NEAR(orientation.mean * 180 / M_PI, kOrientation_deg, 4 * orientation.std * 180 / M_PI / root);
  const evaluation::Rpe fixed = ComputeTumRpe(Estimate(), TruthRead(), {.fixed_delta = true});
  EXPECT_GT(std::abs(fixed.position_statistics.mean - kPosition_m), 4 * position.std / root);
}

// The four ways in which evo measures one error are bound to each other.
TEST(Compat, EvosRelationsAgree) {
  using namespace evaluation::compat;
  const auto errors = [](EvoRelation relation) {
    return ComputeEvoApe(Estimate(), TruthRead(), {.relation = relation, .align = true}).errors;
  };
  const auto translation = errors(EvoRelation::translation), rotation = errors(EvoRelation::rotation),
             full = errors(EvoRelation::full), degrees = errors(EvoRelation::angle_deg),
             radians = errors(EvoRelation::angle_rad);
  for (std::size_t i = 0; i < full.size(); ++i) {
    EXPECT_NEAR(full[i] * full[i], translation[i] * translation[i] + rotation[i] * rotation[i], 1e-12);
    EXPECT_NEAR(degrees[i], radians[i] * 180 / M_PI, 1e-12);
    Eigen::AngleAxisd turn(radians[i], Eigen::Vector3d(1, 2, -2).normalized());
    EXPECT_NEAR(rotation[i], (turn.toRotationMatrix() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  }
}

TEST(Compat, UnknownToolsAndOptionsAreNamed) {
  for (const std::string request :
       {"kitti", "", "tum rmse", "evo", "evo traj", "evo ape --delta 3", "ov", "ov affine", "rpg", "evo rpe -d 1.5",
        "evo rpe -u deg", "evo ape -a --align_origin", "tum rpe --delta -1", "tum ate extra"}) {
    try {
      ParseCompat(request);
      ADD_FAILURE() << request;
    } catch (const BadInput& error) {
      EXPECT_THAT(error.what(), HasSubstr("--compat")) << request;
    }
  }
}

TEST(Compat, TimesAndFramesBeyondReasonAreRefused) {
  for (const std::string request :
       {"tum ate --offset 1e300", "tum ate --max_difference 2e9", "tum rpe --offset -2e9",
        "tum rpe --fixed_delta --delta 1e10", "evo ape --t_offset 9.3e9", "evo rpe --t_max_diff 1e300"}) {
    try {
      ParseCompat(request);
      ADD_FAILURE() << request;
    } catch (const BadInput& error) {
      EXPECT_THAT(error.what(), HasSubstr("s at most")) << request;
    }
  }
  for (const std::string request : {"evo rpe -d 1e300", "evo rpe -d 1e19 --all_pairs"}) {
    EXPECT_THROW(Printed(request), evaluation::InputError) << request;
  }
  EXPECT_NO_THROW(ParseCompat("tum rpe --fixed_delta --delta 1e10 --delta_unit f"));
}

TEST(Compat, WhatDoesNotOverlapIsSaid) {
  Trajectory late = Estimate();
  for (auto& pose : late) pose.stamp_ns += 1'000'000'000'000;
  for (const std::string request : {"tum ate", "tum rpe", "evo ape", "evo rpe", "ov se3"}) {
    EXPECT_THROW(ParseCompat(request).Run(late, TruthRead()), evaluation::InputError) << request;
  }
}

}  // namespace
}  // namespace vobench
