// Readout time and focal length from tracks, in worlds of points whose camera moves while it reads its rows: exact
// without noise; with noise, coverage of the intervals. False-alarm rates are stated with each statistic.
#include "vo/calibration/self_calibration.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "tests/unit/vo/draws.h"
#include "tests/unit/vo/two_walls.h"
#include "vo/calibration/frame_motion.h"
#include "vo/filter/pose_gaussian.h"

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using vo_test::Draws;
using vo_test::kCamera;
using vo_test::kFrameNs;

// Motion of a hand: three sines per axis, up to 2.5 Hz.
class Hand {
 public:
  explicit Hand(Draws& draws) {
    for (Wave& wave : waves_) {
      const double frequency = 0.3 + 2.2 * draws.Uniform();
      wave = {draws.Normals<6>() / (1 + frequency), 2 * std::numbers::pi * frequency,
              2 * std::numbers::pi * draws.Uniform()};
    }
  }
  vo::Pose At(double t) const {
    vo::Vector6 d = vo::Vector6::Zero();
    for (const Wave& wave : waves_) d += std::sin(wave.rate * t + wave.phase) * wave.amplitude;
    return {0.12 * d.head<3>(), vo::Exp(0.12 * d.tail<3>())};
  }

 private:
  struct Wave {
    vo::Vector6 amplitude;
    double rate, phase;
  };
  std::array<Wave, 3> waves_;
};

struct Noise {
  double pixel = 0, landmark = 0;  // [px] of each match; the same in all matches of a landmark
};

// Frames of `count` / 30 s; their poses have the errors of an initial guess.
std::vector<vo::TrackedFrame> Film(Draws& draws, double readout_s, int count, const Noise& noise) {
  const Hand hand(draws);
  const auto guess = [&](const vo::Pose& pose) { return vo::Plus(pose, 0.002 * draws.Normals<6>()); };
  std::vector<vo::TrackedFrame> frames;
  for (int k = 0; k < count; ++k) frames.push_back({k * kFrameNs, guess(hand.At(k / 30.0)), {}});
  constexpr int kPoints = 150;
  for (int id = 0; id < kPoints; ++id) {
    const Vector3d X = Vector3d(0, 0, 3) + Vector3d(2.5, 2, 1.5).cwiseProduct(draws.Symmetrics<3>());
    const Vector2d common = noise.landmark * draws.Normals<2>();
    bool first = true;
    for (int k = 0; k < count; ++k) {
      Vector2d pixel(0, 0.5 * kCamera.height);
      for (int i = 0; i < 20; ++i) {
        const vo::Pose pose = hand.At(k / 30.0 + readout_s * (pixel.y() / (kCamera.height - 1) - 0.5));
        pixel = kCamera.Project(pose.q_WC.conjugate() * (X - pose.p_WC));
      }
      if (!kCamera.IsUsable(pixel, 5)) continue;
      if (!first) pixel += common + noise.pixel * draws.Normals<2>();
      const double variance = noise.pixel * noise.pixel + noise.landmark * noise.landmark;
      frames[k].sightings.push_back({id, pixel, (first ? 0 : variance) * Eigen::Matrix2d::Identity()});
      first = false;
    }
  }
  return frames;
}

vo::Camera WithFocalTimes(double factor) {
  vo::Camera camera = kCamera;
  camera.fx *= factor;
  camera.fy *= factor;
  return camera;
}

constexpr Noise kMatches{0.15, 0.1};

TEST(FrameMotion, IsExactForAQuarticAndKnowsItsVelocity) {
  const std::vector<double> times = {0, 0.03, 0.07, 0.1, 0.13, 0.17};
  const auto x = [](double t) { return 1 + t * (2 - t * (30 + t * (100 - 500 * t))); };
  const auto slope = [](double t) { return 2 - t * (60 + t * (300 - 2000 * t)); };
  const vo::FrameMotion motion(times);
  for (const int k : {0, 2, 5}) {
    const vo::FrameMotion::Row row = motion.At(k, 0.012);
    double value = 0, rate = 0;
    for (int j = 0; j < vo::FrameMotion::kPoses; ++j) {
      value += row.weight[j] * x(times[row.first + j]);
      rate += row.rate[j] * x(times[row.first + j]);
    }
    EXPECT_NEAR(value, x(times[k] + 0.012), 1e-12);
    EXPECT_NEAR(rate, slope(times[k] + 0.012), 1e-10);
  }
}

