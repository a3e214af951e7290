// Every figure of the reference tools in the file of golden values, digit for digit: TUM's ATE and RPE scripts, evo,
// rpg_trajectory_evaluation and ov_eval on the TUM RGB-D trajectories beside it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>

#include "source_dir.h"
#include "tools/judge/evaluation/compat/evo.h"
#include "tools/judge/evaluation/compat/format.h"
#include "tools/judge/evaluation/compat/openvins.h"
#include "tools/judge/evaluation/compat/rpg.h"
#include "tools/judge/evaluation/compat/tum.h"

namespace evaluation::compat {
namespace {

// The number that follows a key ("rmse=", "rmse "), as written; nothing when the key is not there.
std::optional<std::string> Written(const std::string& line, const std::string& key) {
  const std::size_t at = line.find(key);
  if (at == std::string::npos) return std::nullopt;
  const std::size_t begin = at + key.size();
  return line.substr(begin, line.find_first_not_of("0123456789.", begin) - begin);
}

// Lines joined by " | ", as the file of golden values has them.
std::string OneLine(const std::string& text) {
  std::string line;
  for (const char c : text.substr(0, text.size() - 1)) line += c == '\n' ? std::string(" | ") : std::string(1, c);
  return line;
}

const Statistics& Find(const std::vector<NamedStatistics>& errors, const std::string& name) {
  return std::ranges::find(errors, name, &NamedStatistics::name)->statistics;
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
    std::string before;
    for (std::string line; std::getline(values, line); before = line) {
      // A greeting of ov_eval without a header before it belongs to a file that is not among the inputs.
      const bool unnamed = line.starts_with("Setting printing level") && !before.starts_with("==");
      if (line.starts_with("==") || unnamed) input = nullptr;
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
    return found != loaded_.end() ? found->second
                                  : loaded_.emplace(name, ReadTrajectory(folder_ / name, reading_)).first->second;
  }

  std::filesystem::path folder_;
  std::map<std::string, Trajectory> loaded_;
  Reading reading_ = Reading::strict;
  int figures_ = 0;  // compared
};

TEST_F(Golden, EvoApe) {
  const std::pair<const char*, EvoOptions> modes[] = {{"none ", {}},
                                                      {"SE3 ", {.align = true}},
                                                      {"Sim3 ", {.align = true, .correct_scale = true}},
                                                      {"scaleonly ", {.correct_scale = true}},
                                                      {"origin ", {.align_origin = true}}};
  for (const auto& [mode, wanted] : modes) {
    for (const std::int64_t gap : {10'000'000, 20'000'000}) {
      ForEach(std::string("evo t_max_diff=0.0") + (gap == 10'000'000 ? "1 " : "2 ") + mode,
              [&, chosen = wanted](const std::string& line, const Trajectory& estimate, const Trajectory& truth) {
                EvoOptions options = chosen;
                options.t_max_diff_ns = gap;
                const EvoResult ape = ComputeEvoApe(estimate, truth, options);
                Expect(line, "n=", static_cast<double>(ape.statistics.count));
                Expect(line, " rmse=", ape.statistics.rmse);
                Expect(line, " mean=", ape.statistics.mean);
                Expect(line, " med=", ape.statistics.median);
                Expect(line, " std=", ape.statistics.std);
                Expect(line, " max=", ape.statistics.max);
                if (options.correct_scale) {
                  EXPECT_NEAR(std::stod(*Written(line, " s=")), ape.similarity.scale, 1e-13);
                }
                options.relation = EvoRelation::angle_deg;
                Expect(line, " rot_rmse=", ComputeEvoApe(estimate, truth, options).statistics.rmse);
              });
    }
  }
  EXPECT_EQ(figures_, 5 * 2 * 2 * 7);
}

TEST_F(Golden, TumAte) {
  ForEach("TUM ate:", [&](const std::string& line, const Trajectory& estimate, const Trajectory& truth) {
    const TumAteOptions options{.verbose = true};
    const std::string printed = Print(ComputeTumAte(estimate, truth, options), options);
    EXPECT_EQ(line, "TUM ate: " + OneLine(printed));
    ++figures_;
  });
  EXPECT_EQ(figures_, 2);
}

TEST_F(Golden, RpgAbsoluteErrors) {
  const std::pair<const char*, evaluation::Alignment> modes[] = {{" none s=", evaluation::Alignment::none},
                                                                 {" se3 s=", evaluation::Alignment::se3},
                                                                 {" sim3 s=", evaluation::Alignment::sim3},
                                                                 {" posyaw s=", evaluation::Alignment::yaw}};
  for (const auto& [mode, alignment] : modes) {
    ForEach(mode,
            [&, chosen = alignment](const std::string& line, const Trajectory& estimate, const Trajectory& truth) {
              const RpgResult rpg = ComputeRpg(estimate, truth, chosen, {1});
              Expect(line, " s=", rpg.similarity.scale);
              Expect(line, "rmse=", Find(rpg.errors, "trans").rmse);
              Expect(line, "mean=", Find(rpg.errors, "trans").mean);
            });
  }
  EXPECT_EQ(figures_, 4 * 2 * 3);
}

TEST_F(Golden, RpgLengthsOfSubTrajectories) {
  for (const std::string prefix : {" length 8.016619671585246", " length 18.858236113214986"}) {
    ForEach(prefix, [&](const std::string& line, const Trajectory& estimate, const Trajectory& truth) {
      std::string ours = "[";
      for (const NamedStatistics& errors : ComputeRpg(estimate, truth, evaluation::Alignment::none).errors) {
        if (errors.name.ends_with("m_trans"))
          ours += (ours.size() > 1 ? ", " : "") + Significant(std::stod(errors.name), 12);
      }
      EXPECT_EQ(line.substr(line.find('[')), ours + "]");
      ++figures_;
    });
  }
  EXPECT_EQ(figures_, 2);
}

// A block of the file: the ATE of a mode, then lines of RPE without the mode's name.
TEST_F(Golden, OpenVins) {
  reading_ = Reading::as_written;
  const std::pair<const char*, OvAlignment> modes[] = {
      {"none ", OvAlignment::none},           {"se3 ", OvAlignment::se3},
      {"sim3 ", OvAlignment::sim3},           {"posyaw ", OvAlignment::posyaw},
      {"se3single ", OvAlignment::se3single}, {"posyawsingle ", OvAlignment::posyawsingle}};
  std::vector<NamedStatistics> ov;
  ForEach("", [&](const std::string& line, const Trajectory& estimate, const Trajectory& truth) {
    if (line.find("RPE ") != std::string::npos && line.starts_with("   ")) {
      const std::string over = Fixed(std::stod(line.substr(line.find("RPE ") + 4)), 2) + "m_";
      if (std::ranges::find(ov, over + "pos", &NamedStatistics::name) != ov.end()) {
        const Statistics &pos = Find(ov, over + "pos"), &turn = Find(ov, over + "ori");
        Expect(line, "n=", static_cast<double>(pos.count));
        Expect(line, "pos median=", pos.median);
        Expect(line, "mean=", pos.mean);
        Expect(line, "rmse=", pos.rmse);
        const std::string ori = line.substr(line.find(" ori "));
        Expect(ori, "median=", turn.median);
        Expect(ori, "mean=", turn.mean);
      }
    }
    for (const auto& [mode, alignment] : modes) {
      if (!line.starts_with(mode) || line.find(" ATE n=") == std::string::npos) continue;
      ov = ComputeOv(estimate, truth, alignment, {1, 2, 4});
      const Statistics &pos = Find(ov, "pos"), &turn = Find(ov, "ori");
      Expect(line, "n=", static_cast<double>(pos.count));
      Expect(line, "pos rmse=", pos.rmse);
      Expect(line, "mean=", pos.mean);
      Expect(line, "std=", pos.std);
      const std::string ori = line.substr(line.find(" ori "));
      Expect(ori, "rmse=", turn.rmse);
      Expect(ori, "mean=", turn.mean);
    }
  });
  EXPECT_EQ(figures_, 6 * 2 * (6 + 3 * 6));
}

TEST_F(Golden, EvoRpe) {
  for (const bool metres : {false, true}) {
    for (const int delta : {1, 10}) {
      for (const bool all : {false, true}) {
        for (const bool from_truth : {false, true}) {
          const std::string prefix = "evo RPE d=" + std::to_string(delta) + (metres ? " meters" : " frames") +
                                     " all=" + (all ? "True" : "False") + " fromref=" + (from_truth ? "True" : "False");
          EvoRpeOptions options;
          options.common.t_max_diff_ns = 20'000'000;
          options.delta = delta;
          options.unit = metres ? EvoDeltaUnit::metres : EvoDeltaUnit::frames;
          options.all_pairs = all;
          options.pairs_from_reference = from_truth;
          ForEach(prefix, [&](const std::string& line, const Trajectory& estimate, const Trajectory& truth) {
            options.common.relation = EvoRelation::translation;
            const EvoResult rpe = ComputeEvoRpe(estimate, truth, options);
            Expect(line, " n=", static_cast<double>(rpe.statistics.count));
            Expect(line, " rmse=", rpe.statistics.rmse);
            Expect(line, " mean=", rpe.statistics.mean);
            options.common.relation = EvoRelation::angle_deg;
            const EvoResult turn = ComputeEvoRpe(estimate, truth, options);
            Expect(line, "rot_rmse=", turn.statistics.rmse);
            Expect(line, "rot_mean=", turn.statistics.mean);
          });
        }
      }
    }
  }
  EXPECT_EQ(figures_, 2 * 7 * 5);
}

// Whole lines, including the pairs drawn at random: Python's generator is reproduced.
TEST_F(Golden, TumRpe) {
  TumRpeOptions fixed{.fixed_delta = true, .verbose = true};
  TumRpeOptions frame = fixed, ten = fixed;
  frame.unit = ten.unit = TumDeltaUnit::frames;
  ten.delta = 10;
  const std::pair<std::string, TumRpeOptions> modes[] = {
      {"['--fixed_delta', '--delta', '1', '--delta_unit', 's']", fixed},
      {"['--fixed_delta', '--delta', '1', '--delta_unit', 'f']", frame},
      {"['--fixed_delta', '--delta', '10', '--delta_unit', 'f']", ten},
      {"[]", {.verbose = true}}};
  for (const auto& [mode, wanted] : modes) {
    const std::string prefix = "TUM rpe " + mode + " ";
    ForEach(prefix,
            [&, options = wanted](const std::string& line, const Trajectory& estimate, const Trajectory& truth) {
              EXPECT_EQ(line, prefix + OneLine(Print(ComputeTumRpe(estimate, truth, options), options)));
              ++figures_;
            });
  }
  EXPECT_EQ(figures_, 4 * 2);
}

}  // namespace
}  // namespace evaluation::compat
