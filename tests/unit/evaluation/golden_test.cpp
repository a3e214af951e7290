// Every figure of the reference tools that a mode of ours reproduces, digit for digit, read from the file of golden
// values: TUM's ATE and RPE scripts, evo, rpg_trajectory_evaluation and ov_eval on the TUM RGB-D trajectories beside
// it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>

#include "tools/evaluation/ate.h"
#include "tools/evaluation/rpe.h"
#include "tools/evaluation/rpe_tum.h"

namespace evaluation {
namespace {

constexpr double kDegrees = 180 / M_PI;

// The number that follows a key ("rmse=", "rmse "), as written; nothing when the key is not there.
std::optional<std::string> Written(const std::string& line, const std::string& key) {
  const std::size_t at = line.find(key);
  if (at == std::string::npos) return std::nullopt;
  const std::size_t begin = at + key.size();
  return line.substr(begin, line.find_first_not_of("0123456789.", begin) - begin);
}

class Golden : public testing::Test {
 protected:
  void SetUp() override {
    const char* set = std::getenv("VOBENCH_DATA");
    const std::filesystem::path data = set != nullptr
                                           ? std::filesystem::path(set)
                                           : std::filesystem::path(VOBENCH_SOURCE_DIR) / ".." / "shared" / "data";
    folder_ = data / "golden";
    if (!std::filesystem::exists(folder_ / "values.txt")) {
      GTEST_SKIP() << "no golden values in " << folder_ << "; set VOBENCH_DATA to the folder that holds golden/";
    }
  }

  // Calls check(line, estimate, truth) for every line of values.txt that follows `header` of either input and starts
  // with `prefix`.
  template <class Check>
  void ForEach(const std::string& prefix, const Check& check) {
    const std::pair<const char*, const char*> inputs[] = {
        {"freiburg1_xyz-rgbdslam.txt", "freiburg1_xyz-groundtruth.txt"},
        {"fr2_desk_ORB.txt", "fr2_desk_groundtruth.txt"}};
    std::ifstream values(folder_ / "values.txt");
    const std::pair<const char*, const char*>* input = nullptr;
    for (std::string line; std::getline(values, line);) {
      if (line.starts_with("=====") || line.starts_with("==")) input = nullptr;
      for (const auto& candidate : inputs) {
        if ((line.starts_with("==") || line.starts_with(candidate.first)) &&
            line.find(candidate.first) != std::string::npos) {
          input = &candidate;
        }
      }
      if (input != nullptr && line.find(prefix) != std::string::npos)
        check(line, Load(input->first), Load(input->second));
    }
  }

  void Expect(const std::string& line, const std::string& key, double value) {
    const auto written = Written(line, key);
    ASSERT_TRUE(written) << "no '" << key << "' in: " << line;
    const std::size_t point = written->find('.');
    const int decimals = point == std::string::npos ? 0 : static_cast<int>(written->size() - point - 1);
    char ours[64];
    std::snprintf(ours, sizeof ours, "%.*f", decimals, value);
    EXPECT_EQ(*written, ours) << key << " in: " << line;
    ++figures_;
  }

  const Trajectory& Load(const std::string& name) {
    const auto found = loaded_.find(name);
    return found != loaded_.end() ? found->second : loaded_.emplace(name, ReadTrajectory(folder_ / name)).first->second;
  }

