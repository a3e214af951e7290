#include "sim/points/point_measurement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "sim/motion/so3.h"
#include "tests/unit/sim/points.h"

namespace sim {
namespace {

constexpr int kViews = 40000;
constexpr double kZ = 5;  // standard deviations; false-alarm rate 1 in 1.7 million

// kViews measurements of a landmark at the middle of the image: the number of missing ones, the errors of the others.
struct Views {
  double missing = 0;
  std::vector<glm::dvec2> errors;
};
Views Measured(const PointMeasurement& measurement, double moved_px = 0) {
  Views views;
  for (std::uint32_t k = 0; k < kViews; ++k) {
    const glm::dvec2 at(320, 240);
    if (const auto seen = Measure(measurement, CameraParams(), {5, k / 200, k % 200}, at, moved_px)) {
      views.errors.push_back(*seen - at);
    } else {
      views.missing += 1;
    }
  }
  return views;
}

// z-score of a binomial count: (count - n p) / sqrt(n p (1 - p)).
double Score(double count, double n, double probability) {
  return (count - n * probability) / std::sqrt(n * probability * (1 - probability));
}

TEST(PointMeasurement, DropsAreAsManyAsAskedFor) {
  PointMeasurement measurement;
  measurement.drop_probability = 0.1;
  const double missing = Measured(measurement).missing;
  EXPECT_LT(std::abs(Score(missing, kViews, 0.1)), kZ);
  EXPECT_GT(std::abs(Score(missing, kViews, 0.11)), kZ) << "a tenth more would be noticed";
  measurement.drop_probability = 1;
  EXPECT_EQ(Measured(measurement).missing, kViews);
  EXPECT_EQ(Measured({}).missing, 0);
}

TEST(PointMeasurement, OutliersAreAsManyAsAskedForAndUniform) {
  PointMeasurement measurement;
  measurement.outlier_probability = 0.05;
  measurement.outlier_radius_px = 40;
  double far = 0, inner = 0;
  for (const glm::dvec2& e : Measured(measurement).errors) {
    EXPECT_LE(glm::length(e), 40);
    far += glm::length(e) > 8;  // noise beyond 8 px: 1 in 8e13
    inner += glm::length(e) > 8 && glm::length(e) <= 24;
  }
  const double share = 1 - 64.0 / 1600;  // of the disc
  EXPECT_LT(std::abs(Score(far, kViews, 0.05 * share)), kZ);
  EXPECT_GT(std::abs(Score(far, kViews, 0.06 * share)), kZ);
  EXPECT_LT(std::abs(Score(inner, far, (576.0 - 64) / (1600 - 64))), kZ) << "by area";
  // Uniform over the whole image: bounds, and the shares of the left and upper quarters.
  measurement.outlier_radius_px = 0;
  measurement.outlier_probability = 1;
  double left = 0, top = 0;
  for (const glm::dvec2& e : Measured(measurement).errors) {
    const glm::dvec2 at = e + glm::dvec2(320, 240);
    EXPECT_TRUE(at.x > -0.5 && at.x < 639.5 && at.y > -0.5 && at.y < 479.5);
    left += at.x < 159.5;
    top += at.y < 119.5;
  }
  EXPECT_LT(std::abs(Score(left, kViews, 0.25)), kZ);
  EXPECT_LT(std::abs(Score(top, kViews, 0.25)), kZ);
}

TEST(PointMeasurement, BlurLosesByItsLength) {
  PointMeasurement measurement;
  measurement.blur_length_px = 8;
  EXPECT_EQ(BlurLoss(measurement, 0), 0);
  EXPECT_NEAR(BlurLoss(measurement, 4), 1.0 / 17, 1e-15);
  EXPECT_NEAR(BlurLoss(measurement, 8), 0.5, 1e-15);
  EXPECT_NEAR(BlurLoss(measurement, 16), 16.0 / 17, 1e-15);
  EXPECT_EQ(BlurLoss(measurement, std::numeric_limits<double>::infinity()), 1);
  EXPECT_EQ(BlurLoss({}, 1e9), 0);
  const double missing = Measured(measurement, 6).missing, p = 81.0 / (256 + 81);
  EXPECT_LT(std::abs(Score(missing, kViews, p)), kZ);
  EXPECT_GT(std::abs(Score(missing, kViews, 1.1 * p)), kZ);
  // Drops and blur are independent: 1 - (1 - 0.5)(1 - p).
  measurement.drop_probability = 0.5;
  EXPECT_LT(std::abs(Score(Measured(measurement, 6).missing, kViews, 1 - 0.5 * (1 - p))), kZ);
}

// Image velocity (1 + x^2, x y) w of a point at (x, y) on the plane z = 1: a camera that turns about its y axis at w.
TEST(PointMeasurement, AWorldLosesWhatItsCameraBlurs) {
  Scenario scenario = PointScenario();
  scenario.time.duration_s = 4;
  std::get<SampledMotion>(scenario.motion).angular_rate = {0, 1, 0};
  scenario.points->measurement.blur_length_px = 6;
  scenario.points->measurement.blur_exposure_s = 0.01;
  PointWorld world(scenario);
  double seen = 0, in_view = 0, expected = 0, with_tenth_more = 0, variance = 0;
  const std::vector<PointFrame> frames = Play(world);
  for (const PointFrame& frame : frames) {
    for (const PointObservation& o : frame.observations)
      seen += world.landmarks()[static_cast<std::size_t>(o.id)].first_frame < frame.index;
    for (const PointLandmark& landmark : world.landmarks()) {
      if (landmark.first_frame >= frame.index) continue;
      const auto at = world.Project(landmark, frame.index);
      if (!at) continue;
      const double x = (at->x - 319.5) / 525, y = (at->y - 239.5) / 525;
      const auto loss = [&](double exposure) {
        const double ratio = 525 * exposure * std::hypot(1 + x * x, x * y) / 6;
        return std::pow(ratio, 4) / (1 + std::pow(ratio, 4));
      };
      in_view += 1;
      expected += loss(0.01);
      with_tenth_more += loss(0.011);
      variance += loss(0.01) * (1 - loss(0.01));
    }
  }
  EXPECT_GT(in_view, 9000);
  EXPECT_LT(std::abs(in_view - seen - expected) / std::sqrt(variance), kZ);
  EXPECT_GT(std::abs(in_view - seen - with_tenth_more) / std::sqrt(variance), kZ);
}

// First view of a landmark, which defines its appearance: never dropped, never an outlier.
TEST(PointMeasurement, AFirstViewHasNoiseOnly) {
  Scenario scenario = MovingPointScenario();
  scenario.points->measurement.drop_probability = 0.5;
  scenario.points->measurement.outlier_probability = 1;
  PointWorld world(scenario);
  std::size_t firsts = 0;
  const std::vector<PointFrame> frames = Play(world);
  for (const PointFrame& frame : frames) {
    for (const PointObservation& o : frame.observations) {
      const PointLandmark& landmark = world.landmarks()[static_cast<std::size_t>(o.id)];
      if (landmark.first_frame != frame.index) continue;
      ++firsts;
      EXPECT_LT(glm::distance(glm::dvec2(o.x_px, o.y_px), *world.Project(landmark, frame.index)), 7);
    }
  }
  EXPECT_EQ(firsts, world.landmarks().size());
}

}  // namespace
}  // namespace sim
