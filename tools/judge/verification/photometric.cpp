#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tools/judge/verification/comparisons.h"

namespace verification {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double kSigmas = 6;
constexpr double kBlur = 1.5;  // of Frames::Smooth [px]
// [px] largest displacement by bilinear interpolation and the pixels' area; measured
constexpr double kInterpolation = 0.03;
constexpr double kNone = std::numeric_limits<double>::infinity();

// The upper of the middle two.
double Median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// A pixel of this frame, the image of its surface point in the partner's picture, and the value there.
struct Sample {
  int x, y;
  double here, there;
  Vector2d slope;  // of the partner's picture
};

double Value(const cv::Mat& picture, const Corners& c) {
  const auto p = [&](int i, int j) { return picture.at<float>(c.y + j, c.x + i); };
  return static_cast<double>(Mix(c, p(0, 0), p(1, 0), p(0, 1), p(1, 1)));
}

struct Pair {
  std::vector<Sample> samples;
  double bend = 0;  // median change of the motion in the picture from one frame to the next [px]
};

// Pixels of `frame` that are visible in `partner`: where its depth around the projection is that of the point.
Pair Match(Frames& frames, std::size_t frame, std::size_t partner) {
  Pair pair;
  const cv::Mat depth = frames.Depth(frame), other_depth = frames.Depth(partner), here = frames.Smooth(frame),
                there = frames.Smooth(partner);
  const auto move = Between(frames.sequence(), frame, partner);
  if (depth.empty() || other_depth.empty() || here.empty() || there.empty() || !move) return pair;
  // Moving objects do not follow the camera's poses alone; without a mask they are unknown.
  const cv::Mat moving = frames.Picture("moving", frame), moving_there = frames.Picture("moving", partner);
  const bool has_masks = !moving.empty() && !moving_there.empty();
  if (!frames.sequence().objects.empty() && !has_masks) return pair;
  const auto stands_still = [&](const cv::Mat& mask, int x, int y) {
    return cv::countNonZero(mask(cv::Rect(x - 4, y - 4, 9, 9))) == 0;
  };
  const std::size_t step = partner > frame ? partner - frame : frame - partner;
  std::optional<Relative> back;  // as far in the other direction
  if (partner > frame && frame >= step) back = Between(frames.sequence(), frame, frame - step);
  if (partner < frame && frame + step < frames.count()) back = Between(frames.sequence(), frame, frame + step);
  const vo::Camera& camera = frames.sequence().camera;
  std::vector<double> bends;
  for (int y = 4; y < depth.rows - 4; ++y) {
    for (int x = 4 + y % 2; x < depth.cols - 4; x += 2) {
      const double Z = static_cast<double>(depth.at<float>(y, x));
      if (!(Z > 0)) continue;
      const Vector3d point = Z * frames.rays()[static_cast<std::size_t>(y) * static_cast<std::size_t>(depth.cols) +
                                               static_cast<std::size_t>(x)];
      const Vector3d X = move->R * point + move->t;
      if (!(X.z() > 0)) continue;
      const Vector2d pixel = camera.Project(X);
      const auto c = CornersAt(there, pixel.x(), pixel.y());
      if (!c || c->x < 4 || c->y < 4 || c->x + 5 >= there.cols || c->y + 5 >= there.rows) continue;
      // No edge of depth within the blur, in neither picture.
      bool smooth = true;
      for (const int d : {-4, 4}) {
        for (const double near : {depth.at<float>(y, x + d), depth.at<float>(y + d, x)})
          smooth = smooth && std::abs(near - Z) < 0.05 * Z;
        for (const double near : {other_depth.at<float>(c->y, c->x + d), other_depth.at<float>(c->y + d, c->x)}) {
          smooth = smooth && std::abs(near - X.z()) < 0.05 * X.z();
        }
      }
      if (!smooth) continue;
      if (has_masks && !(stands_still(moving, x, y) && stands_still(moving_there, c->x, c->y))) continue;
      if (back && (x + y) % 16 == 0) {
        const Vector3d X_back = back->R * point + back->t;
        if (X_back.z() > 0) bends.push_back((pixel + camera.Project(X_back) - 2 * Vector2d(x, y)).norm());
      }
      Sample sample{x, y, static_cast<double>(here.at<float>(y, x)), Value(there, *c), {}};
      const auto right = CornersAt(there, pixel.x() + 1, pixel.y()), left = CornersAt(there, pixel.x() - 1, pixel.y()),
                 down = CornersAt(there, pixel.x(), pixel.y() + 1), up = CornersAt(there, pixel.x(), pixel.y() - 1);
      sample.slope = Vector2d(Value(there, *right) - Value(there, *left), Value(there, *down) - Value(there, *up)) / 2;
      if (sample.here < 250 && sample.there < 250) pair.samples.push_back(sample);
    }
  }
  if (!bends.empty()) pair.bend = Median(bends);
  return pair;
}

// The shift of the whole picture, with a gain and an offset of brightness, that best explains the differences: least
// squares, large differences weighted down (Huber).
struct Offset {
  double size = 0, sigma = 0;  // [px]
};
Offset Fit(const std::vector<Sample>& samples) {
  double scale = kNone;
  Vector4d x = Vector4d::Zero();
  Eigen::Matrix4d H;
  for (int round = 0; round < 5; ++round) {
    H.setZero();
    Vector4d b = Vector4d::Zero();
    std::vector<double> sizes;
    for (const Sample& s : samples) {
      const Vector4d J(s.slope.x(), s.slope.y(), s.there / 100, 1);
      const double r = s.there - s.here, size = std::abs(r + J.dot(x)),
                   weight = size > 1.345 * scale ? 1.345 * scale / size : 1;
      H += weight * J * J.transpose();
      b -= weight * r * J;
      sizes.push_back(size);
    }
    x = H.ldlt().solve(b);
    scale = std::max(1.4826 * Median(sizes), 1e-3);
  }
  // Differences within the blur are not independent: one of so many samples counts (every other pixel is one).
  const double together = 4 * std::numbers::pi * kBlur * kBlur / 2;
  const Eigen::Matrix4d covariance = H.ldlt().solve(Eigen::Matrix4d::Identity()) * scale * scale * together;
  return {x.head<2>().norm(), std::sqrt(covariance(0, 0) + covariance(1, 1))};
}

// 1 - correlation of the partner's values with those of a picture at the samples' pixels.
double Misfit(const std::vector<Sample>& samples, const cv::Mat& picture) {
  double n = 0, a = 0, b = 0, aa = 0, ab = 0, bb = 0;
  for (const Sample& s : samples) {
    const double here = static_cast<double>(picture.at<float>(s.y, s.x));
    n += 1, a += here, b += s.there, aa += here * here, ab += here * s.there, bb += s.there * s.there;
  }
  const double cov = ab - a * b / n, var = (aa - a * a / n) * (bb - b * b / n);
  return var > 0 ? 1 - cov / std::sqrt(var) : 1;
}

// How far the pictures of two frames are apart, in the median of some pixels.
double Motion(Frames& frames, std::size_t from, std::size_t to) {
  const cv::Mat depth = frames.Depth(from);
  const auto move = Between(frames.sequence(), from, to);
  std::vector<double> sizes;
  for (int y = 4; move && y < depth.rows; y += 8) {
    for (int x = 4; x < depth.cols; x += 8) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(depth.cols) + static_cast<std::size_t>(x);
      const double Z = static_cast<double>(depth.at<float>(y, x));
      const Vector3d X = Z * (move->R * frames.rays()[i]) + move->t;
      if (Z > 0 && X.z() > 0) sizes.push_back((frames.sequence().camera.Project(X) - Vector2d(x, y)).norm());
    }
  }
  return sizes.empty() ? 0 : Median(sizes);
}

}  // namespace

