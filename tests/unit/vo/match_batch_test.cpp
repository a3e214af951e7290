// Eight matches at a time against the formulas one by one, and all instruction sets against one another.
#include "vo/map/match_batch.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "tests/unit/vo/draws.h"
#include "tests/unit/vo/landmark_update.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/geometry/so3.h"

namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Landmarks of three anchors, matched from a camera nearby. Every third has a fixed bearing, every fifth lies behind
// the camera.
struct Scene {
  std::vector<vo::Landmark> landmarks;
  std::vector<int> anchor_of;
  std::vector<vo::Pose> anchors;
  std::vector<vo::Match> matches;  // not of all landmarks, and not in their order
  vo::Pose camera;
  vo::LocalMap map() const { return {landmarks, anchor_of, anchors}; }
};

Scene MakeScene(unsigned seed, int matches, bool some_behind = true) {
  vo_test::Draws draws(seed);
  Scene scene;
  for (int a = 0; a < 3; ++a)
    scene.anchors.push_back({0.1 * draws.Symmetrics<3>(), vo::Exp(0.05 * draws.Symmetrics<3>())});
  scene.camera = {0.2 * draws.Symmetrics<3>(), vo::Exp(0.1 * draws.Symmetrics<3>())};
  const int count = 2 * matches + 1;
  for (int n = 0; n < count; ++n) {
    vo::Landmark landmark;
    landmark.mean = {0.5 * draws.Symmetric(), 0.4 * draws.Symmetric(), 0.25 + 0.2 * draws.Symmetric()};
    if (n % 3 == 0) {
      landmark.covariance(2, 2) = 0.02;
    } else {
      Matrix3d root;
      for (int k = 0; k < 9; ++k) root(k / 3, k % 3) = (k >= 6 ? 0.1 : 0.002) * draws.Symmetric();
      landmark.covariance = root * root.transpose();
    }
    if (some_behind && n % 5 == 0) landmark.mean.z() = -40;  // behind the camera
    scene.landmarks.push_back(landmark);
    scene.anchor_of.push_back(n % 3);
  }
  if (some_behind) scene.camera.p_WC.z() = -0.5;
  for (int i = 0; i < matches; ++i) {
    const int n = (7 * i + 3) % count;
    const double sigma = 1.0 / 500;
    Matrix2d R;
    R << 1.2, 0.3, 0.3, 0.8;
    const Vector3d offset = 0.03 * draws.Symmetrics<3>();
    const vo::Projection h = vo::Project(
        vo::AnchorView(scene.camera, scene.anchors[scene.anchor_of[n]]).ShiftedBy(offset), scene.landmarks[n].mean);
    scene.matches.push_back({n, h.z + 5 * sigma * draws.Symmetrics<2>(), sigma * sigma * R, offset});
  }
  return scene;
}

// Reference: the formulas, match by match.
struct Terms {
  bool in_front = false;
  Vector2d e = Vector2d::Zero();
  vo::Matrix26 J = vo::Matrix26::Zero();
  Eigen::Matrix<double, 3, 2> gain = Eigen::Matrix<double, 3, 2>::Zero();
};
vo::MatchBatch::Information Expected(const Scene& scene, const std::vector<Vector3d>& theta, bool marginal,
                                     std::vector<Terms>& terms) {
  vo::MatchBatch::Information sum{vo::Matrix6::Zero(), vo::Vector6::Zero(), 0, 0};
  terms.clear();
  for (std::size_t i = 0; i < scene.matches.size(); ++i) {
    const vo::Match& match = scene.matches[i];
    const vo::Landmark& landmark = scene.landmarks[match.landmark];
    const vo::Projection h = vo::Project(
        vo::AnchorView(scene.camera, scene.anchors[scene.anchor_of[match.landmark]]).ShiftedBy(match.centre_offset_W),
        theta[i]);
    terms.emplace_back();
    if (!h.in_front) continue;
    const Vector2d e = match.z - h.z - h.J_landmark * (landmark.mean - theta[i]);
    const Matrix2d S = h.J_landmark * landmark.covariance * h.J_landmark.transpose() + match.R;
    const Matrix2d W = S.inverse();
    terms.back() = {true, e, h.J_pose, landmark.covariance * h.J_landmark.transpose() * W};
    sum.A += h.J_pose.transpose() * W * h.J_pose;
    sum.b += h.J_pose.transpose() * W * e;
    sum.cost += e.dot(W * e);
    sum.log_det += std::log((2 * std::numbers::pi * S).determinant());
    if (!marginal) continue;
    const Vector2d q = h.J_landmark * landmark.covariance.col(2);
    const Vector3d gradient = h.J_shift.transpose() * W * q;
    sum.b.head<3>() += gradient;
    sum.A.topLeftCorner<3, 3>() +=
        q.dot(W * q) * h.J_shift.transpose() * W * h.J_shift + gradient * gradient.transpose();
  }
  return sum;
}

