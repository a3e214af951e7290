#include "vo/filter/ekf_slam.h"

#include <algorithm>
#include <cmath>

#include "vo/filter/motion_model.h"
#include "vo/geometry/so3.h"
#include "vo/geometry/symmetric.h"

namespace vo {
namespace {

constexpr int kCamera = 12;        // pose and velocity
constexpr double kSettled = 1e-6;  // squared step: a thousandth of a standard deviation
constexpr int kMaxHalvings = 8;

// T P T', T = identity but for the rotation at `offset`.
void Turn(Eigen::MatrixXd& P, int offset, const Eigen::Matrix3d& J) {
  P.middleRows<3>(offset) = (J * P.middleRows<3>(offset)).eval();
  P.middleCols<3>(offset) = (P.middleCols<3>(offset) * J.transpose()).eval();
}

}  // namespace

EkfSlam::EkfSlam(const MotionParams& motion, const FilterParams& filter, const LandmarkParams& landmark,
                 const FilterPrior& prior)
    : motion_(motion), params_(filter), landmark_params_(landmark), pose_(prior.pose.mean), velocity_(prior.velocity) {
  P_.setZero(kCamera, kCamera);
  P_.topLeftCorner<6, 6>() = prior.pose.covariance;
  P_.bottomRightCorner<6, 6>() = prior.velocity_covariance;
  since_known_ = P_;
  reference_ = {pose_, prior.pose.covariance};
  Answer();
  mixture_.clear();
}

void EkfSlam::Predict(double dt) {
  guards_ = {};
  const MotionModel model = NearlyConstantVelocity(motion_, dt);
  const Vector6 u = model.F.topRightCorner<6, 6>() * velocity_;
  pose_.p_WC += u.head<3>();
  pose_.q_WC = (pose_.q_WC * Exp(u.tail<3>())).normalized();
  // q Exp(phi) Exp(u + du) = q Exp(u) Exp(Exp(u)' phi + J_r(u) du).
  const Eigen::Matrix3d J_r = RightJacobian(u.tail<3>());
  Matrix12 G = Matrix12::Identity();  // of (p, delta, v, w)
  G.block<3, 3>(3, 3) = J_r;
  Matrix12 F = G * model.F;
  F.block<3, 3>(3, 3) = Exp(u.tail<3>()).toRotationMatrix().transpose();
  const Matrix12 noise = G * model.Q * G.transpose();

  since_known_ = F * since_known_ * F.transpose() + noise;
  reference_ = {pose_, since_known_.topLeftCorner<6, 6>()};
  P_.topRows<kCamera>() = (F * P_.topRows<kCamera>()).eval();
  P_.leftCols<kCamera>() = (P_.leftCols<kCamera>() * F.transpose()).eval();
  P_.topLeftCorner<kCamera, kCamera>() += noise;
}

void EkfSlam::MoveTo(const Eigen::VectorXd& d) {
  pose_ = Plus(pose_before_, d.head<6>());
  velocity_ = velocity_before_ + d.segment<6>(6);
  for (std::size_t a = 0; a < anchors_.size(); ++a)
    anchors_[a] = Plus(anchors_before_[a], d.segment<6>(anchor_offset_[a]));
  for (std::size_t n = 0; n < landmarks_.size(); ++n)
    landmarks_[n].mean = means_before_[n] + d.segment<3>(landmark_offset_[n]);
}

// Rows at the present estimate, as derivatives by d, the offset from the prior. Returns the sum of r' R^-1 r.
double EkfSlam::Linearise(std::span<const Match> matches, const Eigen::VectorXd& d) {
  const std::vector<AnchorView> views = ViewsOf(anchors_, pose_);
  const Eigen::Matrix3d J_r = RightJacobian(d.segment<3>(3));
  std::vector<Eigen::Matrix3d> J_r_anchor;
  for (const int offset : anchor_offset_) J_r_anchor.push_back(RightJacobian(d.segment<3>(offset + 3)));
  rows_.clear();
  double cost = 0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Match& match = matches[i];
    const int anchor = anchor_of_[match.landmark];
    const Projection h = Project(views[anchor].From(match.moved), landmarks_[match.landmark].mean);
    if (!h.in_front) continue;
    Row row;
    row.match = static_cast<int>(i);
    row.anchor_offset = anchor_offset_[anchor];
    row.landmark_offset = landmark_offset_[match.landmark];
    row.residual = match.z - h.z;
    row.H_pose = h.J_pose;
    row.H_pose.rightCols<3>() *= J_r;
    row.H_anchor = AnchorJacobian(h, landmarks_[match.landmark].mean);
    row.H_anchor.rightCols<3>() *= J_r_anchor[anchor];
    row.H_landmark = h.J_landmark;
    cost += row.residual.dot(match.R.inverse() * row.residual);
    rows_.push_back(row);
  }
  return cost;
}

