// Heap allocations of the filter's loop: none. Calls of malloc by Eigen and the standard library are counted alike.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/unit/vo/at_once.h"
#include "vo/filter/particle_filter.h"
#include "vo/geometry/so3.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define VOBENCH_OWN_MALLOC 0  // the sanitizer has its own
#else
#define VOBENCH_OWN_MALLOC 1

namespace {
std::atomic<bool> counting{false};
std::atomic<int> allocations{0};
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void* malloc(std::size_t size) {
  if (counting) ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  if (counting) ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  if (counting) ++allocations;
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  if (counting) ++allocations;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  if (counting) ++allocations;
  *out = __libc_memalign(alignment, size);
  return *out == nullptr ? 12 : 0;
}
}
#endif

namespace {

#if VOBENCH_OWN_MALLOC
int AllocationsOfALoop(const vo::FilterParams& params, int frames) {
  constexpr int kLandmarks = 100;
  constexpr double kDt = 1.0 / 30, kSigma = 1.0 / 525;
  vo::FilterPrior prior;
  prior.velocity_covariance = 0.04 * vo::Matrix6::Identity();
  vo::ParticleFilter filter(vo::MotionParams{}, params, vo::LandmarkParams{}, prior, 1);
  const Eigen::Matrix2d R = kSigma * kSigma * Eigen::Matrix2d::Identity();
  std::vector<vo::FirstView> views;
  std::vector<vo::Match> matches;
  for (int n = 0; n < kLandmarks; ++n) {
    views.push_back({{0.5 * std::sin(1.3 * n), 0.4 * std::cos(2.1 * n)}, R});
    matches.push_back({n, views.back().ray, R});
  }
  filter.AddLandmarks(views);
  allocations = 0;
  for (int k = 0; k < frames; ++k) {
    const vo::Pose pose{Eigen::Vector3d(0.01 * k, 0.002 * k, 0), vo::Exp({0, 0.002 * k, 0})};
    for (int n = 0; n < kLandmarks; ++n) {
      const Eigen::Vector3d X =
          pose.q_WC.conjugate() *
          (views[static_cast<std::size_t>(n)].ray.homogeneous() / (0.25 + 0.05 * std::sin(0.9 * n)) - pose.p_WC);
      matches[static_cast<std::size_t>(n)].z =
          X.hnormalized() + kSigma * Eigen::Vector2d(std::sin(17.0 * n * k), std::cos(23.0 * n * k));
    }
    counting = k >= 10;  // buffers grow in the first frames
    filter.Predict(kDt);
    filter.Update(matches);
    counting = false;
  }
  return allocations;
}
#endif

// Predict and Update with resampling, which reuses the memory of the previous generation.
TEST(Allocation, TheLoopHasNone) {
#if VOBENCH_OWN_MALLOC
  for (const vo::Sampled sampled : {vo::Sampled::pose, vo::Sampled::pose_and_velocity}) {
    vo::FilterParams params = vo_test::SampledAtOnce();
    params.sampled = sampled;
    params.resample_below = 1;
    params.start_window = 0;
    EXPECT_EQ(AllocationsOfALoop(params, 40), 0);
  }
#else
  GTEST_SKIP() << "malloc belongs to the sanitizer";
#endif
}

// Control: three allocations are counted, of an object, its contents and an Eigen matrix.
TEST(Allocation, IsSeenWhereThereIsAny) {
#if VOBENCH_OWN_MALLOC
  counting = true;
  allocations = 0;
  auto* memory = new std::vector<double>(1000);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(30, static_cast<Eigen::Index>(memory->size()));
  counting = false;
  EXPECT_EQ(allocations, 3) << matrix.sum();
  delete memory;
#else
  GTEST_SKIP() << "malloc belongs to the sanitizer";
#endif
}

}  // namespace