void ExpectNear(const vo::MatchBatch::Information& a, const vo::MatchBatch::Information& b) {
  EXPECT_LE((a.A - b.A).norm(), 1e-12 * b.A.norm());
  EXPECT_LE((a.b - b.b).norm(), 1e-11 * b.b.norm());  // terms of both signs
  EXPECT_NEAR(a.cost, b.cost, 1e-11 * b.cost);
  EXPECT_NEAR(a.log_det, b.log_det, 1e-12 * std::abs(b.log_det) + 1e-12);
}

class EveryInstructionSet : public testing::TestWithParam<vo::InstructionSet> {};
INSTANTIATE_TEST_SUITE_P(MatchBatch, EveryInstructionSet, testing::ValuesIn(vo::AvailableInstructionSets()),
                         [](const auto& set) { return std::to_string(static_cast<int>(set.param)); });

TEST_P(EveryInstructionSet, SumsAreThoseOfTheFormulas) {
  vo::MatchBatch batch(GetParam());  // one for all scenes: a state left by an earlier one would show
  for (const int count : {1, 40, 7, 8, 9, 16, 23}) {
    for (const bool marginal : {false, true}) {
      SCOPED_TRACE(testing::Message() << count << " matches, marginal " << marginal);
      Scene scene = MakeScene(static_cast<unsigned>(count), count);
      std::vector<Vector3d> theta;
      for (const vo::Match& match : scene.matches) theta.push_back(scene.landmarks[match.landmark].mean);
      std::vector<Terms> terms;
      batch.SetMatches(scene.matches);
      batch.Load(scene.map());
      ExpectNear(batch.Linearise(scene.camera, marginal), Expected(scene, theta, marginal, terms));

      // Landmarks follow the change of the pose, except those behind the camera.
      const vo::Vector6 d = (vo::Vector6() << 0.01, -0.02, 0.015, 0.004, -0.003, 0.002).finished();
      int behind = 0;
      for (std::size_t i = 0; i < theta.size(); ++i) {
        behind += !terms[i].in_front;
        if (terms[i].in_front)
          theta[i] = scene.landmarks[scene.matches[i].landmark].mean + terms[i].gain * (terms[i].e - terms[i].J * d);
      }
      EXPECT_GT(behind, 0);
      scene.camera = vo::Plus(scene.camera, d);
      batch.Follow(d);
      ExpectNear(batch.Linearise(scene.camera, marginal), Expected(scene, theta, marginal, terms));
    }
  }
}

// Squared Mahalanobis distances at the given landmarks and covariances, independent of later linearisation points and
// of Inflate.
TEST_P(EveryInstructionSet, DistancesAreThoseOfTheResidualsAsGiven) {
  for (const int count : {1, 8, 13, 40}) {
    SCOPED_TRACE(testing::Message() << count << " matches");
    const Scene scene = MakeScene(static_cast<unsigned>(200 + count), count);
    vo::MatchBatch batch(GetParam());
    batch.SetMatches(scene.matches);
    batch.Load(scene.map());
    batch.Inflate(std::vector<double>(static_cast<std::size_t>(count), 7.0));
    batch.Linearise(scene.camera, false);
    batch.Follow(vo::Vector6::Constant(0.01));
    std::vector<double> distances;
    batch.SquaredDistances(scene.camera, distances);
    ASSERT_EQ(distances.size(), scene.matches.size());
    for (std::size_t i = 0; i < distances.size(); ++i) {
      const vo::Match& match = scene.matches[i];
      const vo::Landmark& landmark = scene.landmarks[match.landmark];
      const vo::Projection h = vo::Project(
          vo::AnchorView(scene.camera, scene.anchors[scene.anchor_of[match.landmark]]).ShiftedBy(match.centre_offset_W),
          landmark.mean);
      if (!h.in_front) {
        EXPECT_EQ(distances[i], INFINITY) << i;
        continue;
      }
      const Vector2d e = match.z - h.z;
      const Matrix2d S = h.J_landmark * landmark.covariance * h.J_landmark.transpose() + match.R;
      EXPECT_NEAR(distances[i], e.dot(S.inverse() * e), 1e-10 * distances[i]) << i;
    }
  }
}

