// Selection of the landmarks that the map keeps.
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

TEST(LandmarksToKeep, PermanentOnesGoLast) {
  vo::LandmarkParams landmark;
  landmark.max_landmarks = 3;
  const vo::LandmarkRecord records[] = {Record(true, 1, 900, 0), Record(true, 1, 800, 7), Record(true, 1, 700, 2),
                                        Record(false, 1, 60, 2), Record(false, 1, 0, 0)};
  EXPECT_THAT(vo::LandmarksToKeep(records, 0, landmark, {}), ElementsAre(true, false, true, false, true));
}

TEST(LandmarksToKeep, RoomForNewOnesIsMadeByWhatWasNotSearched) {
  vo::LandmarkParams landmark;
  landmark.max_landmarks = 6;
  vo::LandmarkRecord records[] = {Record(true, 1, 900, 0), Record(true, 1, 800, 7), Record(true, 1, 700, 2),
                                  Record(false, 1, 60, 2), Record(false, 1, 3, 0)};
  EXPECT_THAT(vo::LandmarksToKeep(records, 1, landmark, {}), ElementsAre(true, true, true, true, true));
  EXPECT_THAT(vo::LandmarksToKeep(records, 2, landmark, {}), ElementsAre(true, true, true, false, true));
  EXPECT_THAT(vo::LandmarksToKeep(records, 3, landmark, {}), ElementsAre(true, false, true, false, true));
  EXPECT_THAT(vo::LandmarksToKeep(records, 100, landmark, {}), ElementsAre(true, false, false, false, true));
  for (vo::LandmarkRecord& record : records) ++record.frames_unsearched;  // a frame without a search
  EXPECT_THAT(vo::LandmarksToKeep(records, 100, landmark, {}), ElementsAre(true, false, false, false, true));
}

// 200 permanent landmarks: half have consecutive ids, the others ids ten apart.
TEST(LandmarksToKeep, PermanentOnesAreThinned) {
  vo::LandmarkParams landmark;
  landmark.max_landmarks = 60;
  std::vector<vo::LandmarkRecord> records;
  for (int i = 0; i < 200; ++i) {
    records.push_back(Record(true, 1, 900, 5));
    records.back().id = i < 100 ? i : 10 * i;  // 0 ... 99, 1000 ... 1990
  }
  const std::vector<bool> keep = vo::LandmarksToKeep(records, 0, landmark, {});
  EXPECT_EQ(std::ranges::count(keep, true), 60);
  std::vector<int> kept;
  for (std::size_t i = 0; i < records.size(); ++i)
    if (keep[i]) kept.push_back(records[i].id);
  // No landmark of the sparse half is removed while closer ones of the dense half remain.
  for (std::size_t i = 1; i + 1 < kept.size(); ++i) EXPECT_GE(kept[i + 1] - kept[i - 1], 20) << kept[i];
}

TEST(LandmarksToKeep, LostOnesStayWhereTheirDepthIsKnown) {
  vo::LandmarkRecord records[] = {Record(false, 0, 50, 5), Record(false, 0, 50, 5), Record(false, 0, 50, 5)};
  records[0].lost = records[1].lost = records[1].known = records[2].known = true;
  EXPECT_THAT(vo::LandmarksToKeep(records, 0, {}, {}), ElementsAre(false, true, false));
}

}  // namespace
