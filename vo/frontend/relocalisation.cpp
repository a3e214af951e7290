#include "vo/frontend/relocalisation.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/features2d.hpp>

#include "vo/features/corner_detector.h"
#include "vo/features/matcher.h"

namespace vo {
namespace {

constexpr int kMoreCorners = 2;      // per cell, for a landmark's corner to be among them
constexpr float kMostHamming = 112;  // of 512 bits: the corner is found a pixel aside, and seen from elsewhere
constexpr float kRatio = 0.85F;      // of the nearest neighbour's distance to the second nearest's
constexpr double kThreshold_px = 4;
constexpr int kIterations = 110;  // enough where half of the matches are inliers: ln(1 - kConfidence) / ln(1 - 0.5^4)
constexpr double kConfidence = 0.999;

cv::Mat Row(const Descriptor& descriptor) {
  return cv::Mat(1, sizeof(Descriptor), CV_8U, const_cast<std::uint64_t*>(descriptor.data()));
}

}  // namespace

Relocaliser::Relocaliser(const Camera& camera, const FeatureParams& params, int border_px)
    : camera_(camera), params_(params), border_px_(border_px), sampler_(FirstSampler(params)) {
  params_.per_cell *= kMoreCorners;
}

std::optional<Relocalisation> Relocaliser::Find(const PreparedFrame& frame, std::span<const KnownPoint> points) const {
  if (points.size() < kLeastInliers) return std::nullopt;
  const std::vector<Eigen::Vector2i> corners = DetectCorners(frame.grey, {}, border_px_, params_);
  if (corners.size() < kLeastInliers) return std::nullopt;
  cv::Mat seen, known;
  for (const Eigen::Vector2i& corner : corners) seen.push_back(Row(frame.brisk.Describe(corner, sampler_)));
  for (const KnownPoint& point : points) known.push_back(Row(*point.descriptor));

  std::vector<std::vector<cv::DMatch>> neighbours;
  cv::BFMatcher(cv::NORM_HAMMING).knnMatch(known, seen, neighbours, 2);
  std::vector<const cv::DMatch*> of_corner(corners.size(), nullptr);  // the nearest of the landmarks
  for (const std::vector<cv::DMatch>& nearest : neighbours) {
    if (nearest.size() < 2 || nearest[0].distance > std::min(kMostHamming, kRatio * nearest[1].distance)) continue;
    const cv::DMatch*& best = of_corner[static_cast<std::size_t>(nearest[0].trainIdx)];
    if (best == nullptr || nearest[0].distance < best->distance) best = nearest.data();
  }
  std::vector<int> matched;
  std::vector<cv::Point3d> X;
  std::vector<cv::Point2d> z;
  for (const cv::DMatch* match : of_corner) {
    if (match == nullptr) continue;
    const auto ray = camera_.TryUnproject(corners[static_cast<std::size_t>(match->trainIdx)].cast<double>());
    if (!ray) continue;
    const Eigen::Vector3d& X_W = points[static_cast<std::size_t>(match->queryIdx)].X_W;
    matched.push_back(match->queryIdx);
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