std::vector<Check> PhotometricChecks() {
  return {{"pictures against neighbours: offset", "px"}, {"pictures: own stamp against the next ones", "of misfit"}};
}

void ComparePictures(Frames& frames, std::size_t frame, std::vector<Check>& checks) {
  if (frames.sequence().rolling_shutter) return;  // depth is that of the stamp, rows have other times
  constexpr std::size_t kEnough = 500;
  double offset = kNone, offset_bound = 1, order = kNone;
  for (const std::size_t partner : Partners(frame, frames.count())) {
    const Pair pair = Match(frames, frame, partner);
    if (pair.samples.size() < kEnough) continue;
    const Offset fit = Fit(pair.samples);
    // The mean over an exposure (at most the time between two frames) of a motion of curvature `bend` deviates by up to
    // bend / 24 from the middle, in either picture.
    const double bound = kInterpolation + kSigmas * fit.sigma + pair.bend / 12;
    if (fit.size / bound < offset / offset_bound) offset = fit.size, offset_bound = bound;
    // Another picture in place of this one must fit worse.
    double best_other = kNone;
    for (const std::ptrdiff_t step : {-1, 1}) {
      const auto other = static_cast<std::ptrdiff_t>(frame) + step;
      if (other < 0 || other >= static_cast<std::ptrdiff_t>(frames.count())) continue;
      const auto candidate = static_cast<std::size_t>(other);
      const cv::Mat picture = frames.Smooth(candidate);
      if (candidate == partner || picture.empty() || Motion(frames, frame, candidate) < 0.5) continue;
      best_other = std::min(best_other, Misfit(pair.samples, picture));
    }
    if (best_other < kNone) order = std::min(order, Misfit(pair.samples, frames.Smooth(frame)) / best_other);
  }
  const std::string where = "rgb " + frames.Stamp(frame);
  if (offset < kNone) checks[0].Add(offset, offset_bound, where);
  if (order < kNone) checks[1].Add(order, 1, where);
}

}  // namespace verification
