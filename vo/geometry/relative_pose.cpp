#include "vo/geometry/relative_pose.h"

#include <Eigen/Core>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace vo {
namespace {

constexpr double kThreshold = 2e-3;  // distance from the epipolar line, a pixel at a focal length of 500
constexpr double kConfidence = 0.999;
constexpr int kIterations = 200;
constexpr std::size_t kLeastPairs = 6;  // five have up to ten solutions

}  // namespace

std::optional<RelativePose> FindRelativePose(const std::vector<RayPair>& pairs) {
  if (pairs.size() < kLeastPairs) return std::nullopt;
  std::vector<cv::Point2d> first, second;
  for (const RayPair& pair : pairs) {
    first.emplace_back(pair.first.x(), pair.first.y());
    second.emplace_back(pair.second.x(), pair.second.y());
  }
  const cv::Mat K = cv::Mat::eye(3, 3, CV_64F);
  cv::Mat inliers, R, t;
  const cv::Mat E = cv::findEssentialMat(first, second, K, cv::RANSAC, kConfidence, kThreshold, kIterations, inliers);
  if (E.rows != 3 || cv::recoverPose(E, first, second, K, R, t, inliers) == 0) return std::nullopt;
  Eigen::Matrix3d R_BA;
  Eigen::Vector3d t_BA;
  cv::cv2eigen(R, R_BA);
  cv::cv2eigen(t, t_BA);
  return RelativePose{Eigen::Quaterniond(R_BA.transpose()).normalized(), -R_BA.transpose() * t_BA};
}

}  // namespace vo
