#include <gmock/gmock.h>

#include <numbers>
#include <string>
#include <vector>

#include "tools/bench/systems/experiment.h"
#include "tools/bench/systems/systems.h"

namespace vobench {
namespace {
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

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

struct Any {
  template <class T>
  operator T() const;
};
// Members of an aggregate.
template <class S, class... Given>
constexpr std::size_t Members() {
  if constexpr (requires { S{Given{}..., Any{}}; }) return Members<S, Given..., Any>();
  return sizeof...(Given);
}
template <class S>
std::size_t Rows() {
  S values;
  settings::FieldRows table;
  Visit(table, values);
  return table.rows.size();
}

TEST(OdometrySettingsTest, EveryMemberHasARow) {
  EXPECT_EQ(Rows<vo::MotionParams>(), Members<vo::MotionParams>());
  EXPECT_EQ(Rows<vo::FilterParams>() + 1, Members<vo::FilterParams>()) << "`sampled` is the system's";
  EXPECT_EQ(Rows<vo::LandmarkParams>(), Members<vo::LandmarkParams>());
  EXPECT_EQ(Rows<vo::ScoreParams>(), Members<vo::ScoreParams>());
  EXPECT_EQ(Rows<vo::FeatureParams>(), Members<vo::FeatureParams>());
  EXPECT_EQ(Rows<vo::TargetParams>(), Members<vo::TargetParams>());
  EXPECT_EQ(Rows<vo::CalibrationParams>(), Members<vo::CalibrationParams>());
  EXPECT_EQ(Rows<PriorSettings>(), Members<PriorSettings>());
}

TEST(OdometrySettingsTest, NothingGivenIsTheDefaults) {
  const vo::Params params = Read(""), defaults;
  EXPECT_EQ(params.filter.particles, defaults.filter.particles);
  EXPECT_EQ(params.features.max_view_angle, defaults.features.max_view_angle);
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
  EXPECT_NEAR(params.features.max_view_angle, std::numbers::pi / 6, 1e-15);
  EXPECT_FALSE(params.features.subpixel);
}

TEST(OdometrySettingsTest, AllProblemsAtOnce) {
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
  EXPECT_EQ(again.features.max_view_angle, params.features.max_view_angle);
  EXPECT_EQ(again.score.gate, params.score.gate);
  // Keys that are not set have their defaults.
  EXPECT_THAT(resolved, HasSubstr("max_searched"));
  EXPECT_THAT(resolved, HasSubstr("orientation_noise"));
}

TEST(OdometrySettingsTest, OldKeyNamesTheNew) {
  for (const auto& [old, now] :
       {std::pair{"features: {window: 9}", "'features.window' has a new name: 'search_normal'"},
        {"features: {window_quick: 5}", "'search_first'"},
        {"features: {window_enlarged: 17}", "'search_wide'"},
        {"features: {window_lost: 49}", "'search_uncertain'"},
        {"features: {window_recovery: 241}", "'search_relocalise'"},
        {"features: {pilots: 16}", "'coarse_features'"},
        {"score: {blind_share: 0}", "'min_found_ratio'"},
        {"filter: {weight: equal}", "'equal' has a new name: 'uniform'"}}) {
    EXPECT_THAT(Complaint(old), AllOf(HasSubstr(now), Not(HasSubstr("\n")), Not(HasSubstr("known")))) << old;
  }
}

// Ranges: the same for settings files and structs.
TEST(OdometrySettingsTest, RangeIsOneForFilesAndStructs) {
  for (const auto& [text, rule] : {std::pair{"landmark: {max_landmarks: 9}", "'9' must be at least 10"},
                                   {"filter: {ukf_alpha: 0}", "'0' must be above 0 and at most 1"},
                                   {"filter: {ukf_alpha: 0.5, ukf_beta: 0.2}", "filter.ukf_alpha squared"},
                                   {"features: {search_normal: 8}", "'8' must be odd and at least 1"},
                                   {"features: {min_distance: 0}", "'0' must be positive"},
                                   {"score: {detection: 1}", "'1' must be above 0 and below 1"},
                                   {"features: {max_view_angle: 90 deg}", "and below 90 deg"}}) {
    EXPECT_THAT(Complaint(text), HasSubstr(rule));
  }
}

TEST(OdometrySettingsTest, RuleBetweenValuesAtItsKey) {
  EXPECT_THAT(Complaint("filter:\n  proposal: ukf\n  lag: 5\n"), AllOf(HasSubstr("test.yaml:3:8: filter.lag = 5 ")));
}

TEST(OdometrySettingsTest, LagAndWeightFollowFromWhatIsGiven) {
  using enum vo::Weight;
  const auto is = [](const std::string& given, int lag, vo::Weight weight) {
    const vo::FilterParams params = Read("filter: {" + given + "}").filter;
    EXPECT_EQ(params.lag, lag) << given;
    EXPECT_EQ(params.weight, weight) << given;
  };
  is("particles: 4", 5, uniform);
  is("lag: 0", 0, evidence);
  is("proposal: ukf", 0, evidence);
  is("proposal: bootstrap", 0, importance);
  is("weight: importance", 0, importance);
  is("weight: evidence", 5, evidence);
}

std::vector<std::string> Values(vo::Params params) {
  settings::FieldRows table;
  Visit(table, params);
  std::vector<std::string> values;
  for (const settings::FieldRow& row : table.rows) values.push_back(row.key + " = " + row.value);
  return values;
}

TEST(OdometrySettingsTest, PapersSystemsAreItsSettings) {
  const std::string camera = "features: {fast_threshold_min: 4";
  const vo::Params tuned =
      Read("{filter: {lag: 3, particles: 30}, landmark: {proving_matches: 4}, motion: {position_noise: 0.6}, " +
           camera + ", sigma: 0.25 px}}");
  const vo::Params paper = Read(
      "{filter: {particles: 8, proposal: ukf, weight: importance}, landmark: {bearing: fixed, scale_sigma: 0, "
      "proving_matches: 0}, "
      "motion: {position_noise: 0.6, adaptive: false}, calibration: {estimate: false}, " +
      camera +
      ", sigma: 2 px, subpixel: false, noise: constant, rolling_shutter: 0 s, search_first: 1, coarse_features: 0}, "
      "score: {min_found_ratio: 0}}");
  for (const std::string system : {"rb2pf", "rbpf"}) {
    EXPECT_EQ(Values(ForSystem(system + "_paper", tuned)), Values(ForSystem(system, paper)));
    EXPECT_EQ(ForSystem(system + "_paper", tuned).filter.sampled, ForSystem(system, paper).filter.sampled);
    EXPECT_NE(Values(ForSystem(system, tuned)), Values(ForSystem(system, paper)));
  }
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
