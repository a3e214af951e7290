#include "vo/features/brisk.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "vo/base/vectors.h"

namespace vo {
namespace {

constexpr int kLanes = 8;      // pixels of a row per vector, at the least
constexpr int kMaxLanes = 16;  // columns per vector, at the most: a row is padded by as many, whose values are not used

template <int Lanes>
using Ints = Vector<std::int32_t, Lanes>;
template <int Lanes>
using Sums = Vector<std::uint32_t, Lanes>;  // modulo 2^32; differences are exact
template <int Lanes>
using Floats = Vector<float, Lanes>;
template <int Width>
using Words = Vector<std::int16_t, Width>;

// Run of pixels of a row: address of the first in the integral image, offset of its samples.
struct Row {
  const std::uint32_t* sum;
  int at, width;
};

// Pixels per chunk: the samples stay in the first-level cache. samples[point * kStride + pixel].
constexpr int kChunk = 160;
constexpr int kStride = kChunk + kMaxLanes;  // the vectors of the last row may reach beyond it

struct Region {
  std::span<const Row> rows;  // in order: each overwrites the excess of the row before it
  std::size_t step;           // of the integral image
  int pixels;
  std::uint32_t* columns;  // buffer for the column sums of one box over all rows
};

constexpr int Padded(int width, int lanes = kLanes) { return (width + lanes - 1) / lanes * lanes; }

// Number of columns under the boxes of a row.
int ColumnCount(const Row& row, const BriskSampler::Box& box) { return row.width + box.width + 2; }

// The largest of these over all boxes, padded to whole vectors.
std::size_t BufferSize(const Row& row, const BriskSampler& sampler) {
  return static_cast<std::size_t>(row.width + 2 * sampler.margin() + 2 + 3 * kMaxLanes);
}

// Sums down the box from the integral image: 256 times the sum of everything left of each column, modulo 2^32.
template <int Lanes>
[[gnu::always_inline]] inline void SumColumns(const BriskSampler::Box& box, const std::uint32_t* sum, std::size_t step,
                                              int count, std::uint32_t* columns) {
  const std::uint32_t* r0 = sum;
  const std::uint32_t* r1 = r0 + step;
  const std::uint32_t* r2 = r1 + static_cast<std::size_t>(box.height) * step;
  const std::uint32_t* r3 = r2 + step;
  const auto in_top = static_cast<std::uint32_t>(box.in_top), in_bottom = static_cast<std::uint32_t>(box.in_bottom);
  for (int c = 0; c < count; c += Lanes) {
    using V = Sums<Lanes>;
    const V s1 = Load<V>(r1 + c), s2 = Load<V>(r2 + c);
    const V down = ((s2 - s1) << 8) + in_top * (s1 - Load<V>(r0 + c)) + in_bottom * (Load<V>(r3 + c) - s2);
    Store(down, columns + c);
  }
}

template <int Lanes>
[[gnu::always_inline]] inline Floats<Lanes> Real(Sums<Lanes> v) {
  return __builtin_convertvector(reinterpret_cast<Ints<Lanes>>(v), Floats<Lanes>);
}

// Mean grey over the box at consecutive pixels; `columns`: left column of the first. In 256ths of a grey level,
// rounded, minus 32768.
template <int Lanes>
[[gnu::always_inline]] inline Words<Lanes> Mean(const BriskSampler::Box& box, const std::uint32_t* columns) {
  using V = Sums<Lanes>;
  const V c0 = Load<V>(columns), c1 = Load<V>(columns + 1), c2 = Load<V>(columns + 1 + box.width),
          c3 = Load<V>(columns + 2 + box.width);
  const Floats<Lanes> total =
      Real<Lanes>(c2 - c1) + box.in_left * Real<Lanes>(c1 - c0) + box.in_right * Real<Lanes>(c3 - c2);
  const Ints<Lanes> mean = __builtin_convertvector(total * box.per_area + 0.5f, Ints<Lanes>);
  return __builtin_convertvector(mean - 32768, Words<Lanes>);
}

// Box means of all pattern points at all pixels: samples[point * kStride + pixel].
template <int Lanes>
[[gnu::always_inline]] inline void Sample(const Region& region, const BriskSampler& sampler, std::int16_t* samples) {
  for (int n = 0; n < kBriskPoints; ++n) {
    const BriskSampler::Box box = sampler.boxes()[static_cast<std::size_t>(n)];
    const auto offset = box.top * static_cast<std::ptrdiff_t>(region.step) + box.left;
    std::uint32_t* columns = region.columns;
    for (const Row& row : region.rows) {
      const int count = ColumnCount(row, box);
      SumColumns<Lanes>(box, row.sum + offset, region.step, count, columns);
      columns += Padded(count);
    }
    columns = region.columns;
    std::int16_t* const of_point = samples + std::ptrdiff_t{n} * kStride;
    for (const Row& row : region.rows) {
      int x = 0;
      for (; row.width - x > kLanes; x += Lanes) {
        const Words<Lanes> mean = Mean<Lanes>(box, columns + x);
        Store(mean, of_point + row.at + x);
      }
      if (x < row.width) {
        const Words<kLanes> mean = Mean<kLanes>(box, columns + x);
        Store(mean, of_point + row.at + x);
      }
      columns += Padded(ColumnCount(row, box));
    }
  }
}

// Pairs of a descriptor by the value of their bit, as offsets of the points' samples.
struct PairOffsets {
  std::uint16_t first, second;
};
struct PairsByBit {
  std::array<PairOffsets, kBriskPairs + 1> zeros, ones;
  int zero_count, one_count;
};

PairsByBit SortPairs(const Descriptor& descriptor) {
  static const auto offsets = [] {
    std::array<PairOffsets, kBriskPairs> all;
    for (std::size_t k = 0; k < all.size(); ++k)
      all[k] = {static_cast<std::uint16_t>(BriskComparisons()[k].first * kStride),
                static_cast<std::uint16_t>(BriskComparisons()[k].second * kStride)};
    return all;
  }();
  PairsByBit pairs;
  PairOffsets* zero = pairs.zeros.data();
  PairOffsets* one = pairs.ones.data();
  for (std::size_t k = 0; k < offsets.size(); ++k) {  // branch-free: written to both lists, kept in one
    const auto bit = static_cast<std::ptrdiff_t>((descriptor[k / 64] >> (k % 64)) & 1);
    *zero = *one = offsets[k];
    one += bit;
    zero += 1 - bit;
  }
  pairs.zero_count = static_cast<int>(zero - pairs.zeros.data());
  pairs.one_count = static_cast<int>(one - pairs.ones.data());
  return pairs;
}

// Number of pairs with first > second, for `Width` pixels.
template <int Width>
[[gnu::always_inline]] inline Words<Width> CountGreater(const std::int16_t* samples, const PairOffsets* pairs,
                                                        int count) {
  Words<Width> greater = {};
  for (const PairOffsets* pair = pairs; pair < pairs + count; ++pair) {
    greater -= static_cast<Words<Width>>(Load<Words<Width>>(samples + pair->first) >
                                         Load<Words<Width>>(samples + pair->second));
  }
  return greater;
}

// Hamming distance: pairs with first > second whose bit is 0, plus pairs without whose bit is 1.
template <int Width>
[[gnu::always_inline]] inline void Compare(const std::int16_t* samples, int pixels, const PairsByBit& pairs,
                                           std::uint16_t* distances) {
  const auto all_ones = static_cast<std::int16_t>(pairs.one_count);
  for (int at = 0; at < pixels; at += Width, samples += Width) {
    const Words<Width> count = CountGreater<Width>(samples, pairs.zeros.data(), pairs.zero_count) -
                               CountGreater<Width>(samples, pairs.ones.data(), pairs.one_count) + all_ones;
    Store(count, distances + at);
  }
}

using Kernel = void (*)(const Region&, const BriskSampler&, const PairsByBit& pairs, std::int16_t* samples,
                        std::uint16_t* distances);

void BaseKernel(const Region& region, const BriskSampler& sampler, const PairsByBit& pairs, std::int16_t* samples,
                std::uint16_t* distances) {
  Sample<8>(region, sampler, samples);
  Compare<8>(samples, region.pixels, pairs, distances);
}

#ifdef __x86_64__
[[gnu::target("avx2")]] void Avx2Kernel(const Region& region, const BriskSampler& sampler, const PairsByBit& pairs,
                                        std::int16_t* samples, std::uint16_t* distances) {
  Sample<8>(region, sampler, samples);
  Compare<16>(samples, region.pixels, pairs, distances);
}

[[gnu::target("avx2,avx512f,avx512bw,avx512dq,avx512vl")]] void Avx512Kernel(const Region& region,
                                                                             const BriskSampler& sampler,
                                                                             const PairsByBit& pairs,
                                                                             std::int16_t* samples,
                                                                             std::uint16_t* distances) {
  Sample<16>(region, sampler, samples);
  Compare<32>(samples, region.pixels, pairs, distances);
}
#endif

const std::uint32_t* SumsAt(const cv::Mat& integral, int x, int y) { return integral.ptr<std::uint32_t>(y) + x; }

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
    Box& box = boxes_[n];
    box.per_area = 1 / (4.0f * half * half);
    // Borders, their pixels and the covered fractions of these; a pixel extends by half a pixel to either side.
    const auto low = static_cast<float>(place.x()) - half, high = static_cast<float>(place.x()) + half;
    const auto upper = static_cast<float>(place.y()) - half, lower = static_cast<float>(place.y()) + half;
    const auto pixel = [](float v) {                 // floor(v + 0.5)
      const int whole = static_cast<int>(v + 0.5f);  // NOLINT(bugprone-incorrect-roundings): corrected below
      return whole - (static_cast<float>(whole) > v + 0.5f);
    };
    // For 0 ... 1. NOLINTNEXTLINE(bugprone-incorrect-roundings): equals lround there, which is slow
    const auto in_256ths = [](float inside) { return static_cast<int>(256 * inside + 0.5f); };
    box.left = pixel(low), box.top = pixel(upper);
    box.width = pixel(high) - box.left - 1, box.height = pixel(lower) - box.top - 1;
    box.in_left = static_cast<float>(box.left) - low + 0.5f;
    box.in_right = high - static_cast<float>(pixel(high)) + 0.5f;
    box.in_top = in_256ths(static_cast<float>(box.top) - upper + 0.5f);
    box.in_bottom = in_256ths(lower - static_cast<float>(pixel(lower)) + 0.5f);
    margin_ = std::max({margin_, -box.left, -box.top, box.left + box.width + 2, box.top + box.height + 2});
  }
}

