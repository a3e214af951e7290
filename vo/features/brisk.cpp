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

constexpr int kLanes = 8;     // rows of a window are padded to so many pixels
constexpr int kMostLanes = 16;  // columns that are read at once: so many behind the image may be read, for nothing

template <class T, int Bytes>
struct VectorOf {
  typedef T type __attribute__((vector_size(Bytes)));
};
template <int Lanes>
using Ints = typename VectorOf<std::int32_t, 4 * Lanes>::type;
template <int Lanes>
using Sums = typename VectorOf<std::uint32_t, 4 * Lanes>::type;  // wrap around; differences are right
template <int Lanes>
using Floats = typename VectorOf<float, 4 * Lanes>::type;
template <int Width>
using Words = typename VectorOf<std::int16_t, 2 * Width>::type;

template <class Vector>
[[gnu::always_inline]] inline Vector Load(const void* from) {
  Vector v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

// Neighbouring pixels of a row, ready to be read: where the first lies in the integral image, and where its samples go.
struct Row {
  const std::uint32_t* sum;
  int at, width;
};

struct Region {
  std::span<const Row> rows;
  std::size_t step;        // of the integral image
  int pixels;              // room of each point's samples
  std::uint32_t* columns;  // room for the columns of all rows, one box's at a time
};

constexpr int Padded(int width, int lanes = kLanes) { return (width + lanes - 1) / lanes * lanes; }

// Columns that the boxes of a row reach into.
int ColumnsOf(const Row& row, const BriskSampler::Box& box) {
  return Padded(Padded(row.width) + box.width + 3, kMostLanes);
}

// Room for that of every box, and what is read behind it.
std::size_t RoomFor(const Row& row, const BriskSampler& sampler) {
  return static_cast<std::size_t>(Padded(Padded(row.width) + 2 * sampler.margin() + 3, kMostLanes) + 2 * kMostLanes);
}

// The integral image's columns, down the box: 256 times the sum of all that is left of a column, modulo 2^32.
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
    std::memcpy(columns + c, &down, sizeof down);
  }
}

template <int Lanes>
[[gnu::always_inline]] inline Floats<Lanes> Real(Sums<Lanes> v) {
  return __builtin_convertvector(reinterpret_cast<Ints<Lanes>>(v), Floats<Lanes>);
}

// Mean grey over the box at neighbouring pixels, of which `columns` is the first's left column. In 256ths of a grey
// level, rounded, less 32768.
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

// To where pixel `at` of a point has its place, in blocks of `Width` pixels of all points.
template <int Width, int Lanes>
[[gnu::always_inline]] inline void Store(Words<Lanes> mean, int at, std::int16_t* of_point) {
  for (unsigned part = 0; part < Lanes; part += kLanes) {
    const unsigned here = static_cast<unsigned>(at) + part;
    std::memcpy(of_point + here / Width * (kBriskPoints * Width) + here % Width,
                reinterpret_cast<const std::int16_t*>(&mean) + part, kLanes * sizeof(std::int16_t));
  }
}

// samples[block of Width pixels][point][pixel]: what is compared at once lies together.
template <int Width, int Lanes>
[[gnu::always_inline]] inline void Sample(const Region& region, const BriskSampler& sampler, std::int16_t* samples) {
  static_assert(Width % kLanes == 0);
  for (int n = 0; n < kBriskPoints; ++n) {
    const BriskSampler::Box box = sampler.boxes()[static_cast<std::size_t>(n)];
    const auto offset = box.top * static_cast<std::ptrdiff_t>(region.step) + box.left;
    std::uint32_t* columns = region.columns;
    for (const Row& row : region.rows) {
      const int count = ColumnsOf(row, box);
      SumColumns<Lanes>(box, row.sum + offset, region.step, count, columns);
      columns += count;
    }
    columns = region.columns;
    std::int16_t* const of_point = samples + n * Width;
    for (const Row& row : region.rows) {
      int x = 0;
      for (; row.width - x > kLanes; x += Lanes) Store<Width, Lanes>(Mean<Lanes>(box, columns + x), row.at + x, of_point);
      if (x < row.width) Store<Width, kLanes>(Mean<kLanes>(box, columns + x), row.at + x, of_point);
      columns += ColumnsOf(row, box);
    }
  }
}

// Comparisons by the bit that is wanted of them, as places of the points' numbers.
struct Wanted {
  std::array<std::uint32_t, 2 * kBriskPairs> pairs;  // first and second, and again; those of 0 before those of 1
  int zeros;
};

Wanted SortPairs(const Descriptor& descriptor) {
  Wanted wanted;
  wanted.zeros = kBriskPairs;
  for (const std::uint64_t word : descriptor) wanted.zeros -= std::popcount(word);
  std::size_t next[2] = {0, 2 * static_cast<std::size_t>(wanted.zeros)};
  const auto& pairs = BriskComparisons();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    std::size_t& at = next[descriptor[k / 64] >> (k % 64) & 1];
    wanted.pairs[at] = pairs[k].first;
    wanted.pairs[at + 1] = pairs[k].second;
    at += 2;
  }
  return wanted;
}

