// Which landmarks the map keeps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vo/map/landmark_record.h"

namespace {

using testing::ElementsAre;

vo::LandmarkRecord Record(bool permanent, double score, int age, int frames_unsearched) {
  vo::LandmarkRecord record;
  record.permanent = permanent;
  record.score = score;
  record.age = age;
  record.frames_unsearched = frames_unsearched;
  record.searched = frames_unsearched == 0;
  return record;
}

TEST(LandmarksToKeep, PermanentOnesStay) {
  vo::LandmarkParams landmark;
  landmark.forget_after = 90;
  vo::ScoreParams score;
  score.delete_below = 0.1;
  score.grace_frames = 3;
  const vo::LandmarkRecord records[] = {Record(true, 0.0, 500, 400), Record(false, 0.9, 50, 89),
                                        Record(false, 0.9, 100, 90), Record(false, 0.05, 50, 0),
                                        Record(false, 0.05, 2, 0)};
  EXPECT_THAT(vo::LandmarksToKeep(records, 0, landmark, score), ElementsAre(true, true, false, false, true));
}

TEST(LandmarksToKeep, LongestUnsearchedGoFirst) {
  vo::LandmarkParams landmark;
  landmark.max_landmarks = 3;
  const vo::LandmarkRecord records[] = {Record(true, 1, 900, 0), Record(true, 1, 800, 7), Record(true, 1, 700, 2),
                                        Record(false, 1, 60, 2), Record(false, 1, 0, 0)};
  EXPECT_THAT(vo::LandmarksToKeep(records, 0, landmark, {}), ElementsAre(true, false, false, true, true));
}

TEST(LandmarksToKeep, RoomForNewOnesIsMadeByWhatWasNotSearched) {
  vo::LandmarkParams landmark;
  landmark.max_landmarks = 6;
  vo::LandmarkRecord records[] = {Record(true, 1, 900, 0), Record(true, 1, 800, 7), Record(true, 1, 700, 2),
                                  Record(false, 1, 60, 2), Record(false, 1, 3, 0)};
  EXPECT_THAT(vo::LandmarksToKeep(records, 1, landmark, {}), ElementsAre(true, true, true, true, true));
  EXPECT_THAT(vo::LandmarksToKeep(records, 2, landmark, {}), ElementsAre(true, false, true, true, true));
  EXPECT_THAT(vo::LandmarksToKeep(records, 3, landmark, {}), ElementsAre(true, false, false, true, true));
  EXPECT_THAT(vo::LandmarksToKeep(records, 100, landmark, {}), ElementsAre(true, false, false, false, true));
  for (vo::LandmarkRecord& record : records) ++record.frames_unsearched;  // a blind frame
  EXPECT_THAT(vo::LandmarksToKeep(records, 100, landmark, {}), ElementsAre(true, false, false, false, true));
}

}  // namespace