void BriskImage::Set(const cv::Mat& grey) {
  width_ = grey.cols, height_ = grey.rows;
  cv::Mat padded;
  cv::copyMakeBorder(grey, padded, 0, 1, 0, 2 * kMaxLanes, cv::BORDER_REPLICATE);
  cv::integral(padded, integral_, CV_32S);
}

void BriskImage::Prefetch(const Eigen::Vector2i& pixel, int reach) const {
  constexpr int kPerLine = 16;  // sums in a line of the cache
  const int left = std::max(pixel.x() - reach, 0), right = std::min(pixel.x() + reach, width_);
  const int bottom = std::min(pixel.y() + reach, height_);
  for (int y = std::max(pixel.y() - reach, 0); y <= bottom; ++y)
    for (int x = left; x <= right; x += kPerLine) __builtin_prefetch(SumsAt(integral_, x, y));
}

bool BriskImage::Describable(const Eigen::Vector2i& pixel, const BriskSampler& sampler) const {
  const int margin = sampler.margin();
  return pixel.x() >= margin && pixel.y() >= margin && pixel.x() < width_ - margin && pixel.y() < height_ - margin;
}

Descriptor BriskImage::Describe(const Eigen::Vector2i& pixel, const BriskSampler& sampler) const {
  if (!Describable(pixel, sampler))
    throw std::invalid_argument("BRISK: the pixel is too near to the edge of the image");
  std::array<std::int16_t, std::size_t{kBriskPoints} * kStride> samples;
  const Row row{SumsAt(integral_, pixel.x(), pixel.y()), 0, 1};
  std::vector<std::uint32_t> columns(BufferSize(row, sampler));
  Sample<8>({{&row, 1}, integral_.step1(), 1, columns.data()}, sampler, samples.data());
  Descriptor descriptor{};
  const auto& pairs = BriskComparisons();
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (samples[std::size_t{pairs[k].first} * kStride] > samples[std::size_t{pairs[k].second} * kStride])
      descriptor[k / 64] |= std::uint64_t{1} << (k % 64);
  return descriptor;
}

