#include "vo/filter/ekf_slam.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "vo/base/instruction_set.h"
#include "vo/filter/motion_model.h"
#include "vo/geometry/covariance.h"
#include "vo/geometry/so3.h"

namespace vo {
namespace {

constexpr double kConverged = 1e-6;  // squared step: a thousandth of a standard deviation
constexpr int kMaxHalvings = 8;

// T P T', T = identity but for the rotation at `offset`.
void Turn(Eigen::MatrixXd& P, int offset, const Eigen::Matrix3d& J) {
  P.middleRows<3>(offset) = (J * P.middleRows<3>(offset)).eval();
  P.middleCols<3>(offset) = (P.middleCols<3>(offset) * J.transpose()).eval();
}

}  // namespace

EkfSlam::EkfSlam(const MotionParams& motion, const FilterParams& filter, const LandmarkParams& landmark,
                 const FilterPrior& prior)
    : motion_(motion), landmark_params_(landmark), joint_iterations_(filter.joint_iterations) {
  FixBlocksOfProducts();
  state_.pose = prior.pose.mean;
  state_.velocity = prior.velocity;
  P_.setZero(kCameraSize, kCameraSize);
  P_.topLeftCorner<6, 6>() = prior.pose.covariance;
  P_.bottomRightCorner<6, 6>() = prior.velocity_covariance;
  since_known_ = P_;
  reference_ = {state_.pose, prior.pose.covariance};
  Answer();
  answer_.mixture.clear();
}

void EkfSlam::Predict(double dt, const MotionInput& input) {
  before_ = {dt, state_.pose, P_.topRows<kCameraSize>(), P_.leftCols<kCameraSize>(), since_known_};
  PredictAgain(input);
}

void EkfSlam::PredictAgain(const MotionInput& input) {
  answer_.events = {};
  const MotionModel model = NearlyConstantVelocity(motion_, before_.dt, input);
  const Vector6 u = model.F.topRightCorner<6, 6>() * state_.velocity;
  state_.pose = {before_.pose.p_WC + u.head<3>(), (before_.pose.q_WC * Exp(u.tail<3>())).normalized()};
  // q Exp(phi) Exp(u + du) = q Exp(u) Exp(Exp(u)' phi + J_r(u) du).
  Matrix12 G = Matrix12::Identity();  // of (p, delta, v, w)
  G.block<3, 3>(3, 3) = RightJacobian(u.tail<3>());
  Matrix12 F = G * model.F;
  F.block<3, 3>(3, 3) = Exp(u.tail<3>()).toRotationMatrix().transpose();
  const Matrix12 noise = G * model.Q * G.transpose();
  since_known_ = F * before_.since_known * F.transpose() + noise;
  reference_ = {state_.pose, since_known_.topLeftCorner<6, 6>()};
  P_.leftCols<kCameraSize>() = before_.camera_columns;
  P_.topRows<kCameraSize>() = F * before_.camera_rows;
  P_.leftCols<kCameraSize>() = (P_.leftCols<kCameraSize>() * F.transpose()).eval();
  P_.topLeftCorner<kCameraSize, kCameraSize>() += noise;
}

// The joint mode, and its last linearisation.
struct EkfSlam::Mode {
  Eigen::VectorXd d;           // from the prior
  Eigen::MatrixXd HP, PHt, S;  // empty: every landmark lies behind the camera
  Eigen::LLT<Eigen::MatrixXd> S_root;
  bool converged = false;
};

// The mode of |z - h|^2_R + |d|^2_P. d = P x throughout, so that d' P^-1 d = x' d though P may be singular.
EkfSlam::Mode EkfSlam::FindMode(std::span<const Match> matches) const {
  Mode mode;
  Eigen::VectorXd& d = mode.d;
  d = Eigen::VectorXd::Zero(P_.rows());
  Eigen::VectorXd x = d;
  JointMeasurement measurement(matches, state_, d);
  double cost = measurement.cost();
  mode.converged = joint_iterations_ == 1;  // one step is the EKF's
  for (int iteration = 0; iteration < joint_iterations_ && measurement.size() > 0; ++iteration) {
    mode.HP = measurement.Times(P_);
    mode.PHt = mode.HP.transpose();
    mode.S = measurement.Times(mode.PHt);
    measurement.AddNoise(mode.S);
    Eigen::VectorXd innovation = measurement.Times(d);
    measurement.AddResidual(innovation);
    mode.S_root.compute(mode.S);
    const Eigen::VectorXd y = mode.S_root.solve(innovation);
    Eigen::VectorXd step_x = -x;  // H' y - x
    measurement.AddTransposeTimes(y, step_x);
    Eigen::VectorXd step_d = mode.PHt * y - d;
    mode.converged = mode.converged || step_x.dot(step_d) < kConverged;
    if (mode.converged) {
      d += step_d;
      break;
    }
    // A step that raises the cost, or brings a landmark behind the camera, is halved.
    const std::size_t in_front = measurement.size();
    bool better = false;
    for (int halving = 0; halving < kMaxHalvings && !better; ++halving) {
      measurement = JointMeasurement(matches, state_.Displaced(d + step_d), d + step_d);
      const double next = measurement.cost() + (x + step_x).dot(d + step_d);
      better = measurement.size() >= in_front && next <= cost;
      if (better) {
        cost = next;
        d += step_d;
        x += step_x;
      } else {
        step_d *= 0.5;
        step_x *= 0.5;
      }
    }
    if (!better) break;
  }
  return mode;
}

const FilterAnswer& EkfSlam::Update(std::span<const Match> matches) {
  if (!matches.empty()) {
    const Mode mode = FindMode(matches);
    state_ = state_.Displaced(mode.d);
    answer_.events.behind_camera = static_cast<int>(matches.size()) - static_cast<int>(mode.HP.rows() / 2);
    if (mode.HP.size() > 0) {
      answer_.events.not_converged = !mode.converged;
      answer_.events.not_positive_definite = mode.S_root.info() != Eigen::Success;
      // Joseph: (I - K H) P (I - K H)' + K R K' = P - K T' - T K' with T = P H' - K S / 2.
      const Eigen::MatrixXd K = mode.S_root.solve(mode.HP).transpose();
      const Eigen::MatrixXd T = mode.PHt - 0.5 * K * mode.S;
      P_.triangularView<Eigen::Lower>() -= K * T.transpose();
      P_.triangularView<Eigen::Lower>() -= T * K.transpose();
      Symmetrise(P_);
      Turn(P_, 3, RightJacobian(mode.d.segment<3>(3)));  // to the tangent space at the new mean
      for (const int offset : state_.anchor_offset) Turn(P_, offset + 3, RightJacobian(mode.d.segment<3>(offset + 3)));
      Symmetrise(P_);
      for (std::size_t n = 0; n < state_.landmarks.size(); ++n)
        state_.landmarks[n].covariance = P_.block<3, 3>(state_.landmark_offset[n], state_.landmark_offset[n]);
      since_known_.setZero();
      since_known_.bottomRightCorner<6, 6>() = P_.block<6, 6>(6, 6);
    }
  }
  Answer();
  return answer_;
}

void EkfSlam::AddLandmarks(std::span<const FirstView> views) {
  if (views.empty()) return;
  std::vector<Landmark> added;
  for (const FirstView& view : views) added.push_back(NewLandmark(view, landmark_params_));
  const int before = static_cast<int>(P_.rows()), after = before + 6 + 3 * static_cast<int>(views.size());
  const Eigen::MatrixXd old = P_;
  P_.setZero(after, after);
  P_.topLeftCorner(before, before) = old;
  P_.block(before, 0, 6, before) = old.topRows<6>();  // the anchor is the present pose
  P_.block(0, before, before, 6) = old.leftCols<6>();
  P_.block<6, 6>(before, before) = old.topLeftCorner<6, 6>();
  state_.Add(added, before);
  for (std::size_t n = state_.landmarks.size() - added.size(); n < state_.landmarks.size(); ++n)
    P_.block<3, 3>(state_.landmark_offset[n], state_.landmark_offset[n]) = state_.landmarks[n].covariance;
}

void EkfSlam::KeepLandmarks(const std::vector<bool>& keep) {
  if (std::find(keep.begin(), keep.end(), false) == keep.end()) return;
  const std::vector<int> entries = state_.Keep(keep);
  P_ = Eigen::MatrixXd(P_(entries, entries));
}

std::vector<ImagePrediction> EkfSlam::PredictImages(std::span<const int> landmarks) const {
  std::vector<ImagePrediction> predictions(landmarks.size());
  for (std::size_t k = 0; k < landmarks.size(); ++k) {
    const int n = landmarks[k];
    const Landmark& l = state_.landmarks[n];
    const Projection h = Project({state_.pose, state_.anchors[state_.anchor_of[n]]}, l.mean);
    if (!h.in_front) continue;
    Eigen::Matrix<double, 2, 15> H;
    H << h.J_pose, AnchorJacobian(h, l.mean), h.J_landmark;
    const int at[] = {0, state_.AnchorOffsetOf(n), OffsetOf(n)}, local[] = {0, 6, 12}, size[] = {6, 6, 3};
    Eigen::Matrix<double, 15, 15> P;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        P.block(local[i], local[j], size[i], size[j]) = P_.block(at[i], at[j], size[i], size[j]);
    predictions[k] = {true, h.z, H * P * H.transpose()};
  }
  return predictions;
}

std::vector<Filter::LandmarkBelief> EkfSlam::LandmarkBeliefs() const {
  std::vector<LandmarkBelief> beliefs;
  for (int n = 0; n < landmark_count(); ++n) {
    const Landmark& l = state_.landmarks[n];
    beliefs.push_back(
        {PointInWorld(state_.anchors[state_.anchor_of[n]], l.mean), l.mean.z(), std::sqrt(l.covariance(2, 2))});
  }
  return beliefs;
}

std::vector<Filter::LandmarkSpread> EkfSlam::LandmarkSpreads() const {
  std::vector<LandmarkSpread> spreads;
  for (int n = 0; n < landmark_count(); ++n) {
    const Pose& anchor = state_.anchors[state_.anchor_of[n]];
    const Eigen::Vector3d& theta = state_.landmarks[n].mean;
    spreads.push_back({std::sqrt(state_.landmarks[n].covariance(2, 2)), std::nullopt});
    if (!(theta.z() > 0)) continue;
    const int a = state_.AnchorOffsetOf(n), l = OffsetOf(n);
    Eigen::Matrix<double, 3, 9> J;
    J << PointAnchorJacobian(anchor, theta), PointJacobian(anchor, theta);
    Eigen::Matrix<double, 9, 9> P;
    P << P_.block<6, 6>(a, a), P_.block<6, 3>(a, l), P_.block<3, 6>(l, a), P_.block<3, 3>(l, l);
    spreads.back().place = PointMoments{PointInWorld(anchor, theta), J * P * J.transpose()};
  }
  return spreads;
}

void EkfSlam::Answer() {
  answer_.belief = {state_.pose, state_.velocity, P_.topLeftCorner<kCameraSize, kCameraSize>()};
  answer_.mixture = {{1.0, state_.pose, state_.velocity, answer_.belief.covariance}};
}

}  // namespace vo