// How many of the pairs first > second, for `Width` pixels at a time.
template <int Width>
[[gnu::always_inline]] inline Words<Width> CountGreater(const std::int16_t* samples, const std::uint32_t* pair,
                                                        const std::uint32_t* end) {
  Words<Width> count = {};
  for (; pair < end; pair += 2) {
    count -= static_cast<Words<Width>>(Load<Words<Width>>(samples + pair[0] * Width) >
                                       Load<Words<Width>>(samples + pair[1] * Width));
  }
  return count;
}

// Where 0 is wanted, a pair that is greater differs; where 1 is, one that is not.
template <int Width>
[[gnu::always_inline]] inline void Compare(const std::int16_t* samples, int pixels, const Wanted& wanted,
                                           std::uint16_t* distances) {
  const std::uint32_t* pairs = wanted.pairs.data();
  const std::uint32_t* ones = pairs + 2 * wanted.zeros;
  const std::uint32_t* end = pairs + wanted.pairs.size();
  const auto all_ones = static_cast<std::int16_t>(kBriskPairs - wanted.zeros);
  for (int at = 0; at < pixels; at += Width, samples += kBriskPoints * Width) {
    const Words<Width> count =
        CountGreater<Width>(samples, pairs, ones) - CountGreater<Width>(samples, ones, end) + all_ones;
    std::memcpy(distances + at, &count, sizeof count);
  }
}

using Kernel = void (*)(const Region&, const BriskSampler&, const Wanted& wanted, std::int16_t* samples,
                        std::uint16_t* distances);

void BaseKernel(const Region& region, const BriskSampler& sampler, const Wanted& wanted, std::int16_t* samples,
                std::uint16_t* distances) {
  Sample<8, 8>(region, sampler, samples);
  Compare<8>(samples, region.pixels, wanted, distances);
}

#ifdef __x86_64__
[[gnu::target("avx2")]] void Avx2Kernel(const Region& region, const BriskSampler& sampler, const Wanted& wanted, std::int16_t* samples, std::uint16_t* distances) {
  Sample<16, 8>(region, sampler, samples);
  Compare<16>(samples, region.pixels, wanted, distances);
}

[[gnu::target("avx2,avx512f,avx512bw,avx512dq,avx512vl")]] void Avx512Kernel(const Region& region,
                                                                             const BriskSampler& sampler,
                                                                             const Wanted& wanted, std::int16_t* samples,
                                                                             std::uint16_t* distances) {
  Sample<32, 16>(region, sampler, samples);
  Compare<32>(samples, region.pixels, wanted, distances);
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
    // Borders, the pixels they lie in, and how much of these is inside; pixels reach half a pixel to either side.
    const auto low = static_cast<float>(place.x()) - half, high = static_cast<float>(place.x()) + half;
    const auto upper = static_cast<float>(place.y()) - half, lower = static_cast<float>(place.y()) + half;
    const auto pixel = [](float v) { return static_cast<int>(std::floor(v + 0.5f)); };
    box.left = pixel(low), box.top = pixel(upper);
    box.width = pixel(high) - box.left - 1, box.height = pixel(lower) - box.top - 1;
    box.in_left = static_cast<float>(box.left) - low + 0.5f;
    box.in_right = high - static_cast<float>(pixel(high)) + 0.5f;
    box.in_top = static_cast<int>(std::lround(256 * (static_cast<float>(box.top) - upper + 0.5f)));
    box.in_bottom = static_cast<int>(std::lround(256 * (lower - static_cast<float>(pixel(lower)) + 0.5f)));
    margin_ = std::max({margin_, -box.left, -box.top, box.left + box.width + 2, box.top + box.height + 2});
  }
}

void BriskImage::Set(const cv::Mat& grey) {
  width_ = grey.cols, height_ = grey.rows;
  cv::Mat padded;
  cv::copyMakeBorder(grey, padded, 0, 1, 0, 2 * kMostLanes, cv::BORDER_REPLICATE);
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
  const Row row{SumsAt(integral_, pixel.x(), pixel.y()), 0, 1};
  std::vector<std::uint32_t> columns(RoomFor(row, sampler));
  Sample<8, 8>({{&row, 1}, integral_.step1(), 8, columns.data()}, sampler, samples.data());
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
  thread_local std::vector<std::uint32_t> columns;
  thread_local std::vector<std::int16_t> samples;
  thread_local std::vector<std::uint16_t> distances;
  rows.clear();
  runs.clear();
  const int margin = sampler.margin();
  int pixels = 0;
  std::size_t room = 0;
  for (const PixelRun& run : region) {
    const int first = std::max(run.first_x, margin), last = std::min(run.last_x, width_ - margin - 1);
    if (run.y < margin || run.y >= height_ - margin || first > last) continue;
    rows.push_back({SumsAt(integral_, first, run.y), pixels, last - first + 1});
    room += RoomFor(rows.back(), sampler);
    runs.push_back({run.y, first, last});
    pixels += Padded(last - first + 1);
  }
  if (rows.empty()) return std::nullopt;
  constexpr int kWidest = 32;  // of a vector, in pixels
  pixels = (pixels + kWidest - 1) / kWidest * kWidest;
  samples.resize(static_cast<std::size_t>(pixels) * kBriskPoints);
  distances.resize(static_cast<std::size_t>(pixels));
  columns.resize(std::max(columns.size(), room));
  KernelFor(set)({rows, integral_.step1(), pixels, columns.data()}, sampler, SortPairs(descriptor), samples.data(), distances.data());

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
