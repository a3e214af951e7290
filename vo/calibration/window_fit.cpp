#include "vo/calibration/window_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "vo/base/median.h"
#include "vo/calibration/frame_motion.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/map/landmark.h"

namespace vo {
namespace {

constexpr std::size_t kMinLandmarks = 20, kMaxLandmarks = 200;
constexpr std::size_t kMinViews = 4;
constexpr double kFloorPx = 0.1;          // standard deviation of any sighting
constexpr double kSystematicPx = 0.01;    // rms of an error pattern common to all frames that looks like either unknown
constexpr double kCauchySq = 5;           // squared residual of half weight, in squared scales
constexpr double kMedianOfChiSq = 1.386;  // two degrees of freedom
// Views beyond five standard deviations; a larger share is of wrong tracks, whose estimate may be far off and precise.
constexpr double kOutlierSq = 25, kMostOutliers = 0.1;
constexpr double kLeastScaleSq = 0.01;  // smaller residuals, in units of the stated covariance, are of no outlier
constexpr int kMaxRounds = 50;
constexpr double kSettledReadout = 5e-5, kSettledFocal = 3e-4;  // [s], [-]: last step
constexpr double kPriorReadout = 0.05, kPriorFocal = 0.1;       // standard deviations: against divergence only
constexpr double kFixed = 1e-9;                                 // standard deviation of a known readout

using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;
using Matrix62 = Eigen::Matrix<double, 6, 2>;
using Matrix63 = Eigen::Matrix<double, 6, 3>;

struct View {
  int frame;
  Vector2 pixel;
  Matrix2 W;   // inverse covariance
  double row;  // -1/2 ... 1/2
};

struct Point {
  Pose anchor;            // constant: only a place to count theta from
  Eigen::Vector3d theta;  // (x, y, rho) from there
  std::vector<View> views;
};

// Residual of one view and its derivatives by the pose at the row's time, (readout, log focal) and landmark.
struct Linear {
  bool in_front = false;  // the rest is valid only then
  Vector2 r;
  Matrix26 J_pose;
  Matrix2 J_shared;
  Matrix23 J_point;
  FrameMotion::Row row;
  double square = 0;  // r' W r
};

struct State {
  std::vector<Pose> poses;
  std::vector<Eigen::Vector3d> thetas;
  Vector2 shared;  // readout, log focal
};

// Normal equations of the landmark's views; H_poses from pose `first` on.
struct PointBlock {
  Eigen::Matrix3d H_inverse;
  Eigen::Vector3d b;
  int first;
  Eigen::Matrix<double, Eigen::Dynamic, 3> H_poses;
  Matrix23 H_shared;
};

}  // namespace

class WindowFitting::Bundle {
 public:
  Bundle(std::span<const TrackedFrame> frames, const Camera& camera, double readout_s, bool estimate_readout)
      : camera_(camera), motion_(RegularTimes(TimesOf(frames))) {
    state_.shared = {readout_s, 0};
    prior_mean_ = state_.shared;
    prior_ = {estimate_readout ? std::pow(kPriorReadout, -2) : std::pow(kFixed, -2), std::pow(kPriorFocal, -2)};
    std::map<int, Point> points;
    const double extent = Extent(frames);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      Pose pose = frames[k].pose;
      pose.p_WC /= extent;
      state_.poses.push_back(pose);
      for (const Sighting& sighting : frames[k].sightings) {
        const auto [at, fresh] = points.try_emplace(sighting.landmark);
        Point& point = at->second;
        if (fresh) point = {pose, Eigen::Vector3d::Zero(), {}};
        if (fresh) point.theta.head<2>() = camera.Undistort(sighting.pixel);
        point.views.push_back({static_cast<int>(k), sighting.pixel,
                               (sighting.R + kFloorPx * kFloorPx * Matrix2::Identity()).inverse(),
                               sighting.pixel.y() / (camera.height - 1) - 0.5});
      }
    }
    for (auto& [id, point] : points)
      if (point.views.size() >= kMinViews) points_.push_back(std::move(point));
    std::stable_sort(points_.begin(), points_.end(),
                     [](const Point& a, const Point& b) { return a.views.size() > b.views.size(); });
    if (points_.size() > kMaxLandmarks) points_.resize(kMaxLandmarks);
    for (const Point& point : points_) state_.thetas.push_back(point.theta);
    SetDisplacements();
    for (std::size_t n = 0; n < points_.size(); ++n) state_.thetas[n].z() = InverseDepth(n);
  }

  std::size_t points() const { return points_.size(); }
  const Vector2& shared() const { return state_.shared; }