TEST_P(EveryInstructionSet, InflatedIsAsIfGivenSo) {
  Scene scene = MakeScene(6, 13);
  vo::MatchBatch batch(GetParam()), expected(GetParam());
  batch.SetMatches(scene.matches);
  batch.Load(scene.map());
  std::vector<double> factors;
  for (vo::Match& match : scene.matches)
    match.R *= factors.emplace_back(1.0 + 0.5 * static_cast<double>(factors.size()));
  expected.SetMatches(scene.matches);
  expected.Load(scene.map());
  batch.Inflate(std::vector<double>(factors.size(), 3.0));  // factors do not accumulate
  batch.Inflate(factors);
  ExpectNear(batch.Linearise(scene.camera, false), expected.Linearise(scene.camera, false));
}

TEST_P(EveryInstructionSet, LandmarksAreUpdatedAsOneByOne) {
  for (const int count : {1, 8, 13, 40}) {
    for (const int iterations : {1, 2, 10}) {
      SCOPED_TRACE(testing::Message() << count << " matches, " << iterations << " iterations");
      const Scene scene = MakeScene(static_cast<unsigned>(100 + count), count);
      vo::MatchBatch batch(GetParam());
      batch.SetMatches(scene.matches);
      batch.Load(scene.map());
      std::vector<vo::Landmark> landmarks = scene.landmarks, expected = scene.landmarks;
      const double log_likelihood = batch.UpdateLandmarks(scene.camera, iterations);
      batch.Store(landmarks);
      double sum = 0;
      for (const vo::Match& match : scene.matches) {
        const vo::AnchorView view = vo::AnchorView(scene.camera, scene.anchors[scene.anchor_of[match.landmark]])
                                        .ShiftedBy(match.centre_offset_W);
        const vo_test::LandmarkUpdate update = vo_test::UpdateLandmark(
            scene.landmarks[match.landmark], scene.landmarks[match.landmark].mean, view, match, iterations);
        expected[match.landmark] = update.landmark;
        sum += update.log_likelihood;
      }
      EXPECT_NEAR(log_likelihood, sum, 1e-11 * std::abs(sum));
      for (std::size_t n = 0; n < landmarks.size(); ++n) {
        EXPECT_LT((landmarks[n].mean - expected[n].mean).norm(), 1e-12 * expected[n].mean.norm()) << n;
        // The posterior covariance may be 1e-5 of the prior one.
        EXPECT_LT((landmarks[n].covariance - expected[n].covariance).norm(),
                  1e-13 * scene.landmarks[n].covariance.norm())
            << n;
      }
    }
  }
}

TEST_P(EveryInstructionSet, PredictionsAreMomentsOverParticles) {
  const Scene scene = MakeScene(5, 11);
  vo::Matrix6 root;
  for (int k = 0; k < 36; ++k) root(k / 6, k % 6) = 0.01 * std::sin(1.7 * (k + 1));
  const vo::Matrix6 P = root * root.transpose();
  std::vector<int> wanted;
  for (int n = 0; n < 21; ++n) wanted.push_back(n);
  vo::MatchBatch batch(GetParam());
  batch.SetLandmarks(wanted);
  std::vector<vo::ImageMoments> expected(wanted.size());
  for (const double weight : {0.3, 0.7}) {
    vo::Pose camera = scene.camera;
    camera.p_WC.x() += weight;
    batch.Load(scene.map());
    batch.AddPredictions(camera, P, weight);
    for (const int n : wanted) {
      const vo::Projection h = vo::Project({camera, scene.anchors[scene.anchor_of[n]]}, scene.landmarks[n].mean);
      if (!h.in_front) continue;
      expected[n].weight += weight;
      expected[n].z += weight * h.z;
      expected[n].second += weight * (h.z * h.z.transpose() + h.J_pose * P * h.J_pose.transpose() +
                                      h.J_landmark * scene.landmarks[n].covariance * h.J_landmark.transpose());
    }
  }
  int behind = 0;
  for (const int n : wanted) {
    const vo::ImagePrediction a = batch.Moments(n).Prediction(), b = expected[n].Prediction();
    EXPECT_EQ(a.in_front, b.in_front);
    behind += !a.in_front;
    EXPECT_LT((a.z - b.z).norm(), 1e-12) << n;
    EXPECT_LE((a.covariance - b.covariance).norm(), 1e-12 * b.covariance.norm()) << n;
  }
  EXPECT_GT(behind, 0);
}

