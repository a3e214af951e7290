#include "vo/features/brisk.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

// Vectors are passed to functions that are inlined without exception: no ABI is involved.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace vo {
namespace {

constexpr int kFraction =
    14;  // bits of a weighted sum behind 1/256 of a grey level; the weights of a box sum to 256 << kFraction
constexpr int kLanes = 8;  // pixels that are sampled at once: so many columns behind the image may be read, for nothing

template <class T, int Bytes>
struct VectorOf {
  typedef T type __attribute__((vector_size(Bytes)));
};
using Ints = VectorOf<std::int32_t, 4 * kLanes>::type;
template <int Width>
using Words = typename VectorOf<std::int16_t, 2 * Width>::type;

template <class Vector>
[[gnu::always_inline]] inline Vector Load(const void* from) {
  Vector v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

// Mean grey over the box at neighbouring pixels, of which `sum` is the first's corner (left, top) in the integral
// image: sums weighted in fixed point, rounded. In 256ths of a grey level, below 65536.
[[gnu::always_inline]] inline Ints Mean(const BriskSampler::Box& box, const std::int32_t* sum, std::size_t step) {
  // Three strips of rows: first, inside, last; in each of them the sums up to four columns.
  const std::int32_t* r0 = sum;
  const std::int32_t* r1 = r0 + step;
  const std::int32_t* r2 = r1 + static_cast<std::size_t>(box.height) * step;
  const std::int32_t* r3 = r2 + step;
  Ints first[4], inside[4], last[4];
  const int columns[4] = {0, 1, 1 + box.width, 2 + box.width};
#pragma GCC unroll 4
  for (int c = 0; c < 4; ++c) {
    const Ints i1 = Load<Ints>(r1 + columns[c]), i2 = Load<Ints>(r2 + columns[c]);
    first[c] = i1 - Load<Ints>(r0 + columns[c]);
    inside[c] = i2 - i1;
    last[c] = Load<Ints>(r3 + columns[c]) - i2;
  }
  const Ints total = box.corner_00 * (first[1] - first[0]) + box.edge_top * (first[2] - first[1]) +
                     box.corner_10 * (first[3] - first[2]) + box.edge_left * (inside[1] - inside[0]) +
                     box.inside * (inside[2] - inside[1]) + box.edge_right * (inside[3] - inside[2]) +
                     box.corner_01 * (last[1] - last[0]) + box.edge_bottom * (last[2] - last[1]) +
                     box.corner_11 * (last[3] - last[2]);
  return (total + (1 << (kFraction - 1))) >> kFraction;
}

// Neighbouring pixels of a row, ready to be read: where the first lies in the integral image, and where its samples go.
struct Row {
  const std::int32_t* sum;
  int at, width;
};

struct Region {
  std::span<const Row> rows;
  std::size_t step;  // of the integral image
  int pixels;        // room of each point's samples
};

constexpr int Padded(int width) { return (width + kLanes - 1) / kLanes * kLanes; }

// samples[block of Width pixels][point][pixel], less 32768: what is compared at once lies together.
template <int Width>
[[gnu::always_inline]] inline void Sample(const Region& region, const BriskSampler& sampler, std::int16_t* samples) {
  static_assert(Width % kLanes == 0);
  for (int n = 0; n < kBriskPoints; ++n) {
    const BriskSampler::Box box = sampler.boxes()[static_cast<std::size_t>(n)];
    const auto offset = box.top * static_cast<std::ptrdiff_t>(region.step) + box.left;
    for (const Row& row : region.rows) {
      for (int x = 0; x < row.width; x += kLanes) {
        const Words<kLanes> mean =
            __builtin_convertvector(Mean(box, row.sum + offset + x, region.step) - 32768, Words<kLanes>);
        const int at = row.at + x;
        std::memcpy(samples + (at / Width * kBriskPoints + n) * Width + at % Width, &mean, sizeof mean);
      }
    }
  }
}

// Comparisons for `Width` pixels at a time: a comparison is 0 or -1 per pixel, and differs from the wanted bit (0 or
// -1) by -1.
template <int Width>
[[gnu::always_inline]] inline void Compare(const std::int16_t* samples, int pixels, const std::int16_t* wanted,
                                           std::uint16_t* distances) {
  using Vector = Words<Width>;
  const BriskPair* pairs = BriskComparisons().data();
  for (int at = 0; at < pixels; at += Width, samples += kBriskPoints * Width) {
    Vector count = {};
    for (int k = 0; k < kBriskPairs; ++k) {
      const Vector a = Load<Vector>(samples + pairs[k].first * Width),
                   b = Load<Vector>(samples + pairs[k].second * Width);
      count -= static_cast<Vector>(a > b) ^ wanted[k];
    }
    std::memcpy(distances + at, &count, sizeof count);
  }
}

using Kernel = void (*)(const Region&, const BriskSampler&, const std::int16_t* wanted, std::int16_t* samples,
                        std::uint16_t* distances);

void BaseKernel(const Region& region, const BriskSampler& sampler, const std::int16_t* wanted, std::int16_t* samples,
                std::uint16_t* distances) {
  Sample<8>(region, sampler, samples);
  Compare<8>(samples, region.pixels, wanted, distances);
}

#ifdef __x86_64__
[[gnu::target("avx2")]] void Avx2Kernel(const Region& region, const BriskSampler& sampler, const std::int16_t* wanted,
                                        std::int16_t* samples, std::uint16_t* distances) {
  Sample<16>(region, sampler, samples);
  Compare<16>(samples, region.pixels, wanted, distances);
}

[[gnu::target("avx2,avx512f,avx512bw,avx512dq,avx512vl")]] void Avx512Kernel(const Region& region,
                                                                             const BriskSampler& sampler,
                                                                             const std::int16_t* wanted,
                                                                             std::int16_t* samples,
                                                                             std::uint16_t* distances) {
  Sample<32>(region, sampler, samples);
  Compare<32>(samples, region.pixels, wanted, distances);
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
    box.inside = static_cast<int>(std::lround((256 << kFraction) / area));
    // Borders, the pixels they lie in, and how much of these is inside; pixels reach half a pixel to either side.
    const auto low = static_cast<float>(place.x()) - half, high = static_cast<float>(place.x()) + half;
    const auto upper = static_cast<float>(place.y()) - half, lower = static_cast<float>(place.y()) + half;
    const auto pixel = [](float v) { return static_cast<int>(std::floor(v + 0.5f)); };
    box.left = pixel(low), box.top = pixel(upper);
    box.width = pixel(high) - box.left - 1, box.height = pixel(lower) - box.top - 1;
    const float in_left = static_cast<float>(box.left) - low + 0.5f,
                in_top = static_cast<float>(box.top) - upper + 0.5f;
    const float in_right = high - static_cast<float>(pixel(high)) + 0.5f,
                in_bottom = lower - static_cast<float>(pixel(lower)) + 0.5f;
    const auto fixed = [&](float share) {
      return static_cast<int>(std::lround(share * static_cast<float>(box.inside)));
    };
    box.corner_00 = fixed(in_left * in_top), box.corner_10 = fixed(in_right * in_top);
    box.corner_11 = fixed(in_right * in_bottom), box.corner_01 = fixed(in_left * in_bottom);
    box.edge_left = fixed(in_left), box.edge_top = fixed(in_top), box.edge_right = fixed(in_right),
    box.edge_bottom = fixed(in_bottom);
    margin_ = std::max({margin_, -box.left, -box.top, box.left + box.width + 2, box.top + box.height + 2});
  }
}

void BriskImage::Set(const cv::Mat& grey) {
  width_ = grey.cols, height_ = grey.rows;
  cv::Mat padded;
  cv::copyMakeBorder(grey, padded, 0, 1, 0, kLanes, cv::BORDER_REPLICATE);
  cv::integral(padded, integral_, CV_32S);
}

bool BriskImage::Describable(const Eigen::Vector2i& pixel, const BriskSampler& sampler) const {
  const int margin = sampler.margin();
  return pixel.x() >= margin && pixel.y() >= margin && pixel.x() < width_ - margin && pixel.y() < height_ - margin;
}

Descriptor BriskImage::Describe(const Eigen::Vector2i& pixel, const BriskSampler& sampler) const {
  if (!Describable(pixel, sampler))
    throw std::invalid_argument("BRISK: the pixel is too near to the edge of the image");
  std::array<std::int16_t, kBriskPoints * 8> samples;
  const Row row{integral_.ptr<std::int32_t>(pixel.y()) + pixel.x(), 0, 1};
  Sample<8>({{&row, 1}, integral_.step1(), 8}, sampler, samples.data());
  Descriptor descriptor{};
  const auto& pairs = BriskComparisons();
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (samples[std::size_t{pairs[k].first} * 8] > samples[std::size_t{pairs[k].second} * 8])
      descriptor[k / 64] |= std::uint64_t{1} << (k % 64);
  return descriptor;
}

std::optional<BriskImage::Found> BriskImage::Nearest(const Descriptor& descriptor, const BriskSampler& sampler,
                                                     std::span<const PixelRun> region) const {
  return Nearest(BestInstructionSet(), descriptor, sampler, region);
}

std::optional<BriskImage::Found> BriskImage::Nearest(InstructionSet set, const Descriptor& descriptor,
                                                     const BriskSampler& sampler, std::span<const PixelRun> region,
                                                     std::vector<Found>* all) const {
  thread_local std::vector<Row> rows;
  thread_local std::vector<PixelRun> runs;  // of `rows`
  thread_local std::vector<std::int16_t> samples;
  thread_local std::vector<std::uint16_t> distances;
  rows.clear();
  runs.clear();
  const int margin = sampler.margin();
  int pixels = 0;
  for (const PixelRun& run : region) {
    const int first = std::max(run.first_x, margin), last = std::min(run.last_x, width_ - margin - 1);
    if (run.y < margin || run.y >= height_ - margin || first > last) continue;
    rows.push_back({integral_.ptr<std::int32_t>(run.y) + first, pixels, last - first + 1});
    runs.push_back({run.y, first, last});
    pixels += Padded(last - first + 1);
  }
  if (rows.empty()) return std::nullopt;
  constexpr int kWidest = 32;  // of a vector, in pixels
  pixels = (pixels + kWidest - 1) / kWidest * kWidest;
  std::array<std::int16_t, kBriskPairs> wanted;
  for (std::size_t k = 0; k < wanted.size(); ++k) wanted[k] = descriptor[k / 64] >> (k % 64) & 1 ? -1 : 0;
  samples.resize(static_cast<std::size_t>(pixels) * kBriskPoints);
  distances.resize(static_cast<std::size_t>(pixels));
  KernelFor(set)({rows, integral_.step1(), pixels}, sampler, wanted.data(), samples.data(), distances.data());

  Found best{{}, kBriskPairs + 1};
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (int x = 0; x < rows[r].width; ++x) {
      const Found here{{runs[r].first_x + x, runs[r].y}, distances[static_cast<std::size_t>(rows[r].at + x)]};
      if (here.distance < best.distance) best = here;
      if (all != nullptr) all->push_back(here);
    }
  return best;
}

}  // namespace vo