  enum class Progress { going_on, converged, failed };
  // One round of Levenberg-Marquardt with re-weighting.
  Progress Round() {
    if (linear_.empty()) Linearise();
    const double before = Cost();
    BuildEquations(damping_);
    State kept = state_;
    std::vector<Linear> linear = linear_;
    const Vector2 moved = Step();
    Linearise();
    ++rounds_;
    if (Cost() < before) {
      damping_ = std::max(1e-6, 0.1 * damping_);
      scale_sq_ = ScaleSquare();
      if (std::abs(moved[0]) < kSettledReadout && std::abs(moved[1]) < kSettledFocal && rounds_ > 3)
        return OutlierShare() < kMostOutliers ? Progress::converged : Progress::failed;
    } else {
      damping_ *= 10;
      state_ = std::move(kept);
      linear_ = std::move(linear);
      SetDisplacements();
      if (damping_ > 1e3) return Progress::failed;
    }
    return rounds_ < kMaxRounds ? Progress::going_on : Progress::failed;
  }

  WindowFit Result() {
    BuildEquations(0);
    const int poses = size() - 2;
    const Eigen::MatrixXd G = S_.topLeftCorner(poses, poses).ldlt().solve(S_.topRightCorner(poses, 2));
    const Matrix2 V = Matrix2(S_.bottomRightCorner<2, 2>() - S_.bottomLeftCorner(2, poses) * G).inverse();
    Matrix2 meat = prior_.asDiagonal(), square = Matrix2::Zero();
    std::vector<Vector2> of_frame(state_.poses.size(), Vector2::Zero());
    int count = 0;
    for (std::size_t n = 0, i = 0; n < points_.size(); ++n) {
      const PointBlock& block = blocks_[n];
      const Eigen::Matrix<double, 3, 2> G_point =
          block.H_inverse * (block.H_shared.transpose() -
                             block.H_poses.transpose() * G.middleRows(6 * block.first, block.H_poses.rows()));
      Vector2 of_point = Vector2::Zero();
      for (const View& view : points_[n].views) {
        const Linear& l = linear_[i++];
        if (!l.in_front) continue;
        Matrix62 G_pose = Matrix62::Zero();
        for (int j = 0; j < FrameMotion::kPoses; ++j)
          G_pose += l.row.weight[j] * G.middleRows<6>(6 * (l.row.first + j));
        const Matrix2 A = l.J_shared - l.J_pose * G_pose - l.J_point * G_point;  // nuisances projected out
        const Vector2 score = A.transpose() * (Weight(l) * (view.W * l.r));
        of_point += score;
        of_frame[view.frame] += score;
        square += A.transpose() * A;
        ++count;
      }
      meat += of_point * of_point.transpose();
    }
    for (const Vector2& score : of_frame) meat += score * score.transpose();
    const double equations = 2.0 * count, unknowns = 3.0 * static_cast<double>(points_.size()) + size();
    const Matrix2 P = equations / std::max(1.0, equations - unknowns) * V * meat * V;
    const Vector2 px = (square.diagonal() / count).cwiseSqrt();
    const auto sigma = [&](int i) { return std::hypot(std::sqrt(P(i, i)), kSystematicPx / px[i]); };
    return {{state_.shared[0], prior_[0] < 1 / kFixed ? sigma(0) : 0}, {state_.shared[1], sigma(1)}, px[1]};
  }

 private:
  static std::vector<double> TimesOf(std::span<const TrackedFrame> frames) {
    std::vector<double> times;
    for (const TrackedFrame& frame : frames)
      times.push_back(static_cast<double>(frame.stamp_ns - frames.front().stamp_ns) * 1e-9);
    return times;
  }

  // Unit of length: the greatest distance from the first pose. Neither unknown has lengths.
  static double Extent(std::span<const TrackedFrame> frames) {
    double extent = 0;
    for (const TrackedFrame& frame : frames)
      extent = std::max(extent, (frame.pose.p_WC - frames.front().pose.p_WC).norm());
    return extent > 0 ? extent : 1;
  }

  int size() const { return 6 * static_cast<int>(state_.poses.size()) + 2; }
  double Weight(const Linear& l) const { return 1 / (scale_sq_ * (1 + l.square / (kCauchySq * scale_sq_))); }

  void SetDisplacements() {
    displacements_.clear();
    for (int k = 0; k < static_cast<int>(state_.poses.size()); ++k)
      displacements_.push_back(FrameMotion::Displacements(state_.poses, motion_.First(k), k));
  }

