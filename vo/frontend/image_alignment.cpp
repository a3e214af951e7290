#include "vo/frontend/image_alignment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "vo/geometry/so3.h"

namespace vo {
namespace {

constexpr int kWidths[] = {40, 80, 160};
constexpr int kSmallest = 8;  // px
constexpr int kIterations = 15;
constexpr double kStill_px = 0.02;      // of the level
constexpr double kHuber = 10;           // grey levels
constexpr double kLeastOverlap = 0.25;  // of the pixels

double Bilinear(const cv::Mat& image, const Eigen::Vector2d& at) {
  const int x = static_cast<int>(at.x()), y = static_cast<int>(at.y());
  const double u = at.x() - x, v = at.y() - y;
  const float* row = image.ptr<float>(y) + x;
  const float* next = image.ptr<float>(y + 1) + x;
  return (1 - v) * ((1 - u) * row[0] + u * row[1]) + v * ((1 - u) * next[0] + u * next[1]);
}

// Pixel of the camera's image at (x, y) of a level that is `scale` times smaller, and back: both count from the centre
// of the first pixel.
Eigen::Vector2d Enlarged(double x, double y, double scale) {
  return {(x + 0.5) * scale - 0.5, (y + 0.5) * scale - 0.5};
}
Eigen::Vector2d Reduced(const Eigen::Vector2d& pixel, double scale) { return (pixel.array() + 0.5) / scale - 0.5; }

// Pixel of the earlier image.
struct TemplatePixel {
  Eigen::Vector3d ray;
  double grey;
  Eigen::Vector3d J;  // d grey / d phi at Exp(phi) ray
};

std::vector<TemplatePixel> TemplateOf(const Camera& camera, const cv::Mat& level, double scale) {
  std::vector<TemplatePixel> pixels;
  for (int y = 1; y + 1 < level.rows; ++y) {
    for (int x = 1; x + 1 < level.cols; ++x) {
      const std::optional<Eigen::Vector2d> xy = camera.TryUnproject(Enlarged(x, y, scale));
      if (!xy) continue;
      const Eigen::Vector2d gradient(0.5 * (level.at<float>(y, x + 1) - level.at<float>(y, x - 1)),
                                     0.5 * (level.at<float>(y + 1, x) - level.at<float>(y - 1, x)));
      const Eigen::Vector3d ray(xy->x(), xy->y(), 1);
      Eigen::Matrix<double, 2, 3> J_projection;
      J_projection << 1, 0, -xy->x(), 0, 1, -xy->y();
      const Eigen::RowVector3d J = gradient.transpose() / scale * camera.LensJacobian(*xy) * J_projection * -Hat(ray);
      pixels.push_back({ray, level.at<float>(y, x), J.transpose()});
    }
  }
  return pixels;
}

// One level, from `R`; false where the images do not determine the rotation.
bool AlignLevel(const Camera& camera, const cv::Mat& then, const cv::Mat& now, Eigen::Quaterniond& R) {
  const double scale = static_cast<double>(camera.width) / now.cols;
  const std::vector<TemplatePixel> pixels = TemplateOf(camera, then, scale);
  std::vector<std::pair<const TemplatePixel*, double>> residuals;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    residuals.clear();
    double offset = 0;  // of the exposures
    for (const TemplatePixel& pixel : pixels) {
      const Eigen::Vector3d ray = R * pixel.ray;
      if (ray.z() <= 0 || !camera.IsInjective(ray.hnormalized())) continue;
      const Eigen::Vector2d at = Reduced(camera.Project(ray), scale);
      if (!(at.x() >= 0 && at.y() >= 0 && at.x() < now.cols - 1 && at.y() < now.rows - 1)) continue;
      residuals.emplace_back(&pixel, Bilinear(now, at) - pixel.grey);
      offset += residuals.back().second;
    }
    if (static_cast<double>(residuals.size()) < kLeastOverlap * static_cast<double>(pixels.size())) return false;
    offset /= static_cast<double>(residuals.size());
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (const auto& [pixel, difference] : residuals) {
      const double r = difference - offset, weight = kHuber / std::max(kHuber, std::abs(r));
      A += weight * pixel->J * pixel->J.transpose();
      b += weight * r * pixel->J;
    }
    const Eigen::LLT<Eigen::Matrix3d> llt(A);
    if (llt.info() != Eigen::Success) return false;
    const Eigen::Vector3d step = llt.solve(b);
    R = (R * Exp(-step)).normalized();
    if (step.norm() * camera.fx / scale < kStill_px) break;
  }
  return true;
}

}  // namespace

std::vector<cv::Mat> Thumbnails(const cv::Mat& grey) {
  std::vector<cv::Mat> levels;
  for (const int width : kWidths) {
    const double scale = std::min(1.0, static_cast<double>(width) / grey.cols);
    const auto reduced = [&](int size) { return std::max(kSmallest, cvRound(size * scale)); };
    cv::Mat level;
    cv::resize(grey, level, {reduced(grey.cols), reduced(grey.rows)}, 0, 0, cv::INTER_AREA);
    level.convertTo(level, CV_32F);
    cv::GaussianBlur(level, level, {}, 1.0);
    levels.push_back(level);
  }
  return levels;
}

std::optional<Eigen::Quaterniond> AlignRotation(const Camera& camera, const std::vector<cv::Mat>& then,
                                                const std::vector<cv::Mat>& now, const Eigen::Quaterniond& start) {
  Eigen::Quaterniond R = start;
  for (std::size_t level = 0; level < then.size(); ++level)
    if (!AlignLevel(camera, then[level], now[level], R)) return std::nullopt;
  return R;
}

}  // namespace vo
