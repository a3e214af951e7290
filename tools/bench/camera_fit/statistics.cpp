#include "tools/bench/camera_fit/statistics.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace vobench {
namespace {

constexpr int kBlock = 16, kMargin = 6, kBinWidth = 20;

struct Block {
  double mean, structure, sigma;
  cv::Mat residual;              // beside a Gaussian of 2 px; of the difference of both pictures where it is aligned
  std::array<double, 2> parity;  // sums of squares where x + y is even, odd
};

struct Bin {
  std::vector<Block> single, aligned;
};

// The flattest share of them, 20 at least; none where there are fewer.
std::vector<Block> Flattest(std::vector<Block> blocks, std::size_t one_of) {
  const std::size_t wanted = std::max<std::size_t>(20, blocks.size() / one_of);
  if (wanted > blocks.size()) return {};
  std::ranges::nth_element(blocks, blocks.begin() + static_cast<std::ptrdiff_t>(wanted) - 1, {}, &Block::structure);
  blocks.resize(wanted);
  return blocks;
}

double Median(const std::vector<Block>& blocks, double Block::*member) {
  std::vector<double> values;
  for (const Block& block : blocks) values.push_back(block.*member);
  return Quantile(values, 0.5);
}

cv::Mat GreenAsFloat(const cv::Mat& picture) {
  cv::Mat green = picture;
  if (picture.channels() == 3) cv::extractChannel(picture, green, 1);
  green.convertTo(green, CV_32F);
  return green;
}

// Position where a rising profile first reaches a value.
double Crossing(const std::array<double, 17>& profile, double value) {
  for (std::size_t i = 1; i < profile.size(); ++i) {
    if (profile[i] < value) continue;
    const double before = std::min(profile[i - 1], value);
    return static_cast<double>(i) - (profile[i] - value) / std::max(profile[i] - before, 1e-9);
  }
  return 16;
}

// Linear in between.
double At(const std::array<double, 17>& profile, double place) {
  const auto i = static_cast<std::size_t>(std::clamp(place, 0.0, 15.0));
  return profile[i] + (place - static_cast<double>(i)) * (profile[i + 1] - profile[i]);
}

struct Side {
  double mean = 0, sigma = 0;
};
Side SideOf(const std::uint8_t* row, int from) {
  double sum = 0, squares = 0;
  for (int i = from; i < from + 6; ++i) sum += row[i], squares += row[i] * row[i];
  return {sum / 6, std::sqrt(std::max(0.0, squares / 6 - sum * sum / 36))};
}

void FindInRow(const cv::Mat& grey, const cv::Mat& across, int y, bool in_column, std::vector<Edge>& edges) {
  const auto* row = grey.ptr<std::uint8_t>(y);
  const auto step_at = [&](int x) { return std::abs(row[x + 1] - row[x - 1]); };
  for (int x = 14; x <= grey.cols - 15; ++x) {
    if (step_at(x) <= 45 || step_at(x) < std::max(step_at(x - 1), step_at(x + 1))) continue;
    const Side left = SideOf(row, x - 12), right = SideOf(row, x + 7);
    const double low = std::min(left.mean, right.mean), high = std::max(left.mean, right.mean);
    if (left.sigma > 2.5 || right.sigma > 2.5 || low < 15 || high > 235 || high - low < 60) continue;
    std::array<double, 17> p{}, rising{};
    for (int i = 0; i < 17; ++i)
      p[static_cast<std::size_t>(i)] = (row[x - 8 + i] - left.mean) / (right.mean - left.mean);
    if (*std::ranges::max_element(p) > 1.6 || *std::ranges::min_element(p) < -0.6) continue;
    double so_far = p[0];
    for (std::size_t i = 0; i < 17; ++i) rising[i] = so_far = std::max(so_far, p[i]);
    const double middle = Crossing(rising, 0.5);
    double bright = 0, dark = 0;
    for (const double d : {1.5, 2.0, 2.5, 3.0}) bright += (At(p, middle + d) - 1) / 4, dark -= At(p, middle - d) / 4;
    if (right.mean < left.mean) std::swap(bright, dark);
    const double gx = 0.5 * (row[x + 1] - row[x - 1]), gy = double{across.at<float>(y, x)};
    const cv::Point2f at(static_cast<float>(in_column ? y : x), static_cast<float>(in_column ? x : y));
    edges.push_back({at, in_column, Crossing(rising, 0.9) - Crossing(rising, 0.1), bright, dark, low, high, gy / gx});
  }
}

}  // namespace

