#include "tools/bench/systems/odometry_settings.h"

#include <gmock/gmock.h>

#include <numbers>
#include <string>

namespace vobench {
namespace {
using testing::HasSubstr;

vo::Params Read(const std::string& text) {
  settings::Document document = settings::Document::FromText(text, "test.yaml");
  vo::Params params;
  ReadOdometry(document.root(), params);
  document.ThrowIfBad();
  return params;
}

std::string Complaint(const std::string& text) {
  try {
    Read(text);
  } catch (const settings::Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(OdometrySettingsTest, NothingGivenIsTheDefaults) {
  const vo::Params params = Read(""), defaults;
  EXPECT_EQ(params.filter.particles, defaults.filter.particles);
  EXPECT_EQ(params.features.max_view_angle_deg, defaults.features.max_view_angle_deg);
  EXPECT_TRUE(vo::Problems(params).empty());
}

TEST(OdometrySettingsTest, ReadsValuesWithUnits) {
  const vo::Params params = Read(
      "motion: {position_noise: 50 cm/s^1.5}\n"
      "filter: {proposal: ekf, particles: 16}\n"
      "landmark: {bearing: fixed}\n"
      "features: {sigma: 1.5 px, max_view_angle: 30 deg, subpixel: false}\n");
  EXPECT_EQ(params.motion.position_noise, 0.5);
  EXPECT_EQ(params.filter.proposal, vo::Proposal::ekf);
  EXPECT_EQ(params.filter.particles, 16);
  EXPECT_EQ(params.landmark.bearing, vo::Bearing::fixed);
  EXPECT_EQ(params.features.sigma_px, 1.5);
  EXPECT_NEAR(params.features.max_view_angle_deg, 30, 1e-12);
  EXPECT_FALSE(params.features.subpixel);
}

TEST(OdometrySettingsTest, SaysEverythingThatIsWrong) {
  const std::string complaint = Complaint(
      "filter: {particels: 16, max_iterations: 0}\n"
      "features: {sigma: 2 ms}\n"
      "odd: 1\n");
  EXPECT_THAT(complaint, HasSubstr("test.yaml:1:10"));
  EXPECT_THAT(complaint, HasSubstr("particles"));
  EXPECT_THAT(complaint, HasSubstr("max_iterations"));
  EXPECT_THAT(complaint, HasSubstr("2 ms"));
  EXPECT_THAT(complaint, HasSubstr("odd"));
}

TEST(OdometrySettingsTest, ResolvedSettingsReadAgainAreTheSame) {
  settings::Document document = settings::Document::FromText("features: {max_view_angle: 31 deg}", "test.yaml");
  vo::Params params;
  ReadOdometry(document.root(), params);
  const std::string resolved = document.Resolved();
  const vo::Params again = Read(resolved);
  EXPECT_NEAR(again.features.max_view_angle_deg, 31, 1e-12);
  EXPECT_EQ(again.score.gate, params.score.gate);
  // All that there is: two levels of keys, of which the sections are five.
  EXPECT_THAT(resolved, HasSubstr("max_searched"));
  EXPECT_THAT(resolved, HasSubstr("orientation_noise"));
}

TEST(OdometrySettingsTest, PriorHasUnits) {
  settings::Document document = settings::Document::FromText(
      "{start: origin, velocity_sigma: 50 cm/s, angular_rate_sigma: 18 deg/s, focal_error: 0.02}", "test.yaml");
  PriorSettings prior;
  ReadPrior(document.root(), prior);
  document.ThrowIfBad();
  EXPECT_EQ(prior.start, PriorSettings::Start::origin);
  EXPECT_EQ(prior.velocity_sigma, 0.5);
  EXPECT_NEAR(prior.angular_rate_sigma, std::numbers::pi / 10, 1e-15);
  EXPECT_EQ(prior.focal_error, 0.02);
}

}  // namespace
}  // namespace vobench