  std::filesystem::path folder_;
  std::map<std::string, Trajectory> loaded_;
  int figures_ = 0;  // compared
};

TEST_F(Golden, EvoApe) {
  const std::pair<const char*, Alignment> modes[] = {
      {"none ", Alignment::none}, {"SE3 ", Alignment::se3}, {"Sim3 ", Alignment::sim3}, {"origin ", Alignment::first}};
  for (const auto& [mode, alignment] : modes) {
    for (const std::int64_t gap : {10'000'000, 20'000'000}) {
      ForEach(std::string("evo t_max_diff=0.0") + (gap == 10'000'000 ? "1 " : "2 ") + mode,
              [&, chosen = alignment](const std::string& line, const Trajectory& estimate, const Trajectory& truth) {
                const Ate ate = ComputeAte(MatchTrajectories(estimate, truth, {AssociationRule::nearest, gap}), chosen);
                Expect(line, "n=", static_cast<double>(ate.position.count));
                Expect(line, " rmse=", ate.position.rmse);
                Expect(line, " mean=", ate.position.mean);
                Expect(line, " med=", ate.position.median);
                Expect(line, " std=", ate.position.std);
                Expect(line, " max=", ate.position.max);
                Expect(line, " rot_rmse=", ate.orientation.rmse * kDegrees);
                if (chosen == Alignment::sim3) {
                  EXPECT_NEAR(std::stod(*Written(line, " s=")), ate.similarity.scale, 1e-13);
                }
              });
    }
  }
  EXPECT_EQ(figures_, 4 * 2 * 2 * 7);
}

TEST_F(Golden, TumAte) {
  ForEach("TUM ate:", [&](const std::string& line, const Trajectory& estimate, const Trajectory& truth) {
    const Ate ate = ComputeAte(MatchTrajectories(estimate, truth, {}), Alignment::se3);
    Expect(line, "compared_pose_pairs ", static_cast<double>(ate.position.count));
    Expect(line, "error.rmse ", ate.position.rmse);
    Expect(line, "error.mean ", ate.position.mean);
    Expect(line, "error.median ", ate.position.median);
    Expect(line, "error.std ", ate.position.std);
    Expect(line, "error.min ", ate.position.min);
    Expect(line, "error.max ", ate.position.max);
  });
  EXPECT_EQ(figures_, 2 * 7);
}

TEST_F(Golden, RpgAbsoluteErrors) {
  const std::pair<const char*, Alignment> modes[] = {
      {" none s=", Alignment::none}, {" se3 s=", Alignment::se3}, {" sim3 s=", Alignment::sim3}};
  for (const auto& [mode, alignment] : modes) {
    ForEach(mode,
            [&, chosen = alignment](const std::string& line, const Trajectory& estimate, const Trajectory& truth) {
              const Ate ate = ComputeAte(MatchTrajectories(estimate, truth, {}), chosen);
              Expect(line, " s=", ate.similarity.scale);
              Expect(line, "rmse=", ate.position.rmse);
              Expect(line, "mean=", ate.position.mean);
            });
  }
  EXPECT_EQ(figures_, 3 * 2 * 3);
}

// ov_eval's own association finds other pairs in the gaps of fr2_desk; on fr1_xyz its pairs are ours.
TEST_F(Golden, OpenVinsAbsoluteErrors) {
  const std::pair<const char*, Alignment> modes[] = {{"none          ATE", Alignment::none},
                                                     {"se3           ATE", Alignment::se3},
                                                     {"sim3          ATE", Alignment::sim3}};
  for (const auto& [mode, alignment] : modes) {
    ForEach(mode,
            [&, chosen = alignment](const std::string& line, const Trajectory& estimate, const Trajectory& truth) {
              if (line.find("n=786") == std::string::npos) return;
              const Ate ate = ComputeAte(MatchTrajectories(estimate, truth, {}), chosen);
              const double n = static_cast<double>(ate.position.count);
              Expect(line, "n=", n);
              Expect(line, "pos rmse=", ate.position.rmse);
              Expect(line, "mean=", ate.position.mean);
              Expect(line, "std=", ate.position.std * std::sqrt(n / (n - 1)));  // it divides by n - 1
            });
  }
  EXPECT_EQ(figures_, 3 * 4);
}

TEST_F(Golden, EvoRpe) {
  for (const bool metres : {false, true}) {
    for (const int delta : {1, 10}) {
      for (const bool all : {false, true}) {
        for (const bool from_truth : {false, true}) {
          const std::string prefix = "evo RPE d=" + std::to_string(delta) + (metres ? " meters" : " frames") +
                                     " all=" + (all ? "True" : "False") + " fromref=" + (from_truth ? "True" : "False");
          const PairSelection selection = all ? PairSelection::all : PairSelection::consecutive;
          ForEach(prefix, [&](const std::string& line, const Trajectory& estimate, const Trajectory& truth) {
            const auto matched = MatchTrajectories(estimate, truth, {AssociationRule::nearest, 20'000'000});
            const auto pairs = metres ? PairsByPath(from_truth ? matched.truth : matched.estimate, delta, selection)
                                      : PairsByFrames(matched.truth.size(), static_cast<std::size_t>(delta), selection);
            const Rpe rpe = ComputeRpe(matched, pairs);
            Expect(line, " n=", static_cast<double>(rpe.pairs.size()));
            Expect(line, " rmse=", rpe.position_statistics.rmse);
            Expect(line, " mean=", rpe.position_statistics.mean);
            Expect(line, "rot_rmse=", rpe.orientation_statistics.rmse * kDegrees);
            Expect(line, "rot_mean=", rpe.orientation_statistics.mean * kDegrees);
          });
        }
      }
    }
  }
  EXPECT_EQ(figures_, 2 * 7 * 5);
}

TEST_F(Golden, TumRpe) {
  for (const std::string mode : {"'1', '--delta_unit', 's'", "'1', '--delta_unit', 'f'", "'10', '--delta_unit', 'f'"}) {
    ForEach("TUM rpe ['--fixed_delta', '--delta', " + mode, [&](const std::string& line, const Trajectory& estimate,
                                                                const Trajectory& truth) {
      const Rpe rpe = mode.ends_with("'s'") ? ComputeTumRpeByTime(estimate, truth, 1'000'000'000)
                                            : ComputeTumRpeByFrames(estimate, truth, mode.starts_with("'10'") ? 10 : 1);
      Expect(line, "compared_pose_pairs ", static_cast<double>(rpe.pairs.size()));
      const auto compare = [&](const std::string& what, const Statistics& ours, double unit) {
        Expect(line, what + ".rmse ", ours.rmse * unit);
        Expect(line, what + ".mean ", ours.mean * unit);
        Expect(line, what + ".median ", ours.median * unit);
        Expect(line, what + ".std ", ours.std * unit);
        Expect(line, what + ".min ", ours.min * unit);
        Expect(line, what + ".max ", ours.max * unit);
      };
      compare("translational_error", rpe.position_statistics, 1);
      compare("rotational_error", rpe.orientation_statistics, kDegrees);
    });
  }
  EXPECT_EQ(figures_, 3 * 2 * 13);
}

}  // namespace
}  // namespace evaluation
