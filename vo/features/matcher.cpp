#include "vo/features/matcher.h"

#include <algorithm>
#include <cmath>

namespace vo {
namespace {

constexpr double kMaxRefinementPx = 1.5;   // further than this the registration has left the matched corner
constexpr double kMinCorrelation = 0.6;
constexpr double kLostSigmas = 2.5;        // of the prediction that the largest window should cover

Eigen::Vector2i Rounded(const Eigen::Vector2d& p) {
  return {static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))};
}

template <class Visit>
void ForEachPixel(const Eigen::Vector2i& centre, int side, Visit visit) {
  const int half = side / 2;
  for (int y = centre.y() - half; y <= centre.y() + half; ++y)
    for (int x = centre.x() - half; x <= centre.x() + half; ++x) visit(Eigen::Vector2i(x, y));
}

// The window that the prediction's own uncertainty asks for; nothing beyond the enlarged window while that is small.
int LostWindow(const Eigen::Matrix2d& S, const FeatureParams& params) {
  const double sigma = std::sqrt(std::max(S(0, 0), S(1, 1)));
  const int side = 2 * static_cast<int>(std::ceil(kLostSigmas * sigma)) + 1;
  return std::min(side, params.window_lost_px);
}

std::optional<Eigen::Vector2i> BestPixel(const SearchRequest& request, int side, const BriskField& field, int max_distance) {
  std::optional<Eigen::Vector2i> best;
  int best_distance = max_distance;
  ForEachPixel(Rounded(request.predicted), side, [&](const Eigen::Vector2i& p) {
    const Descriptor* descriptor = field.At(p);
    if (!descriptor) return;
    const int distance = HammingDistance(*descriptor, request.appearance->descriptor);
    if (distance < best_distance) {
      best_distance = distance;
      best = p;
    }
  });
  return best;
}

bool OnBorder(const Eigen::Vector2i& pixel, const Eigen::Vector2i& centre, int side) {
  return (pixel - centre).cwiseAbs().maxCoeff() == side / 2;
}

}  // namespace

std::vector<std::optional<Eigen::Vector2d>> FindFeatures(const std::vector<SearchRequest>& requests, const cv::Mat& grey,
                                                         BriskField& field, const FeatureParams& params) {
  const int max_distance = static_cast<int>(std::lround(params.max_hamming * 512));
  std::vector<std::optional<Eigen::Vector2d>> found(requests.size());
  std::vector<int> searched(requests.size(), 0);  // side of the window so far
  enum Stage { quick, window, enlarged, lost, end };
  for (int stage = quick; stage < end; ++stage) {
    const auto side_of = [&](std::size_t i) {
      switch (stage) {
        case quick: return params.window_quick_px;
        case window: return params.window_px;
        case enlarged: return params.window_enlarged_px;
        default: return LostWindow(requests[i].S, params);
      }
    };
    std::vector<std::size_t> active;
    std::vector<Eigen::Vector2i> pixels;
    for (std::size_t i = 0; i < requests.size(); ++i) {
      if (found[i] || side_of(i) <= searched[i]) continue;
      searched[i] = side_of(i);
      active.push_back(i);
      ForEachPixel(Rounded(requests[i].predicted), searched[i], [&](const Eigen::Vector2i& p) { pixels.push_back(p); });
    }
    field.Compute(pixels);
    for (const std::size_t i : active) {
      const auto pixel = BestPixel(requests[i], searched[i], field, max_distance);
      if (!pixel || (stage == quick && OnBorder(*pixel, Rounded(requests[i].predicted), searched[i]))) continue;
      found[i] = pixel->cast<double>();
    }
  }
  if (params.subpixel) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      if (!found[i]) continue;
      const auto refined = Register(requests[i].appearance->patch, requests[i].warp, grey, *found[i], kMaxRefinementPx);
      if (refined && refined->correlation > kMinCorrelation) found[i] = refined->pixel;
    }
  }
  return found;
}

}  // namespace vo
