#include "vo/frontend/new_features.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

#include "vo/features/corner_detector.h"

namespace vo {
namespace {

// Inverse depth of the board's plane on the ray (x, y, 1). `pose`: of the board in C, rotation vector and translation.
double InverseDepth(const Vector6& pose, const Eigen::Vector2d& ray) {
  cv::Mat R;
  cv::Rodrigues(cv::Vec3d(pose[0], pose[1], pose[2]), R);
  const Eigen::Vector3d normal(R.at<double>(0, 2), R.at<double>(1, 2), R.at<double>(2, 2));
  return normal.dot(ray.homogeneous()) / normal.dot(pose.tail<3>());
}

Vector6 Gradient(const Vector6& pose, const Eigen::Vector2d& ray) {
  constexpr double kStep = 1e-6;
  Vector6 gradient;
  for (int i = 0; i < 6; ++i) {
    const Vector6 step = kStep * Vector6::Unit(i);
    gradient[i] = (InverseDepth(pose + step, ray) - InverseDepth(pose - step, ray)) / (2 * kStep);
  }
  return gradient;
}

}  // namespace

std::vector<NewFeature> FindTarget(const cv::Mat& grey, const Camera& camera, const TargetParams& target,
                                   double sigma_px) {
  std::vector<cv::Point2f> corners;
  if (!cv::findChessboardCornersSB(grey, {target.columns, target.rows}, corners, cv::CALIB_CB_ACCURACY)) return {};
  std::vector<cv::Point3d> board;
  std::vector<cv::Point2d> seen;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto columns = static_cast<std::size_t>(target.columns);
    const std::size_t column = i % columns, row = i / columns;
    board.emplace_back(static_cast<double>(column) * target.square_m, static_cast<double>(row) * target.square_m, 0);
    const auto ray = camera.TryUnproject({corners[i].x, corners[i].y});
    if (!ray) return {};
    seen.emplace_back(ray->x(), ray->y());
  }
  cv::Vec3d rotation, translation;
  if (!cv::solvePnP(board, seen, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotation, translation)) return {};

  cv::Mat again, jacobian;
  cv::projectPoints(board, rotation, translation, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), again, jacobian);
  Eigen::MatrixXd J;
  cv::cv2eigen(jacobian.colRange(0, 6), J);
  const double focal = std::sqrt(camera.fx * camera.fy);
  const Matrix6 covariance = (J.transpose() * J).inverse() * (sigma_px * sigma_px / (focal * focal));
  Vector6 pose;
  pose << rotation[0], rotation[1], rotation[2], translation[0], translation[1], translation[2];

  std::vector<NewFeature> found;
  const double n = static_cast<double>(corners.size());
  for (const cv::Point2f& corner : corners) {
    const Eigen::Vector2i pixel(cvRound(corner.x), cvRound(corner.y));
    const Eigen::Vector2d ray = camera.Undistort(pixel.cast<double>());
    const Vector6 gradient = Gradient(pose, ray);
    const double variance = n * gradient.dot(covariance * gradient);
    const double inverse_depth = InverseDepth(pose, ray);
    if (!(inverse_depth > 0) || !std::isfinite(variance)) return {};
    found.push_back({pixel, KnownDepth{inverse_depth, std::sqrt(variance)}});
  }
  return found;
}

NewFeatureDetector::NewFeatureDetector(const Camera& camera, const Params& params, int border_px)
    : camera_(camera),
      features_(params.features),
      target_(params.target),
      border_px_(border_px),
      target_frames_(target_.columns > 0 ? target_.frames : 0) {}

std::vector<NewFeature> NewFeatureDetector::Detect(const PreparedFrame& frame, std::vector<Eigen::Vector2d> occupied,
                                                   std::size_t enough) {
  std::vector<NewFeature> found;
  if (target_frames_ > 0) {
    found = FindTarget(frame.grey, camera_, target_, features_.first_view_px);
    target_frames_ = found.empty() ? target_frames_ - 1 : 0;
    std::erase_if(found, [&](const NewFeature& f) { return !camera_.IsUsable(f.pixel.cast<double>(), border_px_); });
  }
  for (const NewFeature& feature : found) occupied.push_back(feature.pixel.cast<double>());
  FeatureParams params = features_;
  const auto detect = [&] {
    for (const Eigen::Vector2i& corner : DetectCorners(frame.grey, occupied, border_px_, params)) {
      occupied.push_back(corner.cast<double>());
      if (camera_.IsUsable(occupied.back())) found.push_back({corner, std::nullopt});
    }
  };
  detect();
  params.per_cell *= 2;
  if (occupied.size() < enough) detect();
  return found;
}

std::vector<NewFeature> LimitToCapacity(std::vector<NewFeature> features, std::size_t capacity, const Camera& camera) {
  if (features.size() <= capacity) return features;
  std::vector<Eigen::Vector2d> pixels;
  for (const NewFeature& feature : features) pixels.push_back(feature.pixel.cast<double>());
  const int cells = std::max(1, static_cast<int>(std::sqrt(capacity)));
  std::vector<std::size_t> order = BucketRoundRobin(pixels, cells, cells, camera.width, camera.height);
  std::stable_partition(order.begin(), order.end(), [&](std::size_t i) { return features[i].depth.has_value(); });
  std::vector<NewFeature> chosen;
  for (std::size_t i = 0; i < capacity; ++i) chosen.push_back(features[order[i]]);
  return chosen;
}

}  // namespace vo
