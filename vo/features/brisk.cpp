#include "vo/features/brisk.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

// Vectors are passed to functions that are inlined without exception: no ABI is involved.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace vo {
namespace {

constexpr int kLanes = 8;    // pixels sampled at once; rows of a window are padded to a multiple of it
constexpr int kPad = kLanes;  // columns behind the image that may be read, for nothing

template <class T, int Bytes>
struct VectorOf {
  typedef T type __attribute__((vector_size(Bytes)));
};
using Int8Lanes = VectorOf<std::int32_t, 4 * kLanes>::type;
using Float8Lanes = VectorOf<float, 4 * kLanes>::type;

template <class Vector>
[[gnu::always_inline]] inline Vector Load(const void* from) {
  Vector v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

[[gnu::always_inline]] inline Int8Lanes Widen(const std::uint8_t* from) {
  typedef std::uint8_t Bytes __attribute__((vector_size(kLanes)));
  return __builtin_convertvector(Load<Bytes>(from), Int8Lanes);
}

// Mean grey over the box at eight neighbouring pixels, of which `grey` and `sum` are the first's corner (left, top) in image and
// integral image: sums weighted in fixed point, divided with rounding. In 256ths of a grey level, below 65536.
[[gnu::always_inline]] inline Int8Lanes Mean(const BriskSampler::Box& box, const std::uint8_t* grey, std::size_t grey_step,
                                             const std::int32_t* sum, std::size_t sum_step) {
  const std::uint8_t* below = grey + static_cast<std::size_t>(box.height + 1) * grey_step;
  Int8Lanes total = box.corner_00 * Widen(grey) + box.corner_10 * Widen(grey + box.width + 1) +
                    box.corner_11 * Widen(below + box.width + 1) + box.corner_01 * Widen(below);
  // Rows of the integral image above and below the upper edge, and above and below the lower one; four columns likewise.
  const std::int32_t* r0 = sum;
  const std::int32_t* r1 = r0 + sum_step;
  const std::int32_t* r2 = r1 + static_cast<std::size_t>(box.height) * sum_step;
  const std::int32_t* r3 = r2 + sum_step;
  const int c1 = 1, c2 = 1 + box.width, c3 = 2 + box.width;
  const Int8Lanes i11 = Load<Int8Lanes>(r1 + c1), i12 = Load<Int8Lanes>(r1 + c2);
  const Int8Lanes i21 = Load<Int8Lanes>(r2 + c1), i22 = Load<Int8Lanes>(r2 + c2);
  total += box.edge_top * (i12 - i11 - Load<Int8Lanes>(r0 + c2) + Load<Int8Lanes>(r0 + c1));
  total += box.edge_bottom * (Load<Int8Lanes>(r3 + c2) - Load<Int8Lanes>(r3 + c1) - i22 + i21);
  total += box.edge_left * (i21 - i11 - Load<Int8Lanes>(r2) + Load<Int8Lanes>(r1));
  total += box.edge_right * (Load<Int8Lanes>(r2 + c3) - Load<Int8Lanes>(r1 + c3) - i22 + i12);
  total += box.inside * (i22 - i21 - i12 + i11);
  total += box.total / 2;
  // total / box.total, rounded down exactly: the quotient in floating point is off by one at most.
  Int8Lanes quotient = __builtin_convertvector(__builtin_convertvector(total, Float8Lanes) * (1.0f / static_cast<float>(box.total)), Int8Lanes);
  const Int8Lanes rest = total - quotient * box.total;
  quotient += (rest < 0) - (rest >= box.total);
  return quotient;
}

struct Window {
  const std::uint8_t* grey;     // of the window's first pixel
  const std::int32_t* sum;
  std::size_t grey_step, sum_step;
  int width, height;
  int stride() const { return (width + kLanes - 1) / kLanes * kLanes; }
};

// samples[point][pixel of the padded window], less 32768.
[[gnu::always_inline]] inline void Sample(const Window& window, const BriskSampler& sampler, int pixels, std::int16_t* samples) {
  const int stride = window.stride();
  for (int n = 0; n < kBriskPoints; ++n) {
    const BriskSampler::Box& box = sampler.boxes()[static_cast<std::size_t>(n)];
    std::int16_t* out = samples + static_cast<std::ptrdiff_t>(n) * pixels;
    for (int y = 0; y < window.height; ++y) {
      const std::uint8_t* grey = window.grey + (y + box.top) * static_cast<std::ptrdiff_t>(window.grey_step) + box.left;
      const std::int32_t* sum = window.sum + (y + box.top) * static_cast<std::ptrdiff_t>(window.sum_step) + box.left;
      for (int x = 0; x < stride; x += kLanes) {
        typedef std::int16_t Words __attribute__((vector_size(2 * kLanes)));
        const Words mean =
            __builtin_convertvector(Mean(box, grey + x, window.grey_step, sum + x, window.sum_step) - 32768, Words);
        std::memcpy(out + y * stride + x, &mean, sizeof mean);
      }
    }
  }
}

// Comparisons for `Width` pixels at a time: a comparison is 0 or -1 per pixel, and differs from the wanted bit (0 or -1) by -1.
template <int Width>
[[gnu::always_inline]] inline void Compare(const std::int16_t* samples, int pixels, const std::int16_t* wanted, std::uint16_t* distances) {
  using Words = typename VectorOf<std::int16_t, 2 * Width>::type;
  const auto& pairs = BriskComparisons();
  for (int at = 0; at < pixels; at += Width) {
    Words count = {};
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const Words a = Load<Words>(samples + static_cast<std::ptrdiff_t>(pairs[k].first) * pixels + at);
      const Words b = Load<Words>(samples + static_cast<std::ptrdiff_t>(pairs[k].second) * pixels + at);
      count -= static_cast<Words>(a > b) ^ wanted[k];
    }
    std::memcpy(distances + at, &count, sizeof count);
  }
}

using Kernel = void (*)(const Window&, const BriskSampler&, const std::int16_t* wanted, int pixels, std::int16_t* samples, std::uint16_t* distances);

void BaseKernel(const Window& window, const BriskSampler& sampler, const std::int16_t* wanted, int pixels, std::int16_t* samples,
                std::uint16_t* distances) {
  Sample(window, sampler, pixels, samples);
  Compare<8>(samples, pixels, wanted, distances);
}

#ifdef __x86_64__
[[gnu::target("avx2")]] void Avx2Kernel(const Window& window, const BriskSampler& sampler, const std::int16_t* wanted, int pixels,
                                        std::int16_t* samples, std::uint16_t* distances) {
  Sample(window, sampler, pixels, samples);
  Compare<16>(samples, pixels, wanted, distances);
}

[[gnu::target("avx2,avx512f,avx512bw,avx512dq,avx512vl")]] void Avx512Kernel(const Window& window, const BriskSampler& sampler,
                                                                             const std::int16_t* wanted, int pixels, std::int16_t* samples,
                                                                             std::uint16_t* distances) {
  Sample(window, sampler, pixels, samples);
  Compare<32>(samples, pixels, wanted, distances);
}
#endif

Kernel KernelFor(InstructionSet set) {
#ifdef __x86_64__
  if (set == InstructionSet::avx512) return Avx512Kernel;
  if (set == InstructionSet::avx2) return Avx2Kernel;
#endif
  static_cast<void>(set);
  return BaseKernel;
}

}  // namespace