template <class Matrix>
Eigen::MatrixXd EkfSlam::RowsTimes(const Matrix& M) const {
  Eigen::MatrixXd result(2 * rows_.size(), M.cols());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    result.middleRows<2>(2 * i).noalias() = row.H_pose * M.template topRows<6>() +
                                            row.H_anchor * M.template middleRows<6>(row.anchor_offset) +
                                            row.H_landmark * M.template middleRows<3>(row.landmark_offset);
  }
  return result;
}

void EkfSlam::Update(std::span<const Match> matches) {
  if (matches.empty()) return Answer();
  pose_before_ = pose_;
  velocity_before_ = velocity_;
  anchors_before_ = anchors_;
  means_before_.clear();
  for (const Landmark& landmark : landmarks_) means_before_.push_back(landmark.mean);

  // The mode of |z - h|^2_R + |d|^2_P. d = P x throughout, so that d' P^-1 d = x' d though P may be singular.
  Eigen::VectorXd d = Eigen::VectorXd::Zero(P_.rows()), x = d;
  Eigen::MatrixXd HP, PHt, S;
  Eigen::LLT<Eigen::MatrixXd> S_root;
  double cost = Linearise(matches, d);
  bool settled = params_.joint_iterations == 1;  // nobody asked for more
  for (int iteration = 0; iteration < params_.joint_iterations && !rows_.empty(); ++iteration) {
    HP = RowsTimes(P_);
    PHt = HP.transpose();
    S = RowsTimes(PHt);
    Eigen::VectorXd innovation = RowsTimes(d);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      S.block<2, 2>(2 * i, 2 * i) += matches[rows_[i].match].R;
      innovation.segment<2>(2 * i) += rows_[i].residual;
    }
    S_root.compute(S);
    const Eigen::VectorXd y = S_root.solve(innovation);
    Eigen::VectorXd step_x = -x;  // H' y - x
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Row& row = rows_[i];
      step_x.head<6>() += row.H_pose.transpose() * y.segment<2>(2 * i);
      step_x.segment<6>(row.anchor_offset) += row.H_anchor.transpose() * y.segment<2>(2 * i);
      step_x.segment<3>(row.landmark_offset) += row.H_landmark.transpose() * y.segment<2>(2 * i);
    }
    Eigen::VectorXd step_d = PHt * y - d;
    settled = settled || step_x.dot(step_d) < kSettled;
    if (settled) {
      d += step_d;
      break;
    }
    // A step that makes it worse, or brings a landmark behind the camera, was too long: half of it.
    const std::size_t in_front = rows_.size();
    bool better = false;
    for (int halving = 0; halving < kMaxHalvings && !better; ++halving) {
      MoveTo(d + step_d);
      const double next = Linearise(matches, d + step_d) + (x + step_x).dot(d + step_d);
      better = rows_.size() >= in_front && next <= cost;
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
  MoveTo(d);
  guards_.behind = static_cast<int>(matches.size()) - static_cast<int>(HP.rows() / 2);
  if (HP.size() > 0) {
    guards_.unsettled = !settled;
    guards_.indefinite = S_root.info() != Eigen::Success;
    // Joseph: (I - K H) P (I - K H)' + K R K' = P - K T' - T K' with T = P H' - K S / 2.
    const Eigen::MatrixXd K = S_root.solve(HP).transpose();
    const Eigen::MatrixXd T = PHt - 0.5 * K * S;
    P_.triangularView<Eigen::Lower>() -= K * T.transpose();
    P_.triangularView<Eigen::Lower>() -= T * K.transpose();
    Symmetrise(P_);
    Turn(P_, 3, RightJacobian(d.segment<3>(3)));  // to the tangent space at the new mean
    for (const int offset : anchor_offset_) Turn(P_, offset + 3, RightJacobian(d.segment<3>(offset + 3)));
    Symmetrise(P_);
    for (std::size_t n = 0; n < landmarks_.size(); ++n)
      landmarks_[n].covariance = P_.block<3, 3>(landmark_offset_[n], landmark_offset_[n]);
    since_known_.setZero();
    since_known_.bottomRightCorner<6, 6>() = P_.block<6, 6>(6, 6);
  }
  Answer();
}

