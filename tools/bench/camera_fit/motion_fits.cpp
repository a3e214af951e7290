// Exposure time and vignetting: what only motion tells.
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "tools/bench/camera_fit/fit.h"

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

EdgeStatistics Summarise(std::vector<Edge> edges) {
  const auto quantile = [&](double Edge::*member, double p) {
    std::vector<double> values;
    for (const Edge& edge : edges) values.push_back(edge.*member);
    return Quantile(values, p);
  };
  const std::size_t count = edges.size();
  const double median = quantile(&Edge::width, 0.5);
  std::erase_if(edges, [&](const Edge& edge) { return edge.width > median; });
  EdgeStatistics out{count,
                     0,
                     quantile(&Edge::bright, 0.5),
                     quantile(&Edge::dark, 0.5),
                     quantile(&Edge::low, 0.5),
                     quantile(&Edge::high, 0.5)};
  std::erase_if(edges, [&](const Edge& edge) {
    return std::abs(edge.bright - out.bright) > 0.06 || std::abs(edge.dark - out.dark) > 0.06;
  });
  out.width = quantile(&Edge::width, 0.5);
  return out;
}

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
  cv::Mat table(1, 256, CV_32F);
  for (int c = 0; c < 256; ++c) table.at<float>(c) = static_cast<float>(linear[static_cast<std::size_t>(c)]);
  struct Sight {
    double r2, log_light;
    std::size_t track, frame;
  };
  std::vector<Sight> sights;
  std::size_t tracks = 0, frames = 0;
  for (const std::vector<cv::Mat>& run : recording.runs) {
    std::vector<std::pair<std::size_t, cv::Point2f>> places;  // of what is followed
    for (std::size_t k = 0; k < run.size(); ++k, ++frames) {
      const cv::Mat grey = Grey(run[k]);
      const cv::Point2f middle(0.5F * static_cast<float>(grey.cols - 1), 0.5F * static_cast<float>(grey.rows - 1));
      if (k % 20 == 0) {
        places.clear();
        for (float y = 40; y < static_cast<float>(grey.rows - 40); y += 32) {
          for (float x = 40; x < static_cast<float>(grey.cols - 40); x += 32)
            places.emplace_back(tracks++, cv::Point2f(x, y));
        }
      }
      const Pair pair{{}, {}, k + 1 < run.size() ? MeasureMotion(run[k], run[k + 1]) : std::vector<Motion>{}};
      std::erase_if(places, [&](auto& place) {
        auto& [track, at] = place;
        const cv::Rect patch(cvRound(at.x) - 8, cvRound(at.y) - 8, 17, 17);
        double least = 0, most = 0;
        cv::Mat light;
        cv::minMaxLoc(grey(patch), &least, &most);
        cv::LUT(grey(patch), table, light);
        const double mean = cv::mean(light)[0];
        if (most > 250 || mean < 0.01) return true;
        const cv::Point2f from = at - middle;
        sights.push_back({from.dot(from) / middle.dot(middle), std::log(mean), track, frames});
        const Motion* nearest = pair.Nearest(at, 45);
        if (nearest == nullptr) return true;
        at += nearest->by;
        return at.x < 16 || at.y < 16 || at.x > static_cast<float>(grey.cols - 17) ||
               at.y > static_cast<float>(grey.rows - 17);
      });
    }
  }
  double v2 = 0, v4 = 0;
  Eigen::Matrix2d H;
  std::vector<double> of_frame(frames, 0.0);
  double scale = 1e9, used = 0;
  const auto mean_of = [&](std::size_t groups, const auto& key, const auto& value) {
    std::vector<double> sum(groups), count(groups);
    for (const Sight& s : sights) sum[key(s)] += value(s), count[key(s)] += 1;
    for (std::size_t i = 0; i < groups; ++i) sum[i] /= std::max(1.0, count[i]);
    return sum;
  };
  const auto of_track = [](const Sight& s) { return s.track; };
  const auto in_frame = [](const Sight& s) { return s.frame; };
  for (int round = 0; round < 8; ++round) {  // Gauss-Newton; tracks' and frames' own brightness by means in turn
    const auto factor = [&](const Sight& s) { return 1 + s.r2 * (v2 + s.r2 * v4); };
    const auto rest = [&](const Sight& s) { return s.log_light - std::log(factor(s)) - of_frame[s.frame]; };
    const std::vector<double> track_rest = mean_of(tracks, of_track, rest);
    const std::vector<double> track_2 = mean_of(tracks, of_track, [&](const Sight& s) { return s.r2 / factor(s); });
    const std::vector<double> track_4 =
        mean_of(tracks, of_track, [&](const Sight& s) { return s.r2 * s.r2 / factor(s); });
    H.setZero();
    Eigen::Vector2d b = Eigen::Vector2d::Zero();
    std::vector<double> sizes;
    for (const Sight& s : sights) {
      const Eigen::Vector2d J(s.r2 / factor(s) - track_2[s.track], s.r2 * s.r2 / factor(s) - track_4[s.track]);
      const double r = rest(s) - track_rest[s.track], weight = std::abs(r) > scale ? scale / std::abs(r) : 1;
      H += weight * J * J.transpose(), b += weight * r * J;
      sizes.push_back(std::abs(r));
    }
    used = H(0, 0);
    scale = std::max(1e-4, 2 * Quantile(sizes, 0.5));
    // v4 is 0 +- 0.1 before. Sights of one track are not independent: ten of them count as one.
    const double variance = 10 * std::pow(0.74 * scale, 2);
    H(0, 0) += 1e-9, H(1, 1) += variance / 0.01, b(1) -= v4 * variance / 0.01;
    const Eigen::Vector2d step = H.ldlt().solve(b);
    v2 += step(0), v4 += step(1);
    if (1 + v2 + v4 < 0.05) return std::nullopt;
    const std::vector<double> rows =
        mean_of(frames, in_frame, [&](const Sight& s) { return rest(s) - track_rest[s.track]; });
    for (std::size_t i = 0; i < frames; ++i) of_frame[i] += rows[i];
  }
  if (sights.size() < 500 || used < 1) return std::nullopt;
  const double sigma = std::sqrt((H.inverse() * 10 * std::pow(0.74 * scale, 2)).sum());
  optics.vignetting_2 = v2, optics.vignetting_4 = v4;
  if (sigma > 0.05) return std::nullopt;
  return Measure{1 + v2 + v4, sigma};
}

}  // namespace vobench
