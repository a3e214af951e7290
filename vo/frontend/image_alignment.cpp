#include "vo/frontend/image_alignment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <span>

#include "vo/geometry/so3.h"

namespace vo {
namespace {

constexpr int kWidths[] = {40, 80, 160};
constexpr int kSmallest = 8;  // px
constexpr int kIterations = 15;
constexpr double kStill_px = 0.02;      // of the level
constexpr double kHuber = 10;           // grey levels
constexpr double kLeastOverlap = 0.25;  // of the pixels
constexpr double kExplained = 0.5;      // most of the mean absolute deviation that may be left
constexpr int kGridX = 3, kGridY = 5;   // steps up and down, left and right
constexpr double kGridStep = 0.1;       // [rad], within the basin of the coarsest level

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

double ScaleOf(const Camera& camera, const cv::Mat& level) { return static_cast<double>(camera.width) / level.cols; }

// Pixel of the earlier image.
struct TemplatePixel {
  Eigen::Vector3d ray;
  double grey;
  Eigen::Vector3d J;  // d grey / d phi at Exp(phi) ray
};

std::vector<TemplatePixel> TemplateOf(const Camera& camera, const cv::Mat& level) {
  const double scale = ScaleOf(camera, level);
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

// Differences of the grey levels at the pixels that both images show, less their mean, that of the exposures.
struct Residuals {
  std::vector<const TemplatePixel*> pixels;
  std::vector<double> differences;

  // False where the images overlap too little.
  bool Set(const Camera& camera, std::span<const TemplatePixel> earlier, const cv::Mat& now,
           const Eigen::Quaterniond& R) {
    const double scale = ScaleOf(camera, now);
    pixels.clear();
    differences.clear();
    double sum = 0;
    for (const TemplatePixel& pixel : earlier) {
      const Eigen::Vector3d ray = R * pixel.ray;
      if (ray.z() <= 0 || !camera.IsInjective(ray.hnormalized())) continue;
      const Eigen::Vector2d at = Reduced(camera.Project(ray), scale);
      if (!(at.x() >= 0 && at.y() >= 0 && at.x() < now.cols - 1 && at.y() < now.rows - 1)) continue;
      pixels.push_back(&pixel);
      differences.push_back(Bilinear(now, at) - pixel.grey);
      sum += differences.back();
    }
    for (double& difference : differences) difference -= sum / static_cast<double>(differences.size());
    return static_cast<double>(pixels.size()) >= kLeastOverlap * static_cast<double>(earlier.size());
  }
  double MeanAbsolute() const {
    double sum = 0;
    for (const double difference : differences) sum += std::abs(difference);
    return sum / static_cast<double>(differences.size());
  }
};

// The best of a grid of rotations, by some of the coarsest level's pixels.
Eigen::Quaterniond BestOfGrid(const Camera& camera, std::span<const TemplatePixel> level, const cv::Mat& now) {
  constexpr std::size_t kEvery = 3;
  std::vector<TemplatePixel> pixels;
  for (std::size_t i = 0; i < level.size(); i += kEvery) pixels.push_back(level[i]);
  std::vector<Eigen::Quaterniond> rotations{Eigen::Quaterniond::Identity()};
  for (int x = -kGridX; x <= kGridX; ++x)
    for (int y = -kGridY; y <= kGridY; ++y) rotations.push_back(Exp(kGridStep * Eigen::Vector3d(x, y, 0)));
  Residuals residuals;
  Eigen::Quaterniond best = rotations[0];
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Quaterniond& R : rotations) {
    if (!residuals.Set(camera, pixels, now, R) || residuals.MeanAbsolute() >= least) continue;
    least = residuals.MeanAbsolute();
    best = R;
  }
  return best;
}

// One level, from `R`; false where the images do not determine the rotation.
bool AlignLevel(const Camera& camera, std::span<const TemplatePixel> pixels, const cv::Mat& now,
                Eigen::Quaterniond& R) {
  const double scale = ScaleOf(camera, now);
  Residuals residuals;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    if (!residuals.Set(camera, pixels, now, R)) return false;
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < residuals.pixels.size(); ++i) {
      const Eigen::Vector3d& J = residuals.pixels[i]->J;
      const double r = residuals.differences[i], weight = kHuber / std::max(kHuber, std::abs(r));
      A += weight * J * J.transpose();
      b += weight * r * J;
    }
    const Eigen::LLT<Eigen::Matrix3d> llt(A);
    if (llt.info() != Eigen::Success) return false;
    const Eigen::Vector3d step = llt.solve(b);
    R = (R * Exp(-step)).normalized();
    if (step.norm() * camera.fx / scale < kStill_px) break;
  }
  return true;
}

// Whether the rotated earlier image explains a sufficient part of the later one's variation.
bool Explains(const Camera& camera, std::span<const TemplatePixel> pixels, const cv::Mat& now,
              const Eigen::Quaterniond& R) {
  Residuals residuals;
  if (!residuals.Set(camera, pixels, now, R)) return false;
  double mean = 0, deviation = 0;
  for (const TemplatePixel* pixel : residuals.pixels)
    mean += pixel->grey / static_cast<double>(residuals.pixels.size());
  for (const TemplatePixel* pixel : residuals.pixels)
    deviation += std::abs(pixel->grey - mean) / static_cast<double>(residuals.pixels.size());
  return residuals.MeanAbsolute() < kExplained * deviation;
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
                                                const std::vector<cv::Mat>& now) {
  std::vector<TemplatePixel> pixels = TemplateOf(camera, then[0]);
  Eigen::Quaterniond R = BestOfGrid(camera, pixels, now[0]);
  for (std::size_t level = 0; level < then.size(); ++level) {
    if (level > 0) pixels = TemplateOf(camera, then[level]);
    if (!AlignLevel(camera, pixels, now[level], R)) return std::nullopt;
  }
  return Explains(camera, pixels, now.back(), R) ? std::optional(R) : std::nullopt;
}

}  // namespace vo