// Product of ten thousand determinants of 1e-11, which is outside the range of double.
TEST_P(EveryInstructionSet, LogDeterminantOfManyMatches) {
  Scene scene = MakeScene(2, 10);
  vo::MatchBatch batch(GetParam());
  batch.SetMatches(scene.matches);
  batch.Load(scene.map());
  const double ten = batch.Linearise(scene.camera, false).log_det;
  std::vector<vo::Match> many;
  for (int k = 0; k < 1000; ++k) many.insert(many.end(), scene.matches.begin(), scene.matches.end());
  batch.SetMatches(many);
  batch.Load(scene.map());
  EXPECT_NEAR(batch.Linearise(scene.camera, false).log_det, 1000 * ten, 1e-11 * std::abs(1000 * ten));
}

TEST_P(EveryInstructionSet, NoMatches) {
  vo::MatchBatch batch(GetParam());
  batch.SetMatches({});
  batch.Load({});
  const vo::MatchBatch::Information none = batch.Linearise({}, false);
  EXPECT_EQ(none.A, vo::Matrix6::Zero());
  EXPECT_EQ(none.log_det, 0);
  EXPECT_EQ(batch.UpdateLandmarks({}, 10), 0);
}

// Bits of all outputs.
std::vector<std::uint64_t> Everything(vo::InstructionSet set, const Scene& scene, bool marginal) {
  std::vector<std::uint64_t> out;
  const auto add = [&](double x) { out.push_back(std::bit_cast<std::uint64_t>(x)); };
  vo::MatchBatch batch(set);
  batch.SetMatches(scene.matches);
  batch.Load(scene.map());
  vo::Pose camera = scene.camera;
  for (int k = 0; k < 3; ++k) {
    const vo::MatchBatch::Information sum = batch.Linearise(camera, marginal);
    for (int i = 0; i < 36; ++i) add(sum.A(i / 6, i % 6));
    for (int i = 0; i < 6; ++i) add(sum.b[i]);
    add(sum.cost);
    add(sum.log_det);
    const vo::Vector6 d = (k + 1) * (vo::Vector6() << 0.01, -0.02, 0.015, 0.004, -0.003, 0.002).finished();
    batch.Follow(d);
    camera = vo::Plus(camera, d);
  }
  add(batch.UpdateLandmarks(camera, 10));
  std::vector<vo::Landmark> landmarks = scene.landmarks;
  batch.Store(landmarks);
  std::vector<int> all;
  for (const vo::Landmark& landmark : landmarks) {
    all.push_back(static_cast<int>(all.size()));
    for (int i = 0; i < 3; ++i) add(landmark.mean[i]);
    for (int i = 0; i < 9; ++i) add(landmark.covariance(i / 3, i % 3));
  }
  batch.SetLandmarks(all);
  batch.Load(scene.map());
  batch.AddPredictions(camera, 1e-4 * vo::Matrix6::Identity() + 1e-6 * vo::Matrix6::Ones(), 0.4);
  for (const int n : all) {
    const vo::ImageMoments moments = batch.Moments(n);
    for (const double x : {moments.weight, moments.z.x(), moments.z.y(), moments.second(0, 0), moments.second(0, 1),
                           moments.second(1, 1)})
      add(x);
  }
  return out;
}

TEST(MatchBatch, InstructionSetsGiveTheSameBits) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Scene scene = MakeScene(seed, static_cast<int>(seed * 3), seed % 2 == 0);
    for (const bool marginal : {false, true}) {
      const auto base = Everything(vo::InstructionSet::base, scene, marginal);
      for (const vo::InstructionSet set : vo::AvailableInstructionSets())
        EXPECT_EQ(Everything(set, scene, marginal), base) << vo::Name(set) << ", seed " << seed;
    }
  }
}

}  // namespace
