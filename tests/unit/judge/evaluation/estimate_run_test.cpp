#include "tools/judge/evaluation/estimate_run.h"

#include <gmock/gmock.h>

#include <functional>

#include "tests/unit/judge/evaluation/complaint.h"
#include "tests/unit/judge/evaluation/random.h"
#include "tests/unit/judge/evaluation/temporary_folder.h"
#include "tools/base/text.h"
#include "tools/judge/evaluation/text_file.h"

namespace evaluation {
namespace {

using testing::HasSubstr;

EstimateRun Sample() {
  TestRandom random(40);
  EstimateRun run;
  run.trajectory = random.Walk(4);
  run.live = random.Walk(4);
  for (const StampedPose& pose : run.trajectory) {
    Matrix12d A;
    for (int i = 0; i < 12; ++i) A.col(i) = random.Normals(12);
    run.beliefs.push_back({{pose.stamp_ns, random.Normals(3), random.Normals(3)}, A * A.transpose()});
    FrameRecord frame;
    frame.stamp_ns = pose.stamp_ns;
    frame.searched = 50;
    frame.matched = 40;
    frame.landmarks = 120;
    frame.permanent = 7;
    frame.nis = 81.25;
    frame.nis_dof = 80;
    frame.effective_particles = 5.5;
    frame.ms_features = 1.5, frame.ms_matching = 2.25, frame.ms_filter = 0.75;
    frame.tracked = pose.stamp_ns % 2 == 0;
    frame.events = {3, 1, 4, 2};
    frame.repeated = 1;
    run.frames.push_back(frame);
  }
  return run;
}

TEST(EstimateRun, ReadsBackTheSame) {
  const TemporaryFolder folder;
  const EstimateRun run = Sample();
  WriteEstimateRun(folder.path(), run);
  const EstimateRun back = ReadEstimateRun(folder.path());
  ASSERT_EQ(back.trajectory.size(), 4u);
  ASSERT_EQ(back.live.size(), 4u);
  ASSERT_EQ(back.beliefs.size(), 4u);
  ASSERT_EQ(back.frames.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(back.live[k].stamp_ns, run.live[k].stamp_ns);
    EXPECT_LT((back.live[k].p_WC - run.live[k].p_WC).norm(), 1e-10);
    EXPECT_LT((back.trajectory[k].p_WC - run.trajectory[k].p_WC).norm(), 1e-10);
    const Matrix12d &P = run.beliefs[k].covariance, &Q = back.beliefs[k].covariance;
    EXPECT_LT((P - Q).cwiseAbs().maxCoeff(), 1e-13 * P.cwiseAbs().maxCoeff());
    EXPECT_LT((run.beliefs[k].velocity.v_WC - back.beliefs[k].velocity.v_WC).norm(), 1e-10);
    EXPECT_LT((run.beliefs[k].velocity.w_WC_C - back.beliefs[k].velocity.w_WC_C).norm(), 1e-10);
    const FrameRecord &f = run.frames[k], &g = back.frames[k];
    EXPECT_EQ(std::tie(f.stamp_ns, f.searched, f.matched, f.landmarks, f.permanent, f.nis, f.nis_dof),
              std::tie(g.stamp_ns, g.searched, g.matched, g.landmarks, g.permanent, g.nis, g.nis_dof));
    EXPECT_EQ(std::tie(f.effective_particles, f.ms_features, f.ms_matching, f.ms_filter, f.tracked, f.repeated),
              std::tie(g.effective_particles, g.ms_features, g.ms_matching, g.ms_filter, g.tracked, g.repeated));
    ASSERT_TRUE(g.events);
    EXPECT_EQ(std::tie(g.events->not_converged, g.events->behind_camera, g.events->not_positive_definite,
                       g.events->non_finite_weight),
              std::make_tuple(3, 1, 4, 2));
  }
}

// Removal of the interval [from, until) from a run: whole frames.
TEST(EstimateRun, OutsideLeavesOutWholeFrames) {
  const EstimateRun run = Sample();
  const auto stamp = [&](std::size_t k) { return run.trajectory[k].stamp_ns; };
  const EstimateRun rest = Outside(run, stamp(1), stamp(3));
  const std::vector<std::int64_t> kept = {stamp(0), stamp(3)};
  ASSERT_EQ(rest.trajectory.size(), 2u);
  ASSERT_EQ(rest.beliefs.size(), 2u);
  ASSERT_EQ(rest.frames.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(rest.trajectory[k].stamp_ns, kept[k]);
    EXPECT_EQ(rest.beliefs[k].velocity.stamp_ns, kept[k]);
    EXPECT_EQ(rest.frames[k].stamp_ns, kept[k]);
  }
  EXPECT_EQ(Outside(run, stamp(1), stamp(1)).trajectory.size(), 4u);
}

// Zero covariance: an exact start.
TEST(EstimateRun, AVarianceMayBeZero) {
  const TemporaryFolder folder;
  EstimateRun run = Sample();
  run.beliefs[0].covariance.setZero();
  WriteEstimateRun(folder.path(), run);
  EXPECT_EQ(ReadEstimateRun(folder.path()).beliefs[0].covariance, Matrix12d::Zero());
}

TEST(EstimateRun, FramesMayComeWithoutEvents) {
  const TemporaryFolder folder;
  EstimateRun run = Sample();
  run.frames[2].events.reset();
  WriteEstimateRun(folder.path(), run);
  const std::string header =
      "timestamp,searched,matched,landmarks,permanent,nis,nis_dof,effective_particles,ms_features,ms_matching,ms_"
      "filter,status";
  EXPECT_THAT(TemporaryFolder::Read(folder.path() / "frames.csv"), testing::StartsWith(header + "\n"));
  for (const FrameRecord& frame : ReadEstimateRun(folder.path()).frames) EXPECT_FALSE(frame.events);
  // Columns of events without repetitions: status and events are read, repetitions are absent.
  const std::string events = ",not_converged,behind_camera,not_positive_definite,non_finite_weight";
  folder.Write("frames.csv", header + events + "\n1,30,11,0,0,0,0,8,0,0,0,tracked,0,0,0,0\n");
  const FrameRecord former = ReadEstimateRun(folder.path()).frames.at(0);
  EXPECT_TRUE(former.tracked && former.events);
  EXPECT_FALSE(former.repeated);
  folder.Write("frames.csv", header + events +
                                 "\n"
                                 "1,0,0,0,0,0,0,8,0,0,0,coasted,0,0,0,-1\n"
                                 "2,0,0,0,0,0,0,8,0,0,0,coasted\n");
  EXPECT_THAT([&] { ReadEstimateRun(folder.path()); },
              testing::ThrowsMessage<InputError>(
                  testing::AllOf(HasSubstr("frames.csv:2:37: '-1' is not a count"),
                                 HasSubstr("frames.csv:3:1: 12 columns where 16 are expected"))));
}

TEST(EstimateRun, FormerColumnNamesAreRejected) {
  const TemporaryFolder folder;
  WriteEstimateRun(folder.path(), Sample());
  folder.Write("frames.csv",
               "timestamp,searched,matched,landmarks,permanent,nis,nis_dof,effective_particles,ms_features,"
               "ms_matching,ms_filter,status,unsettled,behind,indefinite,impossible\n");
  EXPECT_THAT(
      [&] { ReadEstimateRun(folder.path()); },
      testing::ThrowsMessage<InputError>(testing::AllOf(HasSubstr("column 'unsettled' is now 'not_converged'"),
                                                        HasSubstr("column 'behind' is now 'behind_camera'"),
                                                        HasSubstr("column 'indefinite' is now 'not_positive_definite'"),
                                                        HasSubstr("column 'impossible' is now 'non_finite_weight'"))));
}

TEST(EstimateRun, PartsMayBeMissingAndOldOnesDoNotLinger) {
  const TemporaryFolder folder;
  EstimateRun run = Sample();
  WriteEstimateRun(folder.path(), run);
  EXPECT_EQ(run.answers()[1].p_WC, run.live[1].p_WC);
  run.live.clear();
  run.beliefs.clear();
  run.frames.clear();
  WriteEstimateRun(folder.path(), run);
  const EstimateRun back = ReadEstimateRun(folder.path());
  EXPECT_TRUE(back.live.empty());
  EXPECT_EQ(back.answers()[1].p_WC, back.trajectory[1].p_WC) << "not told apart: the trajectory itself";
  EXPECT_TRUE(back.beliefs.empty());
  EXPECT_TRUE(back.frames.empty());
  EXPECT_EQ(back.trajectory.size(), 4u);
}

TEST(EstimateRun, ABeliefThatIsNoNumberIsNotWritten) {
  const double nan = std::nan("");
  const std::function<void(StampedBelief&)> spoils[] = {[&](StampedBelief& belief) { belief.velocity.v_WC[0] = nan; },
                                                        [&](StampedBelief& belief) { belief.velocity.w_WC_C[2] = nan; },
                                                        [&](StampedBelief& belief) { belief.covariance(7, 3) = nan; }};
  for (const auto& spoil : spoils) {
    const TemporaryFolder folder;
    EstimateRun run = Sample();
    spoil(run.beliefs.back());
    EXPECT_THROW(WriteEstimateRun(folder.path(), run), std::invalid_argument);
  }
}

TEST(EstimateRun, ListsTheProblemsOfAllFilesAtOnce) {
  const TemporaryFolder folder;
  WriteEstimateRun(folder.path(), Sample());
  folder.Write("estimate.txt", "1 0 0 x 0 0 0 1\n");
  folder.Write("live.txt", "1 0 0 0 0 0 0 2\n");
  folder.Write("covariance.txt", "1 2 3\n");
  folder.Write("frames.csv",
               "timestamp,searched,matched,landmarks,permanent,nis,nis_dof,effective_particles,ms_features,ms_matching,"
               "ms_filter,status\n1,2,-3,4,5,nan,6,7,8,9,10,lost\n");
  try {
    ReadEstimateRun(folder.path());
    FAIL();
  } catch (const InputError& error) {
    for (const char* part : {"estimate.txt:1:7: 'x'", "live.txt:1:", "covariance.txt:1:1: 3 columns",
                             "frames.csv:2:5: '-3' is not a count", "frames.csv:2:12: 'nan'",
                             "frames.csv:2:27: 'lost' is not 'tracked', 'weak' or 'coasted'"}) {
      EXPECT_THAT(error.what(), HasSubstr(part));
    }
  }
}

// Columns of one character: the n-th begins at character 2 n + 1.
TEST(EstimateRun, BeliefErrorsHavePlaces) {
  const TemporaryFolder folder;
  WriteEstimateRun(folder.path(), Sample());
  const auto error_of = [&](const std::string& covariance) {
    folder.Write("covariance.txt", covariance);
    return ComplaintOf<InputError>([&] { ReadEstimateRun(folder.path()); });
  };
  const auto line = [](const std::string& stamp, std::size_t at = 0, const std::string& token = "") {
    std::string text = stamp;
    for (std::size_t i = 1; i < 85; ++i) text += ' ' + (i == at ? token : "0");
    return text + '\n';
  };
  const std::string file = (folder.path() / "covariance.txt").string();
  EXPECT_EQ(error_of(line("1") + line("2")), "");
  EXPECT_EQ(error_of(line("1") + line("1")), file + ":2:1: time 1 is not later than the one above");
  EXPECT_EQ(error_of(line("2") + line("1") + line("3")), file + ":2:1: time 1 is not later than the one above");
  EXPECT_EQ(error_of(line("5e9") + line("2")), file + ":1:1: '5e9' is not a time in seconds, 4e9 at most");
  EXPECT_EQ(error_of(line("1") + "2 0 0\n" + line("2")),
            file + ":2:1: 3 columns where 85 are expected (timestamp, 6 velocities, 78 of the covariance)");
  for (const std::size_t column : {1u, 6u, 7u, 84u})
    EXPECT_EQ(error_of(line("1", column, "x")),
              file + ":1:" + std::to_string(2 * column + 1) + ": 'x' is not a finite number");
  std::size_t diagonal = 7;
  for (std::size_t row = 0; row < 12; ++row) {
    EXPECT_EQ(error_of(line("1", diagonal, "-1")), file + ":1:" + std::to_string(2 * diagonal + 1) + ": variance " +
                                                       std::to_string(row + 1) + " is negative: -1");
    diagonal += 12 - row;
  }
}

TEST(EstimateRun, FrameErrorsHavePlaces) {
  const TemporaryFolder folder;
  WriteEstimateRun(folder.path(), Sample());
  const std::string text = TemporaryFolder::Read(folder.path() / "frames.csv"),
                    header = text.substr(0, text.find('\n'));
  const auto error_of = [&](const std::string& rows) {
    folder.Write("frames.csv", header + '\n' + rows);
    return ComplaintOf<InputError>([&] { ReadEstimateRun(folder.path()); });
  };
  const auto row = [](std::size_t at, const std::string& token) {
    std::string columns;
    for (std::size_t i = 0; i < 17; ++i)
      columns += (i == at ? token : i == 0 ? "1" : i == 11 ? "coasted" : "0") + (i < 16 ? "," : "\n");
    return columns;
  };
  const std::string file = (folder.path() / "frames.csv").string();
  EXPECT_EQ(error_of(row(0, "1") + row(0, "2")), "");
  EXPECT_EQ(error_of(row(0, "1") + row(0, "1")), file + ":3:1: '1' is not later than the time above");
  EXPECT_EQ(error_of(row(0, "x")), file + ":2:1: 'x' is not a time in seconds");
  EXPECT_EQ(error_of("1,2\n" + row(0, "2")), file + ":2:1: 2 columns where 17 are expected");
  folder.Write("frames.csv", "1,2\n" + row(0, "2"));
  EXPECT_EQ(ComplaintOf<InputError>([&] { ReadEstimateRun(folder.path()); }),
            file + ":1:1: 2 columns where 17 are expected");
  folder.Write("frames.csv", "time" + header.substr(header.find(',')) + '\n' + row(0, "2"));
  EXPECT_EQ(ComplaintOf<InputError>([&] { ReadEstimateRun(folder.path()); }),
            file + ":1:1: column 'time' where 'timestamp' is expected");
  for (std::size_t i = 1; i < 17; ++i) {
    const std::string at = file + ":2:" + std::to_string(i < 12 ? 2 * i + 1 : 2 * i + 7) + ": ";
    const char* what = i == 11                       ? "'tracked', 'weak' or 'coasted'"
                       : i == 5 || (i > 6 && i < 11) ? "a number of zero or more"
                                                     : "a count";
    EXPECT_EQ(error_of(row(i, "x")), at + "'x' is not " + what);
    EXPECT_EQ(error_of(row(i, "-1")), at + "'-1' is not " + what);
    EXPECT_EQ(error_of(row(i, "1x")), at + "'1x' is not " + what);
  }
}

TEST(EstimateRun, Digits) {
  const TemporaryFolder folder;
  EstimateRun run = Sample();
  run.beliefs.resize(1);
  run.frames.resize(1);
  run.beliefs[0].velocity.v_WC.setConstant(1. / 3);
  run.beliefs[0].velocity.w_WC_C.setConstant(2. / 3);
  run.beliefs[0].covariance = 4. / 3 * Matrix12d::Identity();
  FrameRecord& frame = run.frames[0];
  frame.stamp_ns = 1'000'000'000;
  frame.nis = frame.effective_particles = frame.ms_features = frame.ms_matching = frame.ms_filter = 100. / 3;
  frame.tracked = true;
  WriteEstimateRun(folder.path(), run);
  const std::string covariance = TemporaryFolder::Read(folder.path() / "covariance.txt"),
                    frames = TemporaryFolder::Read(folder.path() / "frames.csv");
  EXPECT_THAT(covariance,
              HasSubstr(" 0.333333333333 0.666666666667 0.666666666667 0.666666666667 1.33333333333333 0 0"));
  EXPECT_THAT(covariance, testing::EndsWith(" 0 1.33333333333333\n"));
  EXPECT_THAT(covariance, testing::StartsWith("# timestamp vx vy vz wx wy wz, then the upper triangle of the 12 x 12 "
                                              "covariance, row by row\n"));
  EXPECT_THAT(
      frames,
      testing::EndsWith("\n1.000000000,50,40,120,7,33.3333333,80,33.3333,33.3333,33.3333,33.3333,tracked,3,1,4,2,1\n"));
}

// Status of a frame: tracked; otherwise weak with matches, coasted without.
TEST(EstimateRun, StatusOfAFrame) {
  const TemporaryFolder folder;
  EstimateRun run = Sample();
  for (FrameRecord& frame : run.frames) frame.tracked = false;
  run.frames[0].tracked = true;
  run.frames[2].matched = 0;
  WriteEstimateRun(folder.path(), run);
  const std::string text = TemporaryFolder::Read(folder.path() / "frames.csv");
  const std::size_t tracked = text.find(",tracked,"), weak = text.find(",weak,"), coasted = text.find(",coasted,");
  EXPECT_LT(tracked, weak);
  EXPECT_LT(weak, coasted);
  const std::vector<FrameRecord> frames = ReadEstimateRun(folder.path()).frames;
  for (std::size_t k = 0; k < frames.size(); ++k) EXPECT_EQ(frames[k].tracked, k == 0);
}

TEST(EstimateRun, RefusesAWrongHeaderAndNegativeVariances) {
  const TemporaryFolder folder;
  EstimateRun run = Sample();
  run.beliefs[2].covariance(4, 4) = -1;
  WriteEstimateRun(folder.path(), run);
  std::string frames = TemporaryFolder::Read(folder.path() / "frames.csv");
  frames.replace(frames.find("matched"), 7, "matches");
  folder.Write("frames.csv", frames);
  try {
    ReadEstimateRun(folder.path());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("variance 5 is negative: -1"));
    EXPECT_THAT(error.what(), HasSubstr("column 'matches' where 'matched' is expected"));
  }
}

TEST(EstimateRun, WritesNothingWhenANumberIsNotFinite) {
  const TemporaryFolder folder;
  const auto error_of = [&](const EstimateRun& run) {
    return ComplaintOf<std::invalid_argument>([&] { WriteEstimateRun(folder.path(), run); });
  };
  const std::string at = base::FormatSeconds(Sample().frames[1].stamp_ns),
                    what = " holds a number that is not finite; nothing was written";
  for (double FrameRecord::*member : {&FrameRecord::nis, &FrameRecord::effective_particles, &FrameRecord::ms_features,
                                      &FrameRecord::ms_matching, &FrameRecord::ms_filter}) {
    EstimateRun run = Sample();
    run.frames[1].*member = std::nan("");
    EXPECT_EQ(error_of(run), "frames.csv: the frame at " + at + what);
  }
  EstimateRun run = Sample();
  run.beliefs[1].covariance(3, 4) = INFINITY;
  EXPECT_EQ(error_of(run), "covariance.txt: the belief at " + at + what);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace evaluation