TEST(FrameMotion, TakesTheJitterOutOfAClockAndLeavesAnotherAlone) {
  const std::vector<double> regular = vo::RegularTimes({0, 0.036, 0.064, 0.1, 0.168, 0.2});
  for (const auto& [k, t] : {std::pair{1, 1 / 30.0}, {2, 2 / 30.0}, {4, 5 / 30.0}}) EXPECT_NEAR(regular[k], t, 1e-12);
  const std::vector<double> irregular = {0, 0.03, 0.075, 0.1};
  EXPECT_EQ(vo::RegularTimes(irregular), irregular);
}

TEST(WindowFit, IsExactWithoutNoise) {
  Draws draws(1);
  for (const double readout : {0.0, 0.013, 0.026, -0.026}) {
    const auto frames = Film(draws, readout, 30, {});
    const auto fit = vo::WindowFitting(frames, WithFocalTimes(1 / 1.05), 0, true).AllRounds();
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->readout_s.value, readout, 2e-4);
    EXPECT_NEAR(fit->log_focal.value, std::log(1.05), 2e-3);
    EXPECT_GT(fit->px_of_focal, 0);
  }
}

// Coverage of the 95 % intervals in 60 worlds; false-alarm rate of more than 9 outside: 1 in 1100. Control: an eighth
// of their width is rejected (they are wide where the motion is smooth).
TEST(WindowFit, ItsIntervalsHold) {
  Draws draws(2);
  int outside = 0, outside_narrow = 0, count = 0;
  for (int world = 0; world < 15; ++world) {
    for (const double readout : {0.0, 0.013, 0.026, -0.026}) {
      const auto fit = vo::WindowFitting(Film(draws, readout, 30, kMatches), kCamera, 0, true).AllRounds();
      ASSERT_TRUE(fit);
      const double off = std::abs(fit->readout_s.value - readout);
      EXPECT_LT(off, 0.002);
      outside += off > vo::kConfidence95 * fit->readout_s.sigma;
      outside_narrow += off > vo::kConfidence95 * fit->readout_s.sigma / 8;
      ++count;
    }
  }
  std::printf("outside the 95 %% interval: %d of %d; of an eighth of it: %d\n", outside, count, outside_narrow);
  EXPECT_LE(outside, 9);
  EXPECT_GT(outside_narrow, 9);
}

TEST(WindowFit, KeepsAReadoutThatIsStated) {
  Draws draws(3);
  const auto fit = vo::WindowFitting(Film(draws, 0.026, 30, kMatches), kCamera, 0.02, false).AllRounds();
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->readout_s.value, 0.02, 1e-9);
  EXPECT_EQ(fit->readout_s.sigma, 0);
}

// Tracks that slide from their points, by a random walk of 1 px a frame: a twentieth is outvoted, a half is refused.
TEST(WindowFit, RefusesTracksThatSlide) {
  Draws draws(9);
  for (int world = 0; world < 20; ++world) {
    const auto frames = Film(draws, 0.026, 30, kMatches);
    for (const int one_of : {20, 2}) {
      auto sliding = frames;
      std::map<int, Vector2d> slid;
      for (vo::TrackedFrame& frame : sliding)
        for (vo::Sighting& sighting : frame.sightings)
          if (sighting.landmark % one_of == 0)
            sighting.pixel += slid.try_emplace(sighting.landmark, 0, 0).first->second += draws.Normals<2>();
      const auto fit = vo::WindowFitting(sliding, kCamera, 0, true).AllRounds();
      EXPECT_EQ(fit.has_value(), one_of == 20);
      if (one_of == 20 && fit) {
        EXPECT_NEAR(fit->readout_s.value, 0.026, 0.002);
      }
    }
  }
}

// A power of two rounds no product, so that any constant with a length shows.
TEST(WindowFit, HasNoUnitOfLength) {
  Draws draws(5);
  auto frames = Film(draws, 0.013, 30, kMatches);
  const auto fit = vo::WindowFitting(frames, kCamera, 0, true).AllRounds();
  for (vo::TrackedFrame& frame : frames) frame.pose.p_WC *= 1024;
  const auto other = vo::WindowFitting(frames, kCamera, 0, true).AllRounds();
  ASSERT_TRUE(fit && other);
  EXPECT_EQ(other->readout_s.value, fit->readout_s.value);
  EXPECT_EQ(other->log_focal.value, fit->log_focal.value);
}

