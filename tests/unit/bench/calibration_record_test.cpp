// Camera calibration estimated by an odometry: its record in files, and in words.
#include "tools/bench/result/calibration_record.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/temporary_folder.h"
#include "tools/bench/result/run_json.h"

namespace vobench {
namespace {

using testing::HasSubstr;

CalibrationRecord Wrong() {
  CalibrationRecord record;
  record.readout_s = {0.026, 0.0005};
  record.readout_used_s = 0.0255;
  record.focal_px = 525;
  record.focal_factor = {1.04, 0.005};
  record.pattern_px = 0.12;
  record.focal_is_wrong = true;
  return record;
}

TEST(CalibrationRecord, GoesThroughItsFile) {
  RunDescription description;
  description.runs = {
      {"rb2pf", 1, ".", 0.5, Wrong()}, {"rb2pf", 2, ".", 0.5, CalibrationRecord{}}, {"rbpf", 1, ".", 1}};
  const vobench_test::TemporaryFolder folder;
  WriteRunJson(folder.path(), description);
  const RunDescription read = ReadRunJson(folder.path());
  ASSERT_EQ(read.runs.size(), 3);
  EXPECT_EQ(ToJson(*read.runs[0].calibration), ToJson(Wrong()));
  EXPECT_EQ(read.runs[0].calibration->focal_factor->sigma, 0.005);
  EXPECT_FALSE(read.runs[1].calibration->readout_s);
  EXPECT_FALSE(read.runs[1].calibration->focal_factor);
  EXPECT_FALSE(read.runs[2].calibration);
}

TEST(CalibrationRecord, SaysWhatWasFoundAndWhatIsWrong) {
  EXPECT_THAT(CalibrationSummary(Wrong()), HasSubstr("26.0 ± 1.0 ms (95 %); used: 25.5 ms"));
  EXPECT_THAT(CalibrationWarning(Wrong()), HasSubstr("a focal length of 546.0 ± 5.1 px to 525.0 px"));
  EXPECT_THAT(CalibrationWarning(Wrong()), HasSubstr("0.12 px"));
  EXPECT_EQ(CalibrationSummary({}), "");
  EXPECT_EQ(CalibrationWarning({}), "");
}

}  // namespace
}  // namespace vobench