double Quantile(std::vector<double> values, double p) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(p * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

cv::Mat Grey(const cv::Mat& picture) {
  cv::Mat grey = picture;
  if (picture.channels() == 3) cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

const Motion* Pair::Nearest(cv::Point2f at, double reach) const {
  const auto distance = [&](const Motion& m) { return cv::norm(m.at - at); };
  const auto nearest = std::ranges::min_element(motions, {}, distance);
  return nearest == motions.end() || distance(*nearest) > reach ? nullptr : &*nearest;
}

NoiseStatistics MeasureNoise(std::span<const Pair> pairs) {
  const cv::Mat second = (cv::Mat_<float>(3, 3) << 1, -2, 1, -2, 4, -2, 1, -2, 1) / 6;
  std::vector<Bin> bins(256 / kBinWidth + 1);
  const auto block = [&](const cv::Mat& picture, const cv::Rect& inner, Block known) {
    cv::Mat low, high;
    cv::GaussianBlur(picture, low, {}, 2);
    cv::filter2D(picture, high, -1, second);
    cv::Scalar mean, sigma;
    cv::meanStdDev(high(inner), mean, sigma);
    const cv::Mat residual = (picture - low)(inner);
    known.sigma = sigma[0], known.residual = residual - cv::mean(residual);
    for (int y = 0; y < kBlock; ++y) {
      for (int x = 0; x < kBlock; ++x)
        known.parity[static_cast<std::size_t>((x + y) & 1)] += std::pow(double{residual.at<float>(y, x)}, 2);
    }
    return known;
  };
  for (const Pair& pair : pairs) {
    const cv::Mat green = GreenAsFloat(pair.picture), next = GreenAsFloat(pair.next);
    cv::Mat low, gx, gy;
    cv::GaussianBlur(green, low, {}, 2);
    cv::Sobel(low, gx, CV_32F, 1, 0), cv::Sobel(low, gy, CV_32F, 0, 1);
    const cv::Rect whole({}, green.size()), inner(kMargin, kMargin, kBlock, kBlock);
    for (int y = kBlock; y + 2 * kBlock <= green.rows; y += kBlock) {
      for (int x = kBlock; x + 2 * kBlock <= green.cols; x += kBlock) {
        const cv::Rect place(x - kMargin, y - kMargin, kBlock + 2 * kMargin, kBlock + 2 * kMargin);
        double least = 0, most = 0;
        cv::minMaxLoc(pair.picture(place).reshape(1), &least, &most);
        if (least < 2 || most > 253) continue;
        const double code = cv::mean(green(place))[0];
        const Block known{code, cv::norm(gx(place)) + cv::norm(gy(place)), 0, {}, {}};
        Bin& bin = bins[static_cast<std::size_t>(code / kBinWidth)];
        bin.single.push_back(block(green(place), inner, known));
        const Motion* motion = pair.Nearest(cv::Point2f(place.tl() + place.br()) * 0.5F, 40);
        if (motion == nullptr) continue;
        const cv::Point by(motion->by);
        const cv::Point2f part = motion->by - cv::Point2f(by);
        if (std::abs(part.x) > 0.125F || std::abs(part.y) > 0.125F || ((place + by) & whole) != place + by) continue;
        bin.aligned.push_back(block((green(place) - next(place + by)) / std::sqrt(2.0), inner, known));
      }
    }
  }
  NoiseStatistics out;
  std::array<double, 2> products{}, parity{};
  double sum = 0;
  for (const Bin& bin : bins) {
    const std::vector<Block> single = Flattest(bin.single, 20), aligned = Flattest(bin.aligned, 4);
    if (single.empty()) continue;
    const double alone = Median(single, &Block::sigma),
                 together = aligned.empty() ? alone : Median(aligned, &Block::sigma);
    out.levels.push_back({Median(single, &Block::mean), std::min(alone, together), single.size() + aligned.size()});
    if (out.levels.back().code < 40) continue;
    for (const Block& b : single) {
      for (const std::size_t i : {0, 1}) parity[i] += b.parity[i] / std::max(0.05, b.parity[0] + b.parity[1]);
    }
    for (const Block& b : aligned) {  // each counts the same
      const cv::Mat& r = b.residual;
      const double squares = r.dot(r), weight = 1 / std::max(0.05, squares) * kBlock / (kBlock - 1);
      products[0] += weight * r.colRange(1, kBlock).dot(r.colRange(0, kBlock - 1));
      products[1] += weight * r.rowRange(1, kBlock).dot(r.rowRange(0, kBlock - 1));
      sum += weight * squares * (kBlock - 1) / kBlock;
    }
    out.blocks += aligned.size();
  }
  if (sum > 0) out.correlation = {products[0] / sum, products[1] / sum};
  if (parity[1] > 0) out.lattice = parity[0] / parity[1];
  return out;
}

std::vector<Edge> FindEdges(const cv::Mat& picture) {
  const cv::Mat grey = Grey(picture);
  std::vector<Edge> edges;
  for (const bool in_column : {false, true}) {
    const cv::Mat along = in_column ? cv::Mat(grey.t()) : grey;
    cv::Mat across;
    cv::Sobel(along, across, CV_32F, 0, 1, 3, 1.0 / 8);
    for (int y = 5; y < along.rows - 5; y += 3) FindInRow(along, across, y, in_column, edges);
  }
  return edges;
}

std::vector<Motion> MeasureMotion(const cv::Mat& picture, const cv::Mat& next) {
  constexpr int kHalf = 24, kReach = 32, kMargin = kHalf + kReach;
  const cv::Mat from = Grey(picture), to = Grey(next);
  std::vector<Motion> motions;
  for (int y = kMargin; y + kMargin < from.rows; y += 40) {
    for (int x = kMargin; x + kMargin < from.cols; x += 40) {
      const cv::Mat patch = from(cv::Rect(x - kHalf, y - kHalf, 2 * kHalf + 1, 2 * kHalf + 1));
      cv::Scalar mean, sigma;
      cv::meanStdDev(patch, mean, sigma);
      if (sigma[0] < 8) continue;
      cv::Mat score;
      cv::matchTemplate(to(cv::Rect(x - kMargin, y - kMargin, 2 * kMargin + 1, 2 * kMargin + 1)), patch, score,
                        cv::TM_CCOEFF_NORMED);
      cv::Point best;
      double peak = 0;
      cv::minMaxLoc(score, nullptr, &peak, nullptr, &best);
      if (peak < 0.9 || best.x == 0 || best.y == 0 || best.x == 2 * kReach || best.y == 2 * kReach) continue;
      const auto refine = [&](cv::Point step) {  // by a parabola
        const double before = double{score.at<float>(best - step)}, after = double{score.at<float>(best + step)};
        return static_cast<float>(0.5 * (before - after) / std::min(-1e-9, before + after - 2 * peak));
      };
      const cv::Point2f by(static_cast<float>(best.x - kReach) + refine({1, 0}),
                           static_cast<float>(best.y - kReach) + refine({0, 1}));
      motions.push_back({cv::Point2f(static_cast<float>(x), static_cast<float>(y)), by});
    }
  }
  return motions;
}

}  // namespace vobench