  Linear At(const Point& point, const Eigen::Vector3d& theta, const View& view) const {
    Linear l;
    l.row = motion_.At(view.frame, state_.shared[0] * view.row);
    const Vector6 moved = displacements_[view.frame] * l.row.weight, velocity = displacements_[view.frame] * l.row.rate;
    const Projection h = Project({Plus(state_.poses[view.frame], moved), point.anchor}, theta);
    l.in_front = h.in_front;
    if (!h.in_front) return l;
    const double zoom = std::exp(state_.shared[1]);
    const Vector2 centre(camera_.cx, camera_.cy), off = zoom * (camera_.Project({h.z.x(), h.z.y(), 1.0}) - centre);
    const Matrix2 lens = zoom * camera_.LensJacobian(h.z);
    l.r = view.pixel - centre - off;
    l.J_pose = lens * h.J_pose;
    l.J_point = lens * h.J_landmark;
    l.J_shared << l.J_pose * velocity * view.row, off;
    l.square = l.r.dot(view.W * l.r);
    return l;
  }

  void Linearise() {
    linear_.clear();
    for (std::size_t n = 0; n < points_.size(); ++n)
      for (const View& view : points_[n].views) linear_.push_back(At(points_[n], state_.thetas[n], view));
    if (scale_sq_ == 0) scale_sq_ = ScaleSquare();
  }

  // Linear least squares along the first ray, repeated.
  double InverseDepth(std::size_t n) const {
    constexpr double kFar = 1e-3;
    Eigen::Vector3d theta = state_.thetas[n];
    for (int round = 0; round < 3; ++round) {
      double b = 0, H = 0;
      for (const View& view : points_[n].views) {
        const Linear l = At(points_[n], theta, view);
        if (!l.in_front) continue;
        b += l.J_point.col(2).dot(view.W * l.r);
        H += l.J_point.col(2).dot(view.W * l.J_point.col(2));
      }
      if (H > 0) theta.z() += b / H;
    }
    return theta.z() > kFar ? theta.z() : kFar;
  }

  double ScaleSquare() const {  // of the residuals, robustly
    std::vector<double> squares;
    for (const Linear& l : linear_)
      if (l.in_front) squares.push_back(l.square);
    if (squares.empty()) return 1;
    return std::max(1e-12, UpperMedian(std::move(squares)) / kMedianOfChiSq);
  }

  double Cost() const {
    constexpr double kBehind = 1e3;  // in place of the square
    double cost = prior_.dot((state_.shared - prior_mean_).cwiseAbs2());
    for (const Linear& l : linear_)
      cost += kCauchySq * std::log1p((l.in_front ? l.square : kBehind) / (kCauchySq * scale_sq_));
    return cost;
  }

  double OutlierShare() const {
    const double limit = kOutlierSq * std::max(scale_sq_, kLeastScaleSq);
    const auto outlier = [&](const Linear& l) { return !l.in_front || l.square > limit; };
    return static_cast<double>(std::ranges::count_if(linear_, outlier)) / static_cast<double>(linear_.size());
  }

  // Normal equations of the poses, of which the first is fixed, and shared unknowns; landmarks eliminated.
  void BuildEquations(double damping) {
    constexpr double kNearlyNothing = 1e-9, kGauge = 1e12;
    const int n = size(), shared = n - 2;
    S_.setZero(n, n);
    g_.setZero(n);
    blocks_.clear();
    std::size_t i = 0;
    for (const Point& point : points_) {
      const int first = motion_.First(point.views.front().frame);
      const int poses = motion_.First(point.views.back().frame) + FrameMotion::kPoses - first;
      PointBlock block{{}, Eigen::Vector3d::Zero(), first, {}, Matrix23::Zero()};
      block.H_poses.setZero(6 * poses, 3);
      Eigen::Matrix3d H = kNearlyNothing * Eigen::Matrix3d::Identity();
      for (const View& view : point.views) {
        const Linear& l = linear_[i++];
        if (!l.in_front) continue;
        const Matrix2 W = Weight(l) * view.W;
        const Eigen::Matrix<double, 3, 2> of_point = l.J_point.transpose() * W;
        const Matrix62 of_pose = l.J_pose.transpose() * W;
        const Matrix2 of_shared = l.J_shared.transpose() * W;
        H += of_point * l.J_point;
        block.b += of_point * l.r;
        block.H_shared += of_shared * l.J_point;
        S_.bottomRightCorner<2, 2>() += of_shared * l.J_shared;
        g_.tail<2>() += of_shared * l.r;
        AddPoses(l, of_pose, block);
      }
      H.diagonal() *= 1 + damping;
      block.H_inverse = H.inverse();
      blocks_.push_back(std::move(block));
    }
    S_.diagonal() *= 1 + damping;
    for (const PointBlock& block : blocks_) {
      const auto rows = block.H_poses.rows();
      const Eigen::Matrix<double, Eigen::Dynamic, 3> gain = block.H_poses * block.H_inverse;
      S_.block(6 * block.first, 6 * block.first, rows, rows).triangularView<Eigen::Upper>() -=
          gain * block.H_poses.transpose();
      S_.block(6 * block.first, shared, rows, 2) -= gain * block.H_shared.transpose();
      S_.bottomRightCorner<2, 2>() -= block.H_shared * block.H_inverse * block.H_shared.transpose();
      g_.segment(6 * block.first, rows) -= gain * block.b;
      g_.tail<2>() -= block.H_shared * (block.H_inverse * block.b);
    }
    S_.diagonal().head<6>().array() += kGauge;
    S_.diagonal().segment(6, shared - 6).array() += kNearlyNothing;
    S_.diagonal().tail<2>() += prior_;
    g_.tail<2>() -= prior_.cwiseProduct(state_.shared - prior_mean_);
    S_ = Eigen::MatrixXd(S_.selfadjointView<Eigen::Upper>());
  }