std::optional<BriskImage::Found> BriskImage::Nearest(const Descriptor& descriptor, const BriskSampler& sampler,
                                                     std::span<const PixelRun> region, InstructionSet set,
                                                     std::vector<Found>* all) const {
  constexpr int kMaxWidth = 32;  // pixels per vector
  thread_local std::vector<Row> rows;
  thread_local std::vector<PixelRun> runs;  // of `rows`
  thread_local std::vector<std::uint32_t> columns;
  alignas(64) std::array<std::int16_t, std::size_t{kBriskPoints} * kStride> samples;
  alignas(64) std::array<std::uint16_t, kChunk> distances;
  const PairsByBit pairs = SortPairs(descriptor);
  const Kernel kernel = KernelFor(set);
  Found best{{}, kBriskPairs + 1};
  int pixels = 0;
  std::size_t room = 0;
  const auto take = [&] {
    columns.resize(std::max(columns.size(), room));
    kernel({rows, integral_.step1(), pixels, columns.data()}, sampler, pairs, samples.data(), distances.data());
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (int x = 0; x < rows[r].width; ++x) {
        const int distance = distances[static_cast<std::size_t>(rows[r].at + x)];
        if (distance < best.distance) best = {{runs[r].first_x + x, runs[r].y}, distance};
        if (all != nullptr) all->push_back({{runs[r].first_x + x, runs[r].y}, distance});
      }
    rows.clear();
    runs.clear();
    pixels = 0;
    room = 0;
  };
  rows.clear();
  runs.clear();
  const int margin = sampler.margin();
  for (const PixelRun& run : region) {
    const int last = std::min(run.last_x, width_ - margin - 1);
    if (run.y < margin || run.y >= height_ - margin) continue;
    for (int first = std::max(run.first_x, margin); first <= last;) {
      const int width = std::min(last - first + 1, kChunk);
      if (pixels + width > kChunk) take();
      rows.push_back({SumsAt(integral_, first, run.y), pixels, width});
      runs.push_back({run.y, first, first + width - 1});
      room += BufferSize(rows.back(), sampler);
      pixels += width;
      first += width;
    }
  }
  if (!rows.empty()) take();
  static_assert(kChunk % kMaxWidth == 0);
  return best.distance <= kBriskPairs ? std::optional(best) : std::nullopt;
}

}  // namespace vo
