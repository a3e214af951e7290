// Failed predictions: the agreement below which one has failed, and what is predicted instead.
#include "vo/frontend/adaptive_association.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/unit/vo/far_scene.h"
#include "vo/geometry/so3.h"

namespace {

// Filter of a camera at rest.
class Still : public vo::Filter {
 public:
  explicit Still(bool initialising) { answer_.initialising = initialising; }
  void Predict(double, const vo::MotionInput& input) override { input_ = input; }
  void PredictAgain(const vo::MotionInput&) override {}
  const vo::FilterAnswer& Update(std::span<const vo::Match>) override { return answer_; }
  void AddLandmarks(std::span<const vo::FirstView>) override {}
  void KeepLandmarks(const std::vector<bool>&) override {}
  int landmark_count() const override { return 0; }
  const vo::FilterAnswer& answer() const override { return answer_; }
  std::vector<vo::ImagePrediction> PredictImages(std::span<const int>) const override { return {}; }
  vo::ReferencePath Reference() const override { return {}; }
  std::vector<LandmarkBelief> LandmarkBeliefs() const override { return {}; }
  std::vector<LandmarkSpread> LandmarkSpreads() const override { return {}; }
  void SetVelocity(const vo::Vector6& velocity) { answer_.belief.velocity = velocity; }
  const vo::MotionInput& input() const { return input_; }