  // The row's pose is a weighted sum of several.
  void AddPoses(const Linear& l, const Matrix62& of_pose, PointBlock& block) {
    const Matrix6 H = of_pose * l.J_pose;
    const Matrix63 H_point = of_pose * l.J_point;
    const Matrix62 H_shared = of_pose * l.J_shared;
    const Vector6 b = of_pose * l.r;
    for (int j = 0; j < FrameMotion::kPoses; ++j) {
      const double w = l.row.weight[j];
      const int at = 6 * (l.row.first + j);
      for (int m = j; m < FrameMotion::kPoses; ++m)
        S_.block<6, 6>(at, 6 * (l.row.first + m)) += w * l.row.weight[m] * H;
      S_.block<6, 2>(at, size() - 2) += w * H_shared;
      block.H_poses.middleRows<6>(at - 6 * block.first) += w * H_point;
      g_.segment<6>(at) += w * b;
    }
  }

  // Returns that of the shared unknowns.
  Vector2 Step() {
    const Eigen::VectorXd step = S_.ldlt().solve(g_);
    for (std::size_t n = 0; n < points_.size(); ++n) {
      const PointBlock& block = blocks_[n];
      state_.thetas[n] +=
          block.H_inverse * (block.b - block.H_shared.transpose() * step.tail<2>() -
                             block.H_poses.transpose() * step.segment(6 * block.first, block.H_poses.rows()));
    }
    for (std::size_t k = 0; k < state_.poses.size(); ++k)
      state_.poses[k] = Plus(state_.poses[k], step.segment<6>(6 * static_cast<int>(k)));
    state_.shared += step.tail<2>();
    SetDisplacements();
    return step.tail<2>();
  }

  const Camera camera_;
  FrameMotion motion_;
  Vector2 prior_mean_, prior_;  // of the shared unknowns; precision
  std::vector<Point> points_;
  State state_;
  std::vector<Eigen::Matrix<double, 6, FrameMotion::kPoses>> displacements_;
  std::vector<Linear> linear_;  // of all views, in order
  double scale_sq_ = 0, damping_ = 1e-3;
  int rounds_ = 0;
  Eigen::MatrixXd S_;
  Eigen::VectorXd g_;
  std::vector<PointBlock> blocks_;
};

WindowFitting::WindowFitting(std::span<const TrackedFrame> frames, const Camera& camera, double readout_s,
                             bool estimate_readout) {
  if (frames.size() < FrameMotion::kPoses) return;
  bundle_ = std::make_unique<Bundle>(frames, camera, readout_s, estimate_readout);
  if (bundle_->points() < kMinLandmarks) bundle_ = nullptr;
}

WindowFitting::WindowFitting(WindowFitting&&) noexcept = default;
WindowFitting& WindowFitting::operator=(WindowFitting&&) noexcept = default;
WindowFitting::~WindowFitting() = default;

bool WindowFitting::Round() {
  if (!bundle_) return false;
  const Bundle::Progress progress = bundle_->Round();
  if (progress == Bundle::Progress::going_on) return true;
  if (progress == Bundle::Progress::converged) result_ = bundle_->Result();
  bundle_ = nullptr;
  return false;
}

const std::optional<WindowFit>& WindowFitting::AllRounds() {
  while (Round()) {
  }
  return result_;
}

}  // namespace vo
