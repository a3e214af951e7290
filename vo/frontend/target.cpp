#include "vo/frontend/target.h"

#include <Eigen/LU>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace vo {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;  // rotation vector and translation of the board, in C

// Inverse depth of the board's plane on the ray (x, y, 1).
double InverseDepth(const Vector6d& pose, const Eigen::Vector2d& ray) {
  cv::Mat R;
  cv::Rodrigues(cv::Vec3d(pose[0], pose[1], pose[2]), R);
  const Eigen::Vector3d normal(R.at<double>(0, 2), R.at<double>(1, 2), R.at<double>(2, 2));
  return normal.dot(ray.homogeneous()) / normal.dot(pose.tail<3>());
}

Vector6d Gradient(const Vector6d& pose, const Eigen::Vector2d& ray) {
  constexpr double kStep = 1e-6;
  Vector6d gradient;
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = kStep * Vector6d::Unit(i);
    gradient[i] = (InverseDepth(pose + step, ray) - InverseDepth(pose - step, ray)) / (2 * kStep);
  }
  return gradient;
}

}  // namespace

std::vector<TargetCorner> FindTarget(const cv::Mat& grey, const Camera& camera, const TargetParams& target,
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
  const Eigen::Matrix<double, 6, 6> covariance =
      (J.transpose() * J).inverse() * (sigma_px * sigma_px / (focal * focal));
  Vector6d pose;
  pose << rotation[0], rotation[1], rotation[2], translation[0], translation[1], translation[2];

  std::vector<TargetCorner> found;
  const double n = static_cast<double>(corners.size());
  for (const cv::Point2f& corner : corners) {
    const Eigen::Vector2i pixel(cvRound(corner.x), cvRound(corner.y));
    const Eigen::Vector2d ray = camera.Undistort(pixel.cast<double>());
    const Vector6d gradient = Gradient(pose, ray);
    const double variance = n * gradient.dot(covariance * gradient);
    const double inverse_depth = InverseDepth(pose, ray);
    if (!(inverse_depth > 0) || !std::isfinite(variance)) return {};
    found.push_back({pixel, {inverse_depth, std::sqrt(variance)}});
  }
  return found;
}

}  // namespace vo
