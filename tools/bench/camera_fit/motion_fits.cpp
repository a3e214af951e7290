// Exposure time and vignetting, which follow from motion alone.
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/bench/camera_fit/camera_fit.h"

namespace vobench {
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
  Eigen::MatrixX2d A(kBins, 2);
  double fastest = 0;
  for (std::size_t b = 0; b < kBins; ++b) {
    std::vector<double> speed, width;
    for (std::size_t i = b * edges.size() / kBins; i < (b + 1) * edges.size() / kBins; ++i)
      speed.push_back(edges[i].first), width.push_back(edges[i].second.width);
    fastest = Quantile(speed, 0.5);
    A.row(static_cast<Eigen::Index>(b)) = Eigen::RowVector2d(1, fastest * fastest) / std::pow(Quantile(width, 0.25), 2);
  }
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(kBins);
  const Eigen::Matrix2d inverse = (A.transpose() * A).inverse();
  const Eigen::Vector2d x = inverse * A.transpose() * ones;
  const double share = std::sqrt(std::max(0.0, x(1)) / kBlur),
               sigma = std::sqrt(inverse(1, 1) / (kBins - 2)) * (A * x - ones).norm();
  const Measure measured{share * recording.period_s, recording.period_s * sigma / (2 * kBlur * std::max(1e-9, share))};
  const bool visible = share * fastest > at_rest.width && share <= 1;
  return visible && measured.sigma < std::max(0.002, 0.1 * measured.value) ? std::optional(measured) : std::nullopt;
}

std::optional<Measure> FitVignetting(const Recording& recording, const std::vector<double>& light_of_code) {
  const cv::Mat table(1, 256, CV_64F, const_cast<double*>(light_of_code.data()));
  std::vector<double> found;  // v2 of each run
  for (const std::vector<cv::Mat>& run : recording.runs) {
    std::vector<std::array<double, 3>> sights, firsts;  // r^2, r^2 in the first frame, log of the ratio to there
    std::vector<cv::Point2f> places;                    // of what is followed
    for (int i = 0; i < run.front().rows / 32 * 64; ++i)
      places.emplace_back(cv::Point(16 + i % 64 * 32, 16 + i / 64 * 32));
    for (std::size_t k = 0; k < run.size(); ++k) {
      const cv::Mat grey = Grey(run[k]);
      const cv::Point2f middle = 0.5 * cv::Point2f(cv::Point(grey.size()));
      const Pair pair = k + 1 < run.size() ? MakePair(run[k], run[k + 1]) : Pair{};
      for (std::size_t i = 0; i < places.size(); ++i) {
        const cv::Rect patch = cv::Rect(cv::Point(places[i]) - cv::Point(8, 8), cv::Size(17, 17));
        const Motion* nearest = pair.Nearest(places[i], 45);
        std::array<double, 3> seen{-1, 0, 0};
        if (places[i].x > 0 && (patch & cv::Rect({}, grey.size())) == patch) {
          cv::Mat light;
          cv::LUT(grey(patch), table, light);
          const double mean = cv::mean(light)[0], share = cv::norm(places[i] - middle) / cv::norm(middle);
          if (mean > 0.01 && cv::norm(grey(patch), cv::NORM_INF) < 250) seen = {share * share, 0, std::log(mean)};
        }
        if (k == 0) firsts.push_back(seen);
        const bool good = seen[0] >= 0 && firsts[i][0] >= 0;
        if (good && k > 0) sights.push_back({seen[0], firsts[i][0], seen[2] - firsts[i][2]});
        places[i] = good && nearest != nullptr ? places[i] + nearest->by : cv::Point2f(-99, -99);
      }
    }
    double spread = 0, best = 1e9, v2 = 0;
    for (const auto& s : sights) spread += std::abs(s[0] - s[1]);
    for (double tried = -0.95; tried < 0.5; tried += 0.005) {  // least absolute differences
      double sum = 0;
      for (const auto& s : sights) sum += std::abs(s[2] - std::log((1 + tried * s[0]) / (1 + tried * s[1])));
      if (sum < best) best = sum, v2 = tried;
    }
    if (spread > 50) found.push_back(v2);
  }
  if (found.size() < 2) return std::nullopt;
  cv::Scalar mean, sigma;
  cv::meanStdDev(found, mean, sigma);
  const Measure v2{mean[0], sigma[0] / std::sqrt(static_cast<double>(found.size()) - 1)};
  return v2.sigma < 0.05 ? std::optional(v2) : std::nullopt;
}

}  // namespace vobench