 private:
  vo::FilterAnswer answer_;
  vo::MotionInput input_;
};

constexpr double kDt = 1 / 30.0;
const Eigen::Vector3d kTurn(0.05, -0.3, 0);  // [rad] between the two images

// Inputs of the predictions of a frame in which nothing is found.
std::vector<vo::MotionInput> InputsWithoutMatches(const vo::Camera& camera, bool initialising) {
  Still filter(initialising);
  vo::AdaptiveAssociation adaptive(camera, {});
  adaptive.Keep(vo_test::FarView(camera, Eigen::Quaterniond::Identity()));
  std::vector<vo::MotionInput> inputs;
  const auto associate = [&](const vo::MotionInput& input, vo::Search) {
    inputs.push_back(input);
    vo::Association association;
    association.searched.resize(50);
    association.predicted.covariance.setIdentity();
    association.agreed = association.predicted;
    return association;
  };
  adaptive.PredictAndAssociate(filter, kDt, 0, vo_test::FarView(camera, vo::Exp(kTurn)), associate,
                               [](const vo::Association&, bool) { return std::nullopt; });
  return inputs;
}

// A rotation is what direct alignment measures: the velocity stays, and the turn is as uncertain as its measurement.
TEST(AdaptiveAssociation, AFailedPredictionTurnsWithTheImage) {
  const vo::Camera camera;
  const std::vector<vo::MotionInput> inputs = InputsWithoutMatches(camera, false);
  ASSERT_GE(inputs.size(), 3u);
  EXPECT_FALSE(inputs[0].turn.has_value());
  ASSERT_TRUE(inputs[1].turn.has_value());
  EXPECT_LT(vo::Log(*inputs[1].turn * vo::Exp(kTurn).conjugate()).norm(), 1e-3);
  EXPECT_EQ(inputs[1].position_noise, inputs[0].position_noise);
  const vo::MotionModel model = vo::NearlyConstantVelocity({}, kDt, inputs[1]);
  EXPECT_GE(std::sqrt(model.Q(3, 3)) * camera.fx, camera.width / 640.0 * (1 - 1e-9)) << "[px]";
  EXPECT_GT(inputs[2].position_noise, 3.9) << "then the velocity may have changed as well";
}

TEST(AdaptiveAssociation, AtTheStartTheVelocityIsWidenedFirst) {
  const std::vector<vo::MotionInput> inputs = InputsWithoutMatches({}, true);
  ASSERT_GE(inputs.size(), 3u);
  EXPECT_FALSE(inputs[1].turn.has_value());
  EXPECT_GT(inputs[1].position_noise, 3.9);
  ASSERT_TRUE(inputs[2].turn.has_value());
  EXPECT_GT(inputs[2].position_noise, inputs[0].position_noise);
}

// Orientation noise of the frame behind one that is matched once its prediction has `turn`.
double NoiseBehindATurn(const Eigen::Vector3d& turn) {
  const vo::Camera camera;
  Still filter(false);
  vo::AdaptiveAssociation adaptive(camera, {});
  adaptive.Keep(vo_test::FarView(camera, Eigen::Quaterniond::Identity()));
  double first = 0;
  const auto associate = [&](const vo::MotionInput& input, vo::Search) {
    if (first == 0) first = input.orientation_noise;
    vo::Association association;
    association.searched.resize(50);
    if (input.turn) association.matches.resize(50);
    association.predicted.mean.q_WC = input.turn.value_or(Eigen::Quaterniond::Identity());
    association.predicted.covariance = 1e-4 * vo::Matrix6::Identity();
    association.agreed = association.predicted;
    association.agreed.covariance *= 0.01;
    return association;
  };
  const auto relocalise = [](const vo::Association&, bool) { return std::nullopt; };
  const cv::Mat image = vo_test::FarView(camera, vo::Exp(turn));
  adaptive.PredictAndAssociate(filter, kDt, 0, image, associate, relocalise);
  adaptive.Keep(image);
  first = 0;
  adaptive.PredictAndAssociate(filter, kDt, 0, image, associate, relocalise);
  return first;
}

TEST(AdaptiveAssociation, ProcessNoiseContainsTheTurnThatWasMeasured) {
  EXPECT_GT(NoiseBehindATurn(kTurn), 10 * NoiseBehindATurn(0.01 * kTurn));
}

// Without matches the velocity decays with the times of the last frame that had some, and not with its own.
TEST(AdaptiveAssociation, AVelocityDecaysWithTheTimesOfTheLastMatches) {
  Still filter(false);
  vo::AdaptiveAssociation adaptive({}, {});
  filter.SetVelocity((vo::Vector6() << 1, 0, 0, 0, 0.5, 0).finished());
  adaptive.Predict(filter, kDt, 0);
  const vo::MotionInput matched = filter.input();
  const vo::MotionParams params;
  const double psd = matched.position_noise * params.position_noise * params.position_noise;
  EXPECT_EQ(matched.position_time, vo::VelocityTime({1, 0, 0}, psd));
  EXPECT_NE(matched.position_time, matched.orientation_time);
  for (const double speed : {1e-3, 1e3}) {
    filter.SetVelocity(vo::Vector6::Constant(speed));
    adaptive.Predict(filter, kDt, kDt);
    EXPECT_EQ(filter.input().position_time, matched.position_time);
    EXPECT_EQ(filter.input().orientation_time, matched.orientation_time);
  }
  adaptive.Predict(filter, kDt, 0);
  EXPECT_EQ(filter.input().position_time, vo::kMostVelocityTime);
}

TEST(UsualAgreement, AHalfIsDoubtfulWhereMoreIsUsual) {
  vo::UsualAgreement usual;
  for (int k = 0; k < 50; ++k) EXPECT_EQ(usual.Least(0.9), 0.5);
  EXPECT_EQ(usual.Least(0.45), 0.5);
}

TEST(UsualAgreement, WhereLittleIsUsualLittleIsEnough) {
  vo::UsualAgreement usual;
  int failed = 0;
  for (int k = 0; k < 50; ++k) failed += 0.45 < usual.Least(0.45);
  EXPECT_GT(failed, 3);
  EXPECT_LT(failed, 20);
  EXPECT_EQ(usual.Least(0.1), 0.4) << "0.8 of 0.45 is less";
  for (int k = 0; k < 50; ++k) EXPECT_EQ(usual.Least(0.1), 0.4);
}

}  // namespace
