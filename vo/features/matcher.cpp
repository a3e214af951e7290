#include "vo/features/matcher.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vo/features/motion_blur.h"

namespace vo {
namespace {

constexpr double kMaxRefinementPx = 1.5;  // beyond it the registration has left the matched corner
constexpr double kMinCorrelation = 0.6;
constexpr double kMaxZoom = 4;         // a larger predicted change of scale is ignored
constexpr double kSearchSigmas = 2.5;  // half-width of the uncertainty ellipse that is searched
constexpr double kDescribed_px = 2.5;  // streak that changes the descriptor
constexpr double kOfStreak = 0.05;     // sigma along a streak, of its length
constexpr int kPrefetched_px = 20;     // of the next search
constexpr double kMaxPx = 1 << 16;     // no image is wider

Eigen::Vector2i Rounded(const Eigen::Vector2d& p) {
  const auto rounded = [](double x) { return static_cast<int>(std::lround(std::clamp(x, -kMaxPx, kMaxPx))); };
  return {rounded(p.x()), rounded(p.y())};
}

// Map of BRISK's pattern from scale 1 to the present image.
Eigen::Matrix2d PatternMap(const Eigen::Matrix2d& warp, const FeatureParams& params) {
  const double scale = params.brisk_size_px / kBriskBasicDiameter;
  const double determinant = warp.determinant();
  const bool usable = determinant > 1 / (kMaxZoom * kMaxZoom) && determinant < kMaxZoom * kMaxZoom;
  if (params.brisk_warp == BriskWarp::none || !usable) return scale * Eigen::Matrix2d::Identity();
  if (params.brisk_warp == BriskWarp::affine) return scale * warp;
  const double angle = std::atan2(warp(1, 0) - warp(0, 1), warp(0, 0) + warp(1, 1));
  return scale * std::sqrt(determinant) * Eigen::Rotation2Dd(angle).toRotationMatrix();
}

// Side of the largest window: by the innovation covariance, up to the limit of the request or of the settings.
int LargestWindow(const SearchRequest& request, const FeatureParams& params) {
  return std::min(WindowSide(request.S), request.widest_px.value_or(params.search_uncertain_px));
}

// Pixels of the window by rows. A window beyond search_wide_px is clipped to the ellipse of kSearchSigmas about the
// prediction, which is mostly long and thin.
void SearchRegion(const SearchRequest& request, int side, const FeatureParams& params, std::vector<PixelRun>& region) {
  const Eigen::Vector2i centre = Rounded(request.predicted);
  const int half = side / 2;
  const Eigen::Matrix2d information = request.S.inverse() / (kSearchSigmas * kSearchSigmas);
  region.clear();
  for (int dy = -half; dy <= half; ++dy) {
    int first = -half, last = half;
    if (side > params.search_wide_px) {  // a dx^2 + 2 b dx + c <= 0
      const double a = information(0, 0), b = information(0, 1) * dy, c = information(1, 1) * dy * dy - 1;
      const double discriminant = b * b - a * c;
      if (discriminant < 0) continue;
      // Clamped to the window before the cast; the order of arguments absorbs NaN (0 / 0: a degenerate ellipse).
      const double beyond = half + 1, root = std::sqrt(discriminant);
      first = static_cast<int>(std::min(beyond, std::max<double>(first, std::floor((-b - root) / a))));
      last = static_cast<int>(std::max(-beyond, std::min<double>(last, std::ceil((-b + root) / a))));
      if (first > last) continue;
    }
    region.push_back({centre.y() + dy, centre.x() + first, centre.x() + last});
  }
}

Descriptor DescriptorOf(Patch& patch, const BriskSampler& sampler) {
  BriskImage image;
  image.Set(cv::Mat(Patch::kSide, Patch::kSide, CV_8UC1, patch.grey.data()));
  return image.Describe({Patch::kRadius, Patch::kRadius}, sampler);
}

// First view blurred along `streak` [px of the present image]; none where the unblurred one is used.
std::optional<Appearance> AtBlur(const SearchRequest& request, const Eigen::Vector2d& streak,
                                 const BriskSampler& sampler) {
  const std::optional<Patch> patch = BlurredInView(request.appearance->patch, request.warp, streak);
  if (!patch) return std::nullopt;
  Appearance blurred{request.appearance->descriptor, *patch};
  if (streak.norm() > kDescribed_px && sampler.margin() <= Patch::kRadius)
    blurred.descriptor = DescriptorOf(blurred.patch, sampler);
  return blurred;
}

// Covariance of a blurred match: its streak is neither uniform nor straight, and is a prediction.
Eigen::Matrix2d OfBlur(const Eigen::Vector2d& streak) { return kOfStreak * kOfStreak * streak * streak.transpose(); }

bool OnBorder(const Eigen::Vector2i& pixel, const Eigen::Vector2i& centre, int side) {
  return (pixel - centre).cwiseAbs().maxCoeff() == side / 2;
}

}  // namespace

int WindowSide(const Eigen::Matrix2d& S) {
  const double half = std::ceil(kSearchSigmas * std::sqrt(std::max(S(0, 0), S(1, 1))));
  return 2 * static_cast<int>(std::min(kMaxPx, half)) + 1;
}

BriskSampler FirstSampler(const FeatureParams& params) {
  return BriskSampler(PatternMap(Eigen::Matrix2d::Identity(), params));
}

std::vector<SearchResult> FindFeatures(const std::vector<SearchRequest>& requests, const cv::Mat& smooth,
                                       const BriskImage& brisk, const FeatureParams& params, double exposure_s) {
  const int max_distance = static_cast<int>(std::lround(params.max_hamming * kBriskPairs));
  const Eigen::Matrix2d constant = params.sigma_px * params.sigma_px * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d floor = params.sigma_floor_px * params.sigma_floor_px * Eigen::Matrix2d::Identity();
  const BriskSampler first = FirstSampler(params);
  std::vector<SearchResult> results(requests.size());
  std::vector<PixelRun> region;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const SearchRequest& request = requests[i];
    if (i + 1 < requests.size()) brisk.Prefetch(Rounded(requests[i + 1].predicted), kPrefetched_px);
    std::optional<FoundFeature>& found = results[i].found;
    const BriskSampler sampler(PatternMap(request.warp, params));
    results[i].in_sight = brisk.Describable(Rounded(request.predicted), sampler);
    const RelativeBlur blur = RelativeBlur::Of(exposure_s * request.first_rate, exposure_s * request.rate);
    const std::optional<Appearance> at_blur = AtBlur(request, blur.of_patch, first);
    const Appearance& view = at_blur ? *at_blur : *request.appearance;
    int searched = 0;
    for (const int wanted :
         {params.search_first_px, params.search_normal_px, params.search_wide_px, LargestWindow(request, params)}) {
      const int side = request.widest_px ? std::min(wanted, *request.widest_px) : wanted;
      if (side <= searched) continue;
      const bool quick = searched == 0 && side < params.search_normal_px;
      searched = side;
      SearchRegion(request, side, params, region);
      const auto best = brisk.Nearest(view.descriptor, sampler, region);
      if (!best || best->distance >= max_distance || (quick && OnBorder(best->pixel, Rounded(request.predicted), side)))
        continue;
      found = {best->pixel.cast<double>(), constant};
      break;
    }
    if (!found || !params.subpixel) continue;
    const auto refined = Register(view.patch, request.warp, smooth, found->pixel, kMaxRefinementPx, blur.of_image);
    if (!refined || refined->correlation <= kMinCorrelation) continue;
    found->pixel = refined->pixel;
    if (params.noise == MatchNoise::constant) continue;
    found->noise = floor + params.noise_inflation * refined->covariance + OfBlur(exposure_s * request.first_rate) +
                   OfBlur(exposure_s * request.rate);
  }
  return results;
}

}  // namespace vo
