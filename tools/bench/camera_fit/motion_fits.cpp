// Exposure time and vignetting: what only motion tells.
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "tools/bench/camera_fit/camera_fit.h"

namespace vobench {
namespace {

constexpr double kGaussianWidth = 2.5631;  // 10 ... 90 % of a Gaussian of sigma 1

// 10 ... 90 % width of a Gaussian of `sigma` convolved with a box of length L.
double BlurredWidth(double sigma, double L) {
  if (L < 1e-3) return kGaussianWidth * sigma;
  const auto integral = [&](double x) {  // of the normal distribution function
    const double z = x / sigma;
    return x * 0.5 * std::erfc(-z / std::numbers::sqrt2) +
           sigma * std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
  };
  double low = 0, high = 4 * sigma + L;
  for (int i = 0; i < 50; ++i) {
    const double x = 0.5 * (low + high);
    ((integral(x + L / 2) - integral(x - L / 2)) / L < 0.9 ? low : high) = x;
  }
  return low + high;
}

}  // namespace

std::optional<Measure> FitExposure(const Recording& recording, EdgeStatistics& at_rest) {
  std::vector<std::pair<double, Edge>> edges;  // with the speed [px / frame] along the row
  for (const Pair& pair : recording.pairs) {
    for (const Edge& edge : FindEdges(pair.picture)) {
      const Motion* nearest = pair.Nearest(edge.at, 60);
      if (nearest == nullptr || std::abs(edge.slope) > 0.6) continue;
      const double x = nearest->by.x, y = nearest->by.y;
      edges.emplace_back(std::abs(edge.in_column ? y + x * edge.slope : x + y * edge.slope), edge);
    }
  }
  at_rest = {};
  if (edges.size() < 200) return std::nullopt;
  std::ranges::sort(edges, {}, &std::pair<double, Edge>::first);
  std::vector<Edge> slow;
  for (std::size_t i = 0; i < std::max<std::size_t>(100, edges.size() / 8); ++i) slow.push_back(edges[i].second);
  at_rest = Summarise(slow);
  constexpr std::size_t kBins = 12;
  std::vector<double> speeds, widths;
  for (std::size_t b = 0; b < kBins; ++b) {
    std::vector<double> speed, width;
    for (std::size_t i = b * edges.size() / kBins; i < (b + 1) * edges.size() / kBins; ++i)
      speed.push_back(edges[i].first), width.push_back(edges[i].second.width);
    speeds.push_back(Quantile(speed, 0.5)), widths.push_back(Quantile(width, 0.25));
  }
  double share = 0, best = 1e9;
  std::vector<double> least;  // mean square of the log of the modelled width over the measured, by share
  for (double tried = 0.005; tried <= 1; tried += 0.005) {
    least.push_back(1e9);
    for (double sigma = 0.2; sigma < 3; sigma *= 1.03) {
      double sum = 0;
      for (std::size_t b = 0; b < kBins; ++b)
        sum += std::pow(std::log(BlurredWidth(sigma, tried * speeds[b]) / widths[b]), 2) / kBins;
      least.back() = std::min(least.back(), sum);
    }
    if (least.back() < best) best = least.back(), share = tried;
  }
  // Shares at which the sum of squares is one variance (of 10 degrees of freedom) larger: one standard deviation.
  const auto near = std::ranges::count_if(least, [&](double size) { return size < best * (1 + 1.0 / (kBins - 2)); });
  const Measure measured{share * recording.period_s, 0.0025 * static_cast<double>(near) * recording.period_s};
  const bool blurs = share * speeds.back() > at_rest.width;  // the fastest edges, visibly
  if (!blurs || measured.sigma > std::max(0.002, 0.1 * measured.value) || share > 0.99) return std::nullopt;
  return measured;
}

std::optional<Measure> FitVignetting(const Recording& recording, const std::vector<double>& linear,
                                     sim::OpticsParams& optics) {
  const cv::Mat table(1, 256, CV_64F, const_cast<double*>(linear.data()));
  struct Sight {
    double r2_first, r2, log_ratio;
  };
  std::vector<std::vector<Sight>> frames;  // what was seen before, in the first frame of its run
  for (const std::vector<cv::Mat>& run : recording.runs) {
    struct Place {
      cv::Point2f at;
      double r2_first = 0, log_first = 0;
    };
    std::vector<Place> places;
    for (int y = 16; y < run.front().rows; y += 32) {
      for (int x = 16; x < run.front().cols; x += 32) places.push_back({cv::Point2f(cv::Point(x, y))});
    }
    for (std::size_t k = 0; k < run.size(); ++k) {
      const cv::Mat grey = Grey(run[k]);
      const cv::Point2f middle = 0.5 * cv::Point2f(cv::Point(grey.size()));
      const Pair pair = k + 1 < run.size() ? MakePair(run[k], run[k + 1]) : Pair{};
      frames.emplace_back();
      std::erase_if(places, [&](Place& place) {
        const cv::Rect patch(cvRound(place.at.x) - 8, cvRound(place.at.y) - 8, 17, 17);
        if ((patch & cv::Rect({}, grey.size())) != patch) return true;
        double most = 0;
        cv::Mat light;
        cv::minMaxLoc(grey(patch), nullptr, &most);
        cv::LUT(grey(patch), table, light);
        const double mean = cv::mean(light)[0], r2 = std::pow(cv::norm(place.at - middle) / cv::norm(middle), 2);
        if (most > 250 || mean < 0.01) return true;
        if (k == 0) place.r2_first = r2, place.log_first = std::log(mean);
        if (k > 0) frames.back().push_back({place.r2_first, r2, std::log(mean) - place.log_first});
        const Motion* nearest = pair.Nearest(place.at, 45);
        if (nearest != nullptr) place.at += nearest->by;
        return nearest == nullptr;
      });
    }
  }
  // Gauss-Newton, large residuals weighted down (Huber); v4 is 0 +- 0.1 before. Sights of one track are not independent:
  // ten count as one.
  struct Fit {
    Eigen::Vector2d v = Eigen::Vector2d::Zero();
    Eigen::Matrix2d H = Eigen::Matrix2d::Identity();
    double scale = 1e9, variance = 0;
  };
  const auto solve = [&](bool exposures_differ) {
    Fit fit;
    for (int round = 0; round < 8; ++round) {
      const auto factor = [&](double r2) { return std::max(0.05, 1 + r2 * (fit.v(0) + r2 * fit.v(1))); };
      Eigen::Vector2d b = Eigen::Vector2d::Zero();
      std::vector<double> sizes;
      fit.H.setZero();
      for (const std::vector<Sight>& frame : frames) {
        Eigen::MatrixX3d rows(frame.size(), 3);  // Jacobian and residual
        for (std::size_t i = 0; i < frame.size(); ++i) {
          const double r2 = frame[i].r2, r2_first = frame[i].r2_first, f = factor(r2), f_first = factor(r2_first);
          rows.row(static_cast<Eigen::Index>(i)) << r2 / f - r2_first / f_first,
              r2 * r2 / f - r2_first * r2_first / f_first, frame[i].log_ratio - std::log(f / f_first);
        }
        if (exposures_differ && !frame.empty()) rows.rowwise() -= rows.colwise().mean().eval();
        for (Eigen::Index i = 0; i < rows.rows(); ++i) {
          const double size = std::abs(rows(i, 2)), weight = size > fit.scale ? fit.scale / size : 1;
          const Eigen::Vector2d J(rows(i, 0), rows(i, 1));
          fit.H += weight * J * J.transpose(), b += weight * rows(i, 2) * J;
          sizes.push_back(size);
        }
      }
      fit.scale = std::max(1e-4, 2 * Quantile(sizes, 0.5));
      fit.variance = 10 * std::pow(0.74 * fit.scale, 2);
      fit.H += Eigen::Vector2d(1e-9, 100 * fit.variance).asDiagonal(), b(1) -= 100 * fit.variance * fit.v(1);
      fit.v += fit.H.ldlt().solve(b);
    }
    return fit;
  };
  const Fit same = solve(false), differ = solve(true), &fit = differ.scale < 0.7 * same.scale ? differ : same;
  const Measure corner{1 + fit.v.sum(), std::sqrt(fit.variance * fit.H.inverse().sum())};
  if (!(corner.sigma < 0.05) || corner.value < 0.06) return std::nullopt;
  optics.vignetting_2 = fit.v(0), optics.vignetting_4 = fit.v(1);
  return corner;
}

}  // namespace vobench
