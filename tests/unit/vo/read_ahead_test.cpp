// Frames read ahead: those of the source, in its order, and at most the given number of them.
#include "vo/sequence/read_ahead.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>
#include <thread>

namespace {

// Source of frames of one colour each, which ends or throws after `frames` of them.
class Colours : public vo::FrameSource {
 public:
  Colours(int frames, bool breaks) : frames_(frames), breaks_(breaks) {}
  std::optional<std::int64_t> Count() const override { return frames_; }
  std::optional<vo::Frame> Next() override {
    const int k = given_;
    if (k == frames_ && breaks_) throw std::runtime_error("frame " + std::to_string(k) + " is broken");
    if (k == frames_) return std::nullopt;
    ++given_;
    return Made(k);
  }
  static vo::Frame Made(int k) { return {1000 * k, cv::Mat(48, 64, CV_8UC3, cv::Scalar(k, 2 * k, 200 - k))}; }
  int given() const { return given_; }

 private:
  int frames_;
  bool breaks_;
  std::atomic<int> given_ = 0;
};

TEST(ReadAhead, GivesTheSameInTheSameOrder) {
  Colours source(60, false);
  vo::ReadAhead ahead(source);
  for (int k = 0; k < 60; ++k) {
    const std::optional<vo::PreparedFrame> frame = ahead.Next();
    ASSERT_TRUE(frame) << k;
    const vo::PreparedFrame expected(Colours::Made(k));
    EXPECT_EQ(frame->frame.stamp_ns, 1000 * k);
    EXPECT_EQ(cv::norm(frame->frame.image, expected.frame.image, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(frame->grey, expected.grey, cv::NORM_INF), 0);
  }
  EXPECT_FALSE(ahead.Next());
  EXPECT_FALSE(ahead.Next());  // and stays at its end
}

TEST(ReadAhead, HoldsNoMoreThanWasSaid) {
  Colours source(60, false);
  vo::ReadAhead ahead(source, 3);
  for (int taken = 1; taken <= 20; ++taken) {
    ASSERT_TRUE(ahead.Next());
    if (taken % 5 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_LE(source.given(), taken + 3 + 1) << "three wait, one is being read";
  }
}

TEST(ReadAhead, ErrorsComeAfterEarlierFrames) {
  Colours source(2, true);
  vo::ReadAhead ahead(source);
  EXPECT_TRUE(ahead.Next());
  EXPECT_TRUE(ahead.Next());
  try {
    ahead.Next();
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "frame 2 is broken");
  }
  EXPECT_FALSE(ahead.Next());
}

TEST(ReadAhead, EndsWhileFramesAreWaiting) {
  Colours source(1000, false);
  for (int trial = 0; trial < 50; ++trial) {
    vo::ReadAhead ahead(source);
    if (trial % 2 == 0) {
      EXPECT_TRUE(ahead.Next());
    }
  }
  EXPECT_LT(source.given(), 1000);
}

}  // namespace
