#include "vo/filter/checked_filter.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace vo {
namespace {

constexpr double kUnit = 1e-6;  // tolerance of the weights' sum, and of a quaternion's length
constexpr double kRounding = 1e-9;

bool Finite(const Pose& pose) {
  return pose.p_WC.allFinite() && std::abs(pose.q_WC.coeffs().norm() - 1) < kUnit;  // false for NaN
}

bool Symmetric(const Eigen::Ref<const Eigen::MatrixXd>& P) {
  return (P - P.transpose()).cwiseAbs().maxCoeff() <= kRounding * P.diagonal().cwiseAbs().maxCoeff();
}

#if !defined(NDEBUG)
// Independent of units: as correlations, of the entries with variance. Smaller variances are products of denormal
// numbers, which have few digits. Too expensive for every stage.
bool NoNegativeEigenvalue(const Matrix12& P) {
  constexpr double kLeastVariance = 1e-280;
  const Eigen::Array<double, 12, 1> scale =
      (P.diagonal().array() > kLeastVariance).select(P.diagonal().array().rsqrt(), 0);
  const Matrix12 correlation = scale.matrix().asDiagonal() * P * scale.matrix().asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Matrix12>(correlation, Eigen::EigenvaluesOnly).eigenvalues().minCoeff() >
         -kRounding;
}
#endif

bool PositiveDefinite(const Eigen::Matrix2d& R) { return R.allFinite() && R(0, 0) > 0 && R.determinant() > 0; }

}  // namespace

// Entries are finite and symmetric, and no variance is negative; `above_zero`: nor zero.
void CheckedFilter::RequireVariances(const Eigen::Ref<const Eigen::MatrixXd>& covariance, const char* stage,
                                     const char* whose, bool above_zero) const {
  if (!covariance.allFinite())
    throw FilterFault(frame_, stage, std::string("the covariance of ") + whose + " is not a number");
  const double least = covariance.diagonal().minCoeff();
  if (above_zero ? !(least > 0) : !(least >= 0))
    throw FilterFault(frame_, stage,
                      std::string("the covariance of ") + whose + " has a variance of " + std::to_string(least));
  if (!Symmetric(covariance))
    throw FilterFault(frame_, stage, std::string("the covariance of ") + whose + " is not symmetric");
}

void CheckedFilter::RequireAnswer(const char* stage) const {
  const FilterAnswer& answer = filter_->answer();
  const Belief& belief = answer.belief;
  Require(Finite(belief.pose), stage, "the pose is not one");
  Require(belief.velocity.allFinite(), stage, "the velocity is not a number");
  RequireVariances(belief.covariance, stage, "pose and velocity", false);
#if !defined(NDEBUG)
  Require(NoNegativeEigenvalue(belief.covariance), stage,
          "the covariance of pose and velocity has a negative eigenvalue");
#endif
  for (const StartPose& pose : answer.start) Require(Finite(pose.pose), stage, "a pose of the start is not one");
  double sum = 0;
  for (const BeliefComponent& component : answer.mixture) {
    Require(component.weight >= 0, stage, "a weight is negative or not a number");
    sum += component.weight;
  }
  Require(std::abs(sum - 1) < kUnit, stage, "the weights do not sum to 1");
  Require(answer.effective_particles > 0 && std::isfinite(answer.effective_particles), stage,
          "the effective number of particles is not one");
}

void CheckedFilter::Predict(double dt, const MotionInput& input) {
  ++frame_;
  Require(dt > 0 && std::isfinite(dt), "prediction", "the time since the last frame is not positive");
  filter_->Predict(dt, input);
  RequirePrediction();
}

void CheckedFilter::PredictAgain(const MotionInput& input) {
  filter_->PredictAgain(input);
  RequirePrediction();
}

void CheckedFilter::RequirePrediction() const {
  const PoseGaussian prediction = filter_->Reference().prediction;
  Require(Finite(prediction.mean), "prediction", "the pose is not one");
  RequireVariances(prediction.covariance, "prediction", "the pose",
                   true);  // the motion is uncertain
}

const FilterAnswer& CheckedFilter::Update(std::span<const Match> matches) {
  const int count = landmark_count();
  for (const Match& match : matches) {
    Require(match.landmark >= 0 && match.landmark < count, "update", "a match is of a landmark that is not in the map");
    Require(match.z.allFinite() && match.centre_offset_W.allFinite(), "update", "a match is at no point of the image");
    Require(PositiveDefinite(match.R), "update", "the noise of a match is not positive definite");
  }
  const FilterAnswer& answer = filter_->Update(matches);
  RequireAnswer("update");
  return answer;
}

void CheckedFilter::AddLandmarks(std::span<const FirstView> views) {
  for (const FirstView& view : views) {
    Require(view.ray.allFinite() && view.d_ray_d_rho.allFinite(), "new landmarks",
            "a first view is at no point of the image");
    Require(PositiveDefinite(view.R), "new landmarks", "the noise of a first view is not positive definite");
    Require(!view.depth || (view.depth->inverse_depth > 0 && view.depth->sigma > 0 &&
                            std::isfinite(view.depth->inverse_depth) && std::isfinite(view.depth->sigma)),
            "new landmarks", "a known depth is not positive");
  }
  const int before = landmark_count();
  filter_->AddLandmarks(views);
  Require(landmark_count() == before + static_cast<int>(views.size()), "new landmarks",
          "the map has another number of landmarks");
}

void CheckedFilter::KeepLandmarks(const std::vector<bool>& keep) {
  Require(static_cast<int>(keep.size()) == landmark_count(), "forgetting",
          "the number of landmarks given is not that of the map");
  filter_->KeepLandmarks(keep);
  Require(landmark_count() == std::count(keep.begin(), keep.end(), true), "forgetting",
          "the map has another number of landmarks");
}

std::vector<ImagePrediction> CheckedFilter::PredictImages(std::span<const int> landmarks) const {
  std::vector<ImagePrediction> predictions = filter_->PredictImages(landmarks);
  for (const ImagePrediction& prediction : predictions) {
    if (!prediction.in_front) continue;
    Require(prediction.z.allFinite(), "predicted images", "a landmark is at no point of the image");
    RequireVariances(prediction.covariance, "predicted images", "a landmark's image", false);
  }
  return predictions;
}

std::vector<Filter::LandmarkBelief> CheckedFilter::LandmarkBeliefs() const {
  std::vector<LandmarkBelief> beliefs = filter_->LandmarkBeliefs();
  for (const LandmarkBelief& belief : beliefs) {
    Require(belief.X_W.allFinite() && std::isfinite(belief.inverse_depth), "landmarks", "a landmark is nowhere");
    RequireSigma(belief.inverse_depth_sigma);
  }
  return beliefs;
}

std::vector<Filter::LandmarkSpread> CheckedFilter::LandmarkSpreads() const {
  std::vector<LandmarkSpread> spreads = filter_->LandmarkSpreads();
  for (const LandmarkSpread& spread : spreads) {
    RequireSigma(spread.inverse_depth_sigma);
    if (!spread.place) continue;
    Require(spread.place->mean.allFinite(), "landmarks", "a landmark is nowhere");
    RequireVariances(spread.place->covariance, "landmarks", "a landmark", false);
  }
  return spreads;
}

}  // namespace vo