TEST(WindowFit, NeedsLandmarksAndFrames) {
  Draws draws(4);
  auto frames = Film(draws, 0, 30, kMatches);
  EXPECT_FALSE(vo::WindowFitting(std::span(frames).first(4), kCamera, 0, true).AllRounds());
  for (vo::TrackedFrame& frame : frames)
    std::erase_if(frame.sightings, [](const vo::Sighting& sighting) { return sighting.landmark >= 19; });
  EXPECT_FALSE(vo::WindowFitting(frames, kCamera, 0, true).AllRounds());
}

TEST(RandomEffects, MeanOfWhatAgreesAndOfWhatDoesNot) {
  const std::vector<vo::Measured> alike = {{1, 0.1}, {1.1, 0.2}};
  const vo::Measured mean = vo::RandomEffectsMean(alike);
  EXPECT_NEAR(mean.value, (100 * 1 + 25 * 1.1) / 125, 1e-12);
  EXPECT_NEAR(mean.sigma, 1 / std::sqrt(125), 1e-12);
  // Q = 50, weights 100 and 100: between = (50 - 1) / (200 - 100)
  const std::vector<vo::Measured> apart = {{0, 0.1}, {1, 0.1}};
  const vo::Measured wide = vo::RandomEffectsMean(apart);
  EXPECT_NEAR(wide.value, 0.5, 1e-12);
  EXPECT_NEAR(wide.sigma, std::sqrt((0.01 + 0.49) / 2), 1e-12);
}

// Numbers of frames and landmarks begin behind `frames`, for films one after the other.
void Feed(const std::vector<vo::TrackedFrame>& film, int frames, vo::SelfCalibration& calibration) {
  for (const vo::TrackedFrame& frame : film) {
    std::vector<vo::FeatureView> views(1);  // the first: no match
    for (const vo::Sighting& sighting : frame.sightings) {
      vo::FeatureView& view = views.emplace_back();
      view.id = 1000 * frames + sighting.landmark;
      view.pixel = sighting.pixel;
      view.R = sighting.R;
      view.status = sighting.R.isZero(0) ? vo::FeatureView::Status::fresh : vo::FeatureView::Status::matched;
    }
    if (calibration.Add(frames * kFrameNs + frame.stamp_ns, frame.pose, views)) calibration.ChangeReadout();
  }
}

vo::CalibrationEstimate Calibrated(Draws& draws, double readout_s, const vo::Camera& camera,
                                   std::optional<double> stated, int count = 60) {
  vo::SelfCalibration calibration(camera, stated);
  Feed(Film(draws, readout_s, count, kMatches), 0, calibration);
  return calibration.Estimate();
}

// Warning of an error of the focal length above 2 % with 97.5 % confidence. At the right focal length its false-alarm
// rate is far below 2.5 %; that of more than one of 20 worlds is 1e-8.
TEST(SelfCalibration, WarnsOfAFocalLengthThatIsWrongAndOfNoOther) {
  Draws draws(5);
  int right = 0, too_short = 0, too_long = 0;
  for (int world = 0; world < 20; ++world) {
    right += Calibrated(draws, 0, kCamera, 0).focal_is_wrong();
    too_short += Calibrated(draws, 0, WithFocalTimes(0.95), 0).focal_is_wrong();
    too_long += Calibrated(draws, 0.026, WithFocalTimes(1.05), std::nullopt).focal_is_wrong();
  }
  EXPECT_LE(right, 1);
  EXPECT_GE(too_short, 19);
  EXPECT_GE(too_long, 19);
}

TEST(SelfCalibration, SaysNothingOfAReadoutThatIsStatedAndUsesOneThatIsNot) {
  Draws draws(6);
  EXPECT_FALSE(Calibrated(draws, 0.026, kCamera, 0.026).readout_s);
  const vo::CalibrationEstimate global = Calibrated(draws, 0, kCamera, std::nullopt);
  EXPECT_EQ(global.readout_used_s, 0);
  EXPECT_LT(std::abs(global.readout_s->value), vo::kConfidence95 * global.readout_s->sigma);
  const vo::CalibrationEstimate rolling = Calibrated(draws, -0.013, kCamera, std::nullopt);
  EXPECT_NEAR(rolling.readout_used_s, -0.013, 0.002);
}