BriskSampler::BriskSampler(const Eigen::Matrix2d& map) {
  const double scale = std::sqrt(std::abs(map.determinant()));
  const auto& pattern = BriskPattern();
  for (std::size_t n = 0; n < pattern.size(); ++n) {
    const Eigen::Vector2d place = map * Eigen::Vector2d(pattern[n].x, pattern[n].y);
    const float half = std::max(0.5f, static_cast<float>(scale * pattern[n].half_width));
    const float area = 4.0f * half * half;
    Box& box = boxes_[n];
    box.inside = static_cast<int>(4194304.0 / area);
    box.total = 4 * static_cast<int>(static_cast<float>(box.inside) * area / 1024.0);
    // Borders, the pixels they lie in, and how much of these is inside; pixels reach half a pixel to either side.
    const auto low = static_cast<float>(place.x()) - half, high = static_cast<float>(place.x()) + half;
    const auto upper = static_cast<float>(place.y()) - half, lower = static_cast<float>(place.y()) + half;
    const auto pixel = [](float v) { return static_cast<int>(std::floor(v + 0.5f)); };
    box.left = pixel(low), box.top = pixel(upper);
    box.width = pixel(high) - box.left - 1, box.height = pixel(lower) - box.top - 1;
    const float in_left = static_cast<float>(box.left) - low + 0.5f, in_top = static_cast<float>(box.top) - upper + 0.5f;
    const float in_right = high - static_cast<float>(pixel(high)) + 0.5f, in_bottom = lower - static_cast<float>(pixel(lower)) + 0.5f;
    const auto fixed = [&](float share) { return static_cast<int>(share * static_cast<float>(box.inside)); };
    box.corner_00 = fixed(in_left * in_top), box.corner_10 = fixed(in_right * in_top);
    box.corner_11 = fixed(in_right * in_bottom), box.corner_01 = fixed(in_left * in_bottom);
    box.edge_left = fixed(in_left), box.edge_top = fixed(in_top), box.edge_right = fixed(in_right), box.edge_bottom = fixed(in_bottom);
    margin_ = std::max({margin_, -box.left, -box.top, box.left + box.width + 2, box.top + box.height + 2});
  }
}