void EkfSlam::AddLandmarks(std::span<const FirstView> views) {
  if (views.empty()) return;
  const int before = static_cast<int>(P_.rows()), after = before + 6 + 3 * static_cast<int>(views.size());
  const Eigen::MatrixXd old = P_;
  P_.setZero(after, after);
  P_.topLeftCorner(before, before) = old;
  P_.block(before, 0, 6, before) = old.topRows<6>();  // the anchor is the present pose
  P_.block(0, before, before, 6) = old.leftCols<6>();
  P_.block<6, 6>(before, before) = old.topLeftCorner<6, 6>();
  anchors_.push_back(pose_);
  anchor_offset_.push_back(before);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Landmark landmark = NewLandmark(views[i], landmark_params_);
    const int offset = before + 6 + 3 * static_cast<int>(i);
    P_.block<3, 3>(offset, offset) = landmark.covariance;
    landmarks_.push_back(landmark);
    landmark_offset_.push_back(offset);
    anchor_of_.push_back(static_cast<int>(anchors_.size()) - 1);
  }
}

void EkfSlam::KeepLandmarks(const std::vector<bool>& keep) {
  if (std::find(keep.begin(), keep.end(), false) == keep.end()) return;
  std::vector<bool> used(anchors_.size(), false);
  for (std::size_t n = 0; n < keep.size(); ++n)
    if (keep[n]) used[anchor_of_[n]] = true;

  // The state in its order: camera, then each anchor followed by its landmarks.
  std::vector<int> index(kCamera);
  for (int i = 0; i < kCamera; ++i) index[i] = i;
  const auto take = [&](int& offset, int size) {
    const int to = static_cast<int>(index.size());
    for (int i = 0; i < size; ++i) index.push_back(offset + i);
    offset = to;
  };
  std::size_t to = 0, n = 0, kept = 0;
  for (std::size_t a = 0; a < anchors_.size(); ++a) {
    const std::size_t slot = to;
    if (used[a]) {
      anchors_[to] = anchors_[a];
      anchor_offset_[to] = anchor_offset_[a];
      take(anchor_offset_[to++], 6);
    }
    for (; n < keep.size() && anchor_of_[n] == static_cast<int>(a); ++n) {
      if (!keep[n]) continue;
      landmarks_[kept] = landmarks_[n];
      landmark_offset_[kept] = landmark_offset_[n];
      anchor_of_[kept] = static_cast<int>(slot);
      take(landmark_offset_[kept++], 3);
    }
  }
  anchors_.resize(to);
  anchor_offset_.resize(to);
  landmarks_.resize(kept);
  landmark_offset_.resize(kept);
  anchor_of_.resize(kept);
  P_ = Eigen::MatrixXd(P_(index, index));
}

std::vector<ImagePrediction> EkfSlam::PredictImages(std::span<const int> landmarks) const {
  std::vector<ImagePrediction> predictions;
  for (const int n : landmarks) predictions.push_back(PredictImage(n));
  return predictions;
}

ImagePrediction EkfSlam::PredictImage(int landmark) const {
  const Landmark& l = landmarks_[landmark];
  const int anchor = anchor_of_[landmark];
  const Projection h = Project({pose_, anchors_[anchor]}, l.mean);
  if (!h.in_front) return {};
  Eigen::Matrix<double, 2, 15> H;
  H << h.J_pose, AnchorJacobian(h, l.mean), h.J_landmark;
  const int at[] = {0, anchor_offset_[anchor], landmark_offset_[landmark]}, local[] = {0, 6, 12}, size[] = {6, 6, 3};
  Eigen::Matrix<double, 15, 15> P;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      P.block(local[i], local[j], size[i], size[j]) = P_.block(at[i], at[j], size[i], size[j]);
  return {true, h.z, H * P * H.transpose()};
}

std::vector<Filter::LandmarkBelief> EkfSlam::LandmarkBeliefs() const {
  std::vector<LandmarkBelief> beliefs;
  for (int n = 0; n < landmark_count(); ++n) {
    const Landmark& l = landmarks_[n];
    beliefs.push_back({PointInWorld(AnchorOf(n), l.mean), l.mean.z(), std::sqrt(l.covariance(2, 2))});
  }
  return beliefs;
}

void EkfSlam::Answer() {
  belief_ = {pose_, velocity_, P_.topLeftCorner<kCamera, kCamera>()};
  mixture_ = {{1.0, pose_, velocity_, belief_.covariance}};
}

}  // namespace vo