// First window 10 ms off: the mean over windows is used as soon as it differs by one standard deviation, not by three.
TEST(SelfCalibration, UsesTheMeanOverWindows) {
  Draws draws(8);
  vo::SelfCalibration calibration(kCamera, std::nullopt);
  Feed(Film(draws, 0.016, 30, kMatches), 0, calibration);
  Feed(Film(draws, 0.026, 60, kMatches), 30, calibration);
  const vo::CalibrationEstimate estimate = calibration.Estimate();
  EXPECT_NEAR(estimate.readout_s->value, 0.0227, 0.002);
  EXPECT_GT(estimate.readout_s->sigma, 0.0025);
  EXPECT_NEAR(estimate.readout_used_s, estimate.readout_s->value, estimate.readout_s->sigma);
}

// Of 29 frames, less than a window, fits of the first 10 to 25. A global shutter's readout is used where it is off by
// six standard deviations: false-alarm rate over 20 worlds below 0.01, were the errors 1.5 times as large as their
// covariance says. Control: the readout of a rolling one is used.
TEST(SelfCalibration, UsesAReadoutFromTheFirstPartOfAWindow) {
  Draws draws(7);
  int global = 0, rolling = 0;
  for (int world = 0; world < 20; ++world) {
    global += Calibrated(draws, 0, kCamera, std::nullopt, 29).readout_used_s != 0;
    const double used = Calibrated(draws, 0.026, kCamera, std::nullopt, 29).readout_used_s;
    rolling += std::abs(used - 0.026) < 0.004;
  }
  EXPECT_EQ(global, 0);
  EXPECT_GE(rolling, 18);
}

// Self-calibration on images: the first frames are tracked again with the estimated readout time, and the later errors
// are as with a stated one.
TEST(SelfCalibration, OfAnOdometryOnImages) {
  const auto moved = [](double k) {
    const double t = k / 30.0;
    return vo::Pose{Vector3d(0.25 * std::sin(2.9 * t), 0.2 * std::sin(3.6 * t), 0.1 * std::sin(2.3 * t)),
                    vo::Exp({0.12 * std::sin(4.5 * t), 0.12 * std::sin(3.7 * t), 0.1 * std::sin(5.1 * t)})};
  };
  constexpr int kFrames = 45;
  const vo_test::Texture texture(1, 40.0, 24);
  const auto track = [&](double readout_s, std::optional<double> stated) {
    vo::Params params = vo_test::SmallImageParams();
    params.calibration.estimate = true;
    vo::Camera camera = kCamera;
    camera.readout_s = stated;
    vo::Prior prior;
    vo::Odometry odometry(camera, params, prior, 1);
    vo::Estimate estimate;
    for (int k = 0; k < kFrames; ++k)
      estimate = odometry.Track({k * kFrameNs, vo_test::RolledView(moved, k, readout_s, texture)});
    EXPECT_EQ(estimate.stamp_ns, (kFrames - 1) * kFrameNs);
    const double turned_mrad = 1e3 * vo::Log(moved(kFrames - 1).q_WC.conjugate() * estimate.pose.q_WC).norm();
    return std::pair(*odometry.Calibration(), turned_mrad);
  };
  const auto [global, off_global] = track(0, std::nullopt);
  EXPECT_EQ(global.readout_used_s, 0);
  EXPECT_LT(std::abs(global.readout_s->value), vo::kConfidence95 * global.readout_s->sigma);
  const auto [found, off_found] = track(0.026, std::nullopt);
  EXPECT_NEAR(found.readout_used_s, 0.026, 0.002);
  EXPECT_NEAR(found.readout_s->value, 0.026, vo::kConfidence95 * found.readout_s->sigma);
  const auto [stated, off_stated] = track(0.026, 0.026);
  EXPECT_FALSE(stated.readout_s);
  const auto [wrong, off_wrong] = track(0.026, 0);
  std::printf("orientation off by [mrad]: readout found %.2f, stated %.2f, taken for global %.2f\n", off_found,
              off_stated, off_wrong);
  EXPECT_LT(off_found, 1.5 * off_stated + 0.5);
  EXPECT_GT(off_wrong, 2 * off_found);
}

}  // namespace
