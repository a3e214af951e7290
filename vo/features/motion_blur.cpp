#include "vo/features/motion_blur.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <array>

#include "vo/base/instruction_set.h"
#include "vo/base/vectors.h"

namespace vo {
namespace {

constexpr int kReach = BlurSamples::kMost / 2 + 1;  // of a streak from its middle
constexpr int kSpan = 2 * kReach + 1;
constexpr int kLanes = 8;
constexpr int kVectors = (Patch::kSide + kLanes - 1) / kLanes;  // of a row
constexpr int kWide = 2 * kReach + kVectors * kLanes;
constexpr float kToInteger = 0.5F;  // rounds where the fraction is cut off

using Floats = Vector<float, kLanes>;

using WidePatch = std::array<std::array<float, kWide>, Patch::kSide>;  // its first and last column repeated

struct Tap {
  int x, y;
  float weight;
};

// Streak as a filter: the bilinear weights of its samples, pixel by pixel.
class StreakFilter {
 public:
  explicit StreakFilter(const Eigen::Vector2d& streak) {
    const BlurSamples samples(streak);
    const float scale = 1.0F / static_cast<float>(samples.count());
    std::array<std::array<float, kSpan + 1>, kSpan + 1> weights{};
    for (int k = 0; k < samples.count(); ++k) {
      const Eigen::Vector2d at = samples.offset(k) + Eigen::Vector2d::Constant(kReach);
      const auto left = static_cast<std::size_t>(at.x()), top = static_cast<std::size_t>(at.y());
      const float fx = static_cast<float>(at.x()) - static_cast<float>(left);
      const float fy = static_cast<float>(at.y()) - static_cast<float>(top);
      weights[top][left] += scale * (1 - fy) * (1 - fx);
      weights[top][left + 1] += scale * (1 - fy) * fx;
      weights[top + 1][left] += scale * fy * (1 - fx);
      weights[top + 1][left + 1] += scale * fy * fx;
    }
    const int reach_x = static_cast<int>(std::abs(streak.x()) / 2) + 1,
              reach_y = static_cast<int>(std::abs(streak.y()) / 2) + 1;
    for (int y = -reach_y; y <= reach_y; ++y)
      for (int x = -reach_x; x <= reach_x; ++x) {
        const float weight = weights[static_cast<std::size_t>(y + kReach)][static_cast<std::size_t>(x + kReach)];
        if (weight > 0) taps_[static_cast<std::size_t>(count_++)] = {x, y, weight};
      }
  }
  const Tap* begin() const { return taps_.data(); }
  const Tap* end() const { return taps_.data() + count_; }

 private:
  std::array<Tap, std::size_t{4} * BlurSamples::kMost> taps_;
  int count_ = 0;
};

[[gnu::always_inline]] inline void Filter(const WidePatch& wide, const StreakFilter& filter, Patch& blurred) {
  for (int y = 0; y < Patch::kSide; ++y) {
    Floats sum[kVectors] = {};
    for (const Tap& tap : filter) {
      const float* row = wide[static_cast<std::size_t>(std::clamp(y + tap.y, 0, Patch::kSide - 1))].data();
#pragma GCC unroll 5
      for (int v = 0; v < kVectors; ++v) {
        sum[v] += tap.weight * Load<Floats>(row + kReach + tap.x + v * kLanes);
      }
    }
    std::array<float, std::size_t{kVectors} * kLanes> means;
    Store(sum, means.data());
    std::uint8_t* const out = blurred.grey.data() + std::ptrdiff_t{y} * Patch::kSide;
    for (int x = 0; x < Patch::kSide; ++x)
      out[x] = static_cast<std::uint8_t>(means[static_cast<std::size_t>(x)] + kToInteger);
  }
}

#ifdef __x86_64__
[[gnu::target("avx2")]] void FilterByAvx2(const WidePatch& wide, const StreakFilter& filter, Patch& blurred) {
  Filter(wide, filter, blurred);
}
#endif

}  // namespace

RelativeBlur RelativeBlur::Of(const Eigen::Vector2d& first, const Eigen::Vector2d& now) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> moments;
  moments.computeDirect(now * now.transpose() - first * first.transpose());
  const Eigen::Vector2d streaks = moments.eigenvalues().cwiseAbs().cwiseSqrt();
  return {streaks[1] * moments.eigenvectors().col(1), streaks[0] * moments.eigenvectors().col(0)};
}

Patch Blurred(const Patch& patch, const Eigen::Vector2d& streak) {
  const StreakFilter filter(streak * std::min(1.0, BlurSamples::kMost / streak.norm()));
  WidePatch wide;
  for (std::size_t y = 0; y < Patch::kSide; ++y) {
    const std::uint8_t* const row = patch.grey.data() + y * Patch::kSide;
    std::fill_n(wide[y].begin(), kReach, row[0]);
    std::copy_n(row, Patch::kSide, wide[y].begin() + kReach);
    std::fill(wide[y].begin() + kReach + Patch::kSide, wide[y].end(), row[Patch::kSide - 1]);
  }
  Patch blurred;
#ifdef __x86_64__
  if (BestInstructionSet() != InstructionSet::base) {
    FilterByAvx2(wide, filter, blurred);
    return blurred;
  }
#endif
  Filter(wide, filter, blurred);
  return blurred;
}

std::optional<Patch> BlurredInView(const Patch& patch, const Eigen::Matrix2d& warp, const Eigen::Vector2d& streak) {
  if (!(std::abs(warp.determinant()) > kLeastWarp)) return std::nullopt;
  const Eigen::Vector2d in_patch = warp.inverse() * streak;
  if (BlurSamples(in_patch).count() == 1) return std::nullopt;
  return Blurred(patch, in_patch);
}

}  // namespace vo
