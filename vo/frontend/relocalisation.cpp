#include "vo/frontend/relocalisation.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

#include "vo/frontend/corner_recognition.h"

namespace vo {
namespace {

constexpr int kMoreCorners = 2;  // per cell
constexpr double kThreshold_px = 4;
constexpr int kIterations = 110;  // enough where half of the matches are inliers: ln(1 - kConfidence) / ln(1 - 0.5^4)
constexpr double kConfidence = 0.999;

}  // namespace

Relocaliser::Relocaliser(const Camera& camera, const FeatureParams& params, int border_px)
    : camera_(camera), params_(params), border_px_(border_px) {}

std::optional<Relocalisation> Relocaliser::Find(const PreparedFrame& frame, std::span<const KnownPoint> points) const {
  if (points.size() < kLeastInliers) return std::nullopt;
  std::vector<const Descriptor*> known;
  for (const KnownPoint& point : points) known.push_back(point.descriptor);
  std::vector<int> matched;
  std::vector<cv::Point3d> X;
  std::vector<cv::Point2d> z;
  for (const auto& [index, pixel] : RecogniseCorners(frame, known, params_, kMoreCorners, border_px_)) {
    const auto ray = camera_.TryUnproject(pixel.cast<double>());
    if (!ray) continue;
    const Eigen::Vector3d& X_W = points[index].X_W;
    matched.push_back(static_cast<int>(index));
    X.emplace_back(X_W.x(), X_W.y(), X_W.z());
    z.emplace_back(ray->x(), ray->y());
  }
  if (matched.size() < kLeastInliers) return std::nullopt;

  const auto threshold = static_cast<float>(kThreshold_px / std::sqrt(camera_.fx * camera_.fy));
  cv::Vec3d rotation, translation;
  std::vector<int> inliers;
  if (!cv::solvePnPRansac(X, z, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotation, translation, false, kIterations,
                          threshold, kConfidence, inliers, cv::SOLVEPNP_AP3P) ||
      inliers.size() < kLeastInliers)
    return std::nullopt;
  std::vector<cv::Point3d> X_in;
  std::vector<cv::Point2d> z_in;
  for (const int i : inliers) {
    X_in.push_back(X[static_cast<std::size_t>(i)]);
    z_in.push_back(z[static_cast<std::size_t>(i)]);
  }
  cv::solvePnPRefineLM(X_in, z_in, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotation, translation);
  cv::Mat R;
  cv::Rodrigues(rotation, R);
  Eigen::Matrix3d R_CW;
  cv::cv2eigen(R, R_CW);
  Relocalisation found;
  found.pose.q_WC = Eigen::Quaterniond(R_CW.transpose()).normalized();
  found.pose.p_WC = -(found.pose.q_WC * Eigen::Vector3d(translation[0], translation[1], translation[2]));
  for (const int i : inliers) found.inliers.push_back(matched[static_cast<std::size_t>(i)]);
  std::ranges::sort(found.inliers);
  return found;
}

}  // namespace vo
