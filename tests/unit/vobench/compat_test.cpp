// Output of --compat on small trajectories of the project's own. The texts in compat/expected.txt are those of a
// version that meets every golden value of the reference tools (tests/unit/judge/evaluation/golden_test.cpp, which
// needs files that are not in the repository).
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
using evaluation::Reading;
using evaluation::Trajectory;
using testing::HasSubstr;

fs::path Folder() { return fs::path(VOBENCH_SOURCE_DIR) / "tests/unit/vobench/compat"; }
Trajectory Estimate(Reading reading = Reading::strict) {
  return evaluation::ReadTrajectory(Folder() / "estimate.txt", reading);
}
Trajectory TruthRead(Reading reading = Reading::strict) {
  return evaluation::ReadTrajectory(Folder() / "truth.txt", reading);
}

std::string Printed(const std::string& request) {
  const Reproduction tool = ParseCompat(request);
  return tool.Run(Estimate(tool.reading), TruthRead(tool.reading));
}

// Pairs of "$ REQUEST" and its output.
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
  EXPECT_EQ(expected.size(), 21u);
  for (const auto& [request, text] : expected) EXPECT_EQ(Printed(request), text) << request;
}

// Mean over random pairs against that over all: three standard errors, left by one seed of 370; the seed is the
// script's own. Control: the mean over pairs of fixed distance.
TEST(Compat, TumRandomPairs) {
  using namespace evaluation::compat;
  const evaluation::Rpe drawn = ComputeTumRpe(Estimate(), TruthRead(), {});
  const evaluation::Rpe all = ComputeTumRpe(Estimate(), TruthRead(), {.max_pairs = 0});
  EXPECT_LE(drawn.pairs.size(), 10000u);
  EXPECT_EQ(all.pairs.size(), 156u * 156u) << "four of 160 poses fall into the gap of the truth";
  const double root = std::sqrt(static_cast<double>(drawn.pairs.size()));
  const double error = all.position_statistics.std / root;
  EXPECT_NEAR(drawn.position_statistics.mean, all.position_statistics.mean, 3 * error);
  EXPECT_NEAR(drawn.orientation_statistics.mean, all.orientation_statistics.mean,
              3 * all.orientation_statistics.std / root);
  const evaluation::Rpe fixed = ComputeTumRpe(Estimate(), TruthRead(), {.fixed_delta = true});
  EXPECT_GT(std::abs(fixed.position_statistics.mean - all.position_statistics.mean), 3 * error);
}

// Relations between evo's measures of one error: full^2 = translation^2 + rotation^2; degrees and radians; the chordal
// distance of a rotation.
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
       {"kitti", "", "tum rmse", "evo", "evo traj", "evo ape --delta 3", "ov", "ov affine", "rpg --align_type first",
        "evo rpe -d 1.5", "evo rpe -u deg", "evo ape -a --align_origin", "tum rpe --delta -1", "tum ate extra"}) {
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
  EXPECT_NO_THROW(ParseCompat("tum rpe --fixed_delta --delta 1e10 --delta_unit m"));
}

TEST(Compat, WhatDoesNotOverlapIsSaid) {
  Trajectory late = Estimate();
  for (auto& pose : late) pose.stamp_ns += 1'000'000'000'000;
  for (const std::string request : {"tum ate", "tum rpe", "evo ape", "evo rpe", "rpg", "ov se3"}) {
    EXPECT_THROW(ParseCompat(request).Run(late, TruthRead()), evaluation::InputError) << request;
  }
}

}  // namespace
}  // namespace vobench
