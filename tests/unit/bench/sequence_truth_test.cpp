#include "tools/bench/sequence/sequence_truth.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tools/judge/evaluation/text_file.h"

namespace {

namespace fs = std::filesystem;

TEST(SequenceTruth, MirrorsOriginalIclNuimPoses) {
  const fs::path folder = fs::path(testing::TempDir()) / "icl_nuim_truth";
  fs::remove_all(folder);
  fs::create_directories(folder);
  EXPECT_FALSE(vobench::ReadSequenceTruth(folder));
  std::ofstream(folder / "traj0.gt.freiburg")
      << "1 0.1 0.2 0.3 0 0 0 1\n2 0.1 0.2 0.3 0.1825741858 0.3651483717 0.5477225575 0.7302967433\n";
  const auto truth = vobench::ReadSequenceTruth(folder);
  ASSERT_TRUE(truth);
  ASSERT_EQ(truth->poses.size(), 2u);
  EXPECT_EQ(truth->poses[0].stamp_ns, 33333333);
  EXPECT_EQ(truth->poses[1].stamp_ns, 66666667);
  // S R S and S p by matrices.
  const Eigen::Matrix3d S = Eigen::Vector3d(1, -1, 1).asDiagonal();
  const Eigen::Matrix3d R =
      Eigen::Quaterniond(0.7302967433, 0.1825741858, 0.3651483717, 0.5477225575).toRotationMatrix();
  EXPECT_LT((truth->poses[1].q_WC.toRotationMatrix() - S * R * S).norm(), 1e-9);
  EXPECT_LT((truth->poses[1].p_WC - Eigen::Vector3d(0.1, -0.2, 0.3)).norm(), 1e-12);
  fs::remove_all(folder);
}

// Stamps of the frames: those of the layout's list of pictures.
TEST(FrameStamps, AreOfTheListThatTheLayoutHas) {
  const fs::path folder = fs::path(testing::TempDir()) / "frame_stamps";
  fs::remove_all(folder);
  fs::create_directories(folder / "mav0/cam0");
  EXPECT_FALSE(vobench::ReadFrameStamps(folder));
  std::ofstream(folder / "mav0/cam0/data.csv") << "#timestamp [ns],filename\n1403636579763555584,1.png\n"
                                                  "1403636579813555456,2.png\n";
  using Stamps = std::vector<std::int64_t>;
  EXPECT_EQ(vobench::ReadFrameStamps(folder).value(), (Stamps{1403636579763555584, 1403636579813555456}));
  std::ofstream(folder / "associations.txt") << "0 depth/0.png 0 rgb/0.png\n1 depth/1.png 1 rgb/1.png\n";
  EXPECT_EQ(vobench::ReadFrameStamps(folder).value(), (Stamps{0, 33333333}));
  std::ofstream(folder / "rgb.txt") << "# timestamp filename\n0.25 rgb/a.png\n0.5 rgb/b.png\n";
  EXPECT_EQ(vobench::ReadFrameStamps(folder).value(), (Stamps{250000000, 500000000}));
  std::ofstream(folder / "rgb.txt") << "0.5 rgb/a.png\n0.25 rgb/b.png\nx rgb/c.png\n";
  EXPECT_THROW(vobench::ReadFrameStamps(folder), std::runtime_error);
  fs::remove_all(folder);
}

TEST(SequenceTruth, RefusesEurocTimesThatDoNotAddUp) {
  const fs::path folder = fs::path(testing::TempDir()) / "euroc_truth",
                 poses = folder / "mav0/state_groundtruth_estimate0";
  fs::remove_all(folder);
  fs::create_directories(poses);
  fs::create_directories(folder / "mav0/cam0");
  std::ofstream(folder / "mav0/cam0/sensor.yaml") << "T_BS: {data: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}\n";
  const auto read = [&](const std::string& stamp) {
    std::ofstream(poses / "data.csv") << stamp << ",0,0,0,1,0,0,0\n";
    return vobench::ReadSequenceTruth(folder)->poses.at(0).stamp_ns;
  };
  EXPECT_EQ(read("4000000000000000000"), 4'000'000'000'000'000'000);
  EXPECT_THROW(read("4000000000000000001"), evaluation::InputError);
  EXPECT_THROW(read("-4000000000000000001"), evaluation::InputError);
  fs::remove_all(folder);
}

}  // namespace