const char* Name(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx2: return "AVX2";
    case InstructionSet::avx512: return "AVX-512";
    default: return "base";
  }
}

std::vector<InstructionSet> AvailableInstructionSets() {
  std::vector<InstructionSet> sets = {InstructionSet::base};
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) sets.push_back(InstructionSet::avx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    sets.push_back(InstructionSet::avx512);
#endif
  return sets;
}

void BriskImage::Set(const cv::Mat& grey) {
  width_ = grey.cols, height_ = grey.rows;
  cv::copyMakeBorder(grey, grey_, 0, 1, 0, kPad, cv::BORDER_REPLICATE);
  cv::integral(grey_, integral_, CV_32S);
}

bool BriskImage::Describable(const Eigen::Vector2i& pixel, const BriskSampler& sampler) const {
  const int margin = sampler.margin();
  return pixel.x() >= margin && pixel.y() >= margin && pixel.x() < width_ - margin && pixel.y() < height_ - margin;
}

Descriptor BriskImage::Describe(const Eigen::Vector2i& pixel, const BriskSampler& sampler) const {
  if (!Describable(pixel, sampler)) throw std::invalid_argument("BRISK: the pixel is too near to the edge of the image");
  std::array<std::int16_t, kBriskPoints * kLanes> samples;
  Sample({grey_.ptr<std::uint8_t>(pixel.y()) + pixel.x(), integral_.ptr<std::int32_t>(pixel.y()) + pixel.x(), grey_.step1(),
          integral_.step1(), 1, 1},
         sampler, kLanes, samples.data());
  Descriptor descriptor{};
  const auto& pairs = BriskComparisons();
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (samples[std::size_t{pairs[k].first} * kLanes] > samples[std::size_t{pairs[k].second} * kLanes])
      descriptor[k / 64] |= std::uint64_t{1} << (k % 64);
  return descriptor;
}

void BriskImage::Distances(const Descriptor& descriptor, const BriskSampler& sampler, const Eigen::Vector2i& centre, int side,
                           std::vector<std::uint16_t>& distances) const {
  static const InstructionSet best = AvailableInstructionSets().back();
  Distances(best, descriptor, sampler, centre, side, distances);
}

void BriskImage::Distances(InstructionSet set, const Descriptor& descriptor, const BriskSampler& sampler, const Eigen::Vector2i& centre,
                           int side, std::vector<std::uint16_t>& distances) const {
  if (side < 1 || side % 2 == 0) throw std::invalid_argument("BRISK: the side of a window is odd");
  distances.assign(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), kNone);
  const int half = side / 2, margin = sampler.margin();
  const int left = std::max(centre.x() - half, margin), right = std::min(centre.x() + half, width_ - margin - 1);
  const int top = std::max(centre.y() - half, margin), bottom = std::min(centre.y() + half, height_ - margin - 1);
  if (left > right || top > bottom) return;
  const Window window{grey_.ptr<std::uint8_t>(top) + left, integral_.ptr<std::int32_t>(top) + left, grey_.step1(), integral_.step1(),
                      right - left + 1, bottom - top + 1};

  std::array<std::int16_t, kBriskPairs> wanted;
  for (std::size_t k = 0; k < wanted.size(); ++k) wanted[k] = descriptor[k / 64] >> (k % 64) & 1 ? -1 : 0;
  constexpr int kWidest = 32;  // of a vector, in pixels
  const int pixels = (window.stride() * window.height + kWidest - 1) / kWidest * kWidest;
  thread_local std::vector<std::int16_t> samples;
  thread_local std::vector<std::uint16_t> padded;
  samples.resize(static_cast<std::size_t>(pixels) * kBriskPoints);
  padded.resize(static_cast<std::size_t>(pixels));
  KernelFor(set)(window, sampler, wanted.data(), pixels, samples.data(), padded.data());
  for (int y = 0; y < window.height; ++y)
    std::copy_n(padded.begin() + y * window.stride(), window.width,
                distances.begin() + (top + y - (centre.y() - half)) * side + left - (centre.x() - half));
}

}  // namespace vo
