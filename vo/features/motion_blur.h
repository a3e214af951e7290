// Relative motion blur of two views of a patch, equalised for comparison.
// Source:  docs/algorithm.md, section 7.4.
// Units:   pixels.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "vo/features/patch.h"

namespace vo {

// Blur by motion in which two views differ. A streak s, the displacement in the image during the exposure, has the
// second moments s s' / 12. Those of the present view less those of the first have one eigenvalue that is not negative,
// and one that is not positive: their streaks. The first view blurred along the one, the present view along the other
// are alike.
struct RelativeBlur {
  Eigen::Vector2d of_patch = Eigen::Vector2d::Zero(), of_image = Eigen::Vector2d::Zero();  // [px] in the present image

  static RelativeBlur Of(const Eigen::Vector2d& first, const Eigen::Vector2d& now);
};

// Samples whose mean is the blur along `streak`: one per pixel; a single one below 0.7 px.
class BlurSamples {
 public:
  static constexpr int kMost = 32;
  explicit BlurSamples(const Eigen::Vector2d& streak)
      : streak_(streak), count_(std::clamp(static_cast<int>(std::ceil(streak.norm() + 0.3)), 1, kMost)) {}
  int count() const { return count_; }
  Eigen::Vector2d offset(int k) const { return ((k + 0.5) / count_ - 0.5) * streak_; }

 private:
  Eigen::Vector2d streak_;
  int count_;
};

// `streak`: in pixels of the patch, cut to 32. Beyond its edge the patch is constant.
Patch Blurred(const Patch& patch, const Eigen::Vector2d& streak);
// The same along a `streak` in the present image. `warp`: as of Register. None where the patch serves as it is: the
// streak is a single sample, or the warp is not inverted.
std::optional<Patch> BlurredInView(const Patch& patch, const Eigen::Matrix2d& warp, const Eigen::Vector2d& streak);

}  // namespace vo
