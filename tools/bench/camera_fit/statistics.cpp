#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/bench/camera_fit/camera_fit.h"

namespace vobench {
namespace {

constexpr int kBlock = 16, kMargin = 6, kBinWidth = 20;

struct Block {
  double mean, structure, sigma;
  cv::Mat residual;  // beside a Gaussian of 2 px
};

// The flattest share of them, 20 at least; none where there are fewer.
std::vector<Block> Flattest(std::vector<Block> blocks, std::size_t one_of) {
  const std::size_t wanted = std::max<std::size_t>(20, blocks.size() / one_of);
  if (wanted > blocks.size()) return {};
  std::ranges::nth_element(blocks, blocks.begin() + static_cast<std::ptrdiff_t>(wanted) - 1, {}, &Block::structure);
  blocks.resize(wanted);
  return blocks;
}

template <class T>
double Median(const std::vector<T>& items, double T::*member) {
  std::vector<double> values;
  for (const T& item : items) values.push_back(item.*member);
  return Quantile(values, 0.5);
}

cv::Mat GreenAsFloat(const cv::Mat& picture) {
  cv::Mat green;
  cv::extractChannel(picture, green, picture.channels() / 2);
  green.convertTo(green, CV_32F);
  return green;
}

// `picture` has kMargin pixels around the block.
Block MakeBlock(const cv::Mat& picture, double code, double structure) {
  static const cv::Mat kSecond = (cv::Mat_<float>(3, 3) << 1, -2, 1, -2, 4, -2, 1, -2, 1) / 6;
  const cv::Rect inner(kMargin, kMargin, kBlock, kBlock);
  cv::Mat low, high;
  cv::GaussianBlur(picture, low, {}, 2);
  cv::filter2D(picture, high, -1, kSecond);
  cv::Scalar mean, sigma;
  cv::meanStdDev(high(inner), mean, sigma);
  const cv::Mat residual = (picture - low)(inner);
  return {code, structure, sigma[0], residual - cv::mean(residual)};
}

// Position where a rising profile first reaches a value.
using Profile = std::array<double, 17>;
double Crossing(const Profile& profile, double value) {
  std::size_t i = 1;
  while (i < 16 && profile[i] < value) ++i;
  return static_cast<double>(i) - (profile[i] - value) / std::max(profile[i] - std::min(profile[i - 1], value), 1e-9);
}

double At(const Profile& profile, double place) {
  const auto i = static_cast<std::size_t>(std::clamp(place, 0.0, 15.0));
  return std::lerp(profile[i], profile[i + 1], place - static_cast<double>(i));
}

void FindInRow(const cv::Mat& grey, int y, bool in_column, std::vector<Edge>& edges) {
  const auto* row = grey.ptr<std::uint8_t>(y);
  const auto step_at = [&](int x) { return std::abs(row[x + 1] - row[x - 1]); };
  for (int x = 14; x <= grey.cols - 15; ++x) {
    if (step_at(x) <= 45 || step_at(x) < std::max(step_at(x - 1), step_at(x + 1))) continue;
    cv::Scalar left, right, left_sigma, right_sigma;
    cv::meanStdDev(grey(cv::Rect(x - 12, y, 6, 1)), left, left_sigma);
    cv::meanStdDev(grey(cv::Rect(x + 7, y, 6, 1)), right, right_sigma);
    const double low = std::min(left[0], right[0]), high = std::max(left[0], right[0]);
    if (left_sigma[0] > 2.5 || right_sigma[0] > 2.5 || low < 15 || high > 235 || high - low < 60) continue;
    Profile p{}, rising{};
    for (int i = 0; i < 17; ++i) p[static_cast<std::size_t>(i)] = (row[x - 8 + i] - left[0]) / (right[0] - left[0]);
    if (*std::ranges::max_element(p) > 1.6 || *std::ranges::min_element(p) < -0.6) continue;
    for (std::size_t i = 0; i < 17; ++i) rising[i] = std::max(p[i], i > 0 ? rising[i - 1] : p[i]);
    const double middle = Crossing(rising, 0.5), gy = grey.at<std::uint8_t>(y + 1, x) - grey.at<std::uint8_t>(y - 1, x);
    Edge edge{cv::Point2f(cv::Point(x, y)), in_column, gy / (row[x + 1] - row[x - 1]), 0, 0, 0};
    if (in_column) std::swap(edge.at.x, edge.at.y);
    edge.width = Crossing(rising, 0.9) - Crossing(rising, 0.1);
    for (const double d : {1.5, 2.0, 2.5, 3.0})
      edge.bright += (At(p, middle + d) - 1) / 4, edge.dark -= At(p, middle - d) / 4;
    if (right[0] < left[0]) std::swap(edge.bright, edge.dark);
    edges.push_back(edge);
  }
}

}  // namespace

double Quantile(std::vector<double> values, double p) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(p * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
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

Pair MakePair(const cv::Mat& picture, const cv::Mat& next) {
  constexpr int kHalf = 24, kReach = 32, kMost = kHalf + kReach;
  const cv::Mat from = Grey(picture), to = Grey(next);
  Pair pair{picture, next, {}};
  for (int y = kMost; y + kMost < from.rows; y += 40) {
    for (int x = kMost; x + kMost < from.cols; x += 40) {
      const auto around = [&](const cv::Mat& m, int r) { return m(cv::Rect(x - r, y - r, 2 * r + 1, 2 * r + 1)); };
      cv::Mat score;
      cv::matchTemplate(around(to, kMost), around(from, kHalf), score, cv::TM_CCOEFF_NORMED);
      cv::Point best;
      double peak = 0;
      cv::minMaxLoc(score, nullptr, &peak, nullptr, &best);
      if (peak < 0.9 || best.x == 0 || best.y == 0 || best.x == 2 * kReach || best.y == 2 * kReach) continue;
      const auto refine = [&](cv::Point step) {  // by a parabola
        const double before = double{score.at<float>(best - step)}, after = double{score.at<float>(best + step)};
        return static_cast<float>(0.5 * (before - after) / std::min(-1e-9, before + after - 2 * peak));
      };
      const cv::Point2f whole(best - cv::Point(kReach, kReach));
      pair.motions.push_back({cv::Point2f(cv::Point(x, y)), whole + cv::Point2f(refine({1, 0}), refine({0, 1}))});
    }
  }
  return pair;
}

NoiseStatistics MeasureNoise(std::span<const Pair> pairs) {
  std::array<std::vector<Block>, 256 / kBinWidth + 1> singles, aligneds;
  for (const Pair& pair : pairs) {
    const cv::Mat green = GreenAsFloat(pair.picture), next = GreenAsFloat(pair.next);
    cv::Mat low, gx, gy;
    cv::GaussianBlur(green, low, {}, 2);
    cv::Sobel(low, gx, CV_32F, 1, 0), cv::Sobel(low, gy, CV_32F, 0, 1);
    for (int y = kBlock; y + 2 * kBlock <= green.rows; y += kBlock) {
      for (int x = kBlock; x + 2 * kBlock <= green.cols; x += kBlock) {
        const cv::Rect place(x - kMargin, y - kMargin, kBlock + 2 * kMargin, kBlock + 2 * kMargin);
        if (!cv::checkRange(pair.picture(place), true, nullptr, 2, 254)) continue;  // clipped
        const double code = cv::mean(green(place))[0], structure = cv::norm(gx(place)) + cv::norm(gy(place));
        const auto bin = static_cast<std::size_t>(code / kBinWidth);
        singles[bin].push_back(MakeBlock(green(place), code, structure));
        const Motion* motion = pair.Nearest(cv::Point2f(place.tl() + place.br()) * 0.5F, 40);
        if (motion == nullptr) continue;
        const cv::Point by(motion->by);
        const bool whole = cv::norm(motion->by - cv::Point2f(by)) < 0.15;
        if (!whole || ((place + by) & cv::Rect({}, green.size())) != place + by) continue;
        aligneds[bin].push_back(MakeBlock((green(place) - next(place + by)) / std::sqrt(2.0), code, structure));
      }
    }
  }
  NoiseStatistics out;
  std::array<double, 2> products{}, parity{};
  double sum = 0;
  for (std::size_t bin = 0; bin < singles.size(); ++bin) {
    const std::vector<Block> single = Flattest(singles[bin], 20), aligned = Flattest(aligneds[bin], 4);
    if (single.empty()) continue;
    const double alone = Median(single, &Block::sigma), both = aligned.empty() ? alone : Median(aligned, &Block::sigma);
    out.levels.push_back({Median(single, &Block::mean), std::min(alone, both), single.size() + aligned.size()});
    if (out.levels.back().code < 40) continue;
    for (const Block& block : single) {
      const double squares = std::max(0.05, block.residual.dot(block.residual));
      for (int i = 0; i < kBlock * kBlock; ++i)
        parity[static_cast<std::size_t>(i / kBlock + i) % 2] +=
            std::pow(block.residual.at<float>(i / kBlock, i % kBlock), 2) / squares;
    }
    for (const Block& block : aligned) {  // each counts the same
      const cv::Mat& r = block.residual;
      const double squares = std::max(0.05, r.dot(r)) * (kBlock - 1) / kBlock;
      products[0] += r.colRange(1, kBlock).dot(r.colRange(0, kBlock - 1)) / squares;
      products[1] += r.rowRange(1, kBlock).dot(r.rowRange(0, kBlock - 1)) / squares;
    }
    sum += static_cast<double>(aligned.size());
  }
  out.blocks = static_cast<std::size_t>(sum);
  if (sum > 0) out.correlation = {products[0] / sum, products[1] / sum};
  if (parity[1] > 0) out.lattice = parity[0] / parity[1];
  return out;
}

std::vector<Edge> FindEdges(const cv::Mat& picture) {
  const cv::Mat grey = Grey(picture), turned = grey.t();
  std::vector<Edge> edges;
  for (int y = 5; y < grey.rows - 5; y += 3) FindInRow(grey, y, false, edges);
  for (int x = 5; x < turned.rows - 5; x += 3) FindInRow(turned, x, true, edges);
  return edges;
}

EdgeStatistics Summarise(std::vector<Edge> edges) {
  EdgeStatistics out{edges.size(), Median(edges, &Edge::width), 0, 0};
  std::erase_if(edges, [&](const Edge& edge) { return edge.width > out.width; });
  out.bright = Median(edges, &Edge::bright), out.dark = Median(edges, &Edge::dark);
  std::erase_if(edges, [&](const Edge& edge) {
    return std::max(std::abs(edge.bright - out.bright), std::abs(edge.dark - out.dark)) > 0.06;
  });
  out.width = Median(edges, &Edge::width);
  return out;
}

}  // namespace vobench
