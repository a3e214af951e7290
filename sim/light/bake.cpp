#include "sim/light/bake.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <sstream>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "sim/light/path_tracer.h"

namespace sim {
namespace {

constexpr int kMaxLog2Coarse = 8;
constexpr std::size_t kMaxSamples = std::size_t{1} << 28;
constexpr double kAgree = 0.02;  // relative difference of lamps' light that is interpolated over

double LongestSide(const RayScene& rays, std::uint32_t t) {
  double longest = 0;
  for (int c = 0; c < 3; ++c)
    longest = std::max(longest, glm::distance(glm::dvec3(rays.Corner(t, c)), glm::dvec3(rays.Corner(t, (c + 1) % 3))));
  return longest;
}

// Largest spacing that counts as spacing_m.
double Most(double spacing_m) { return spacing_m * (1 + 1e-6); }

// Position and normal of a sample, rounded: samples of equal key have equal random numbers and are merged, unless a
// surface is in between (the edge of a floor that continues behind a wall): then they differ in the last number.
using SampleKey = std::array<std::int64_t, 7>;  // x, y, z, normal, other

std::uint64_t Mix(std::uint64_t h, std::uint64_t word) {  // SplitMix64's finaliser (Steele, Lea and Flood 2014)
  h = (h ^ word) + 0x9e3779b97f4a7c15u;
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
  return h ^ (h >> 31);
}

struct HashKey {
  std::uint64_t operator()(const SampleKey& k) const {
    std::uint64_t h = 0;
    for (const std::int64_t w : k) h = Mix(h, static_cast<std::uint64_t>(w));
    return h;
  }
};

struct Sample {
  LightPoint point;
  SampleKey key;
};

// The lattices of one triangle side: all layers' light at each sample, layer after layer.
struct SideLight {
  int log2 = 0;
  std::vector<glm::vec3> values;
};

class Baker {
 public:
  Baker(const Scene& scene, const RayScene& rays, LightMode mode, const BakeParams& params)
      : rays_(rays),
        tracer_(scene, rays),
        params_(params),
        with_lamps_(mode == LightMode::baked),
        layers_(tracer_.layers().size()) {
    double size = 0;
    for (std::uint32_t t = 0; t < rays.triangle_count(); ++t) {
      for (int c = 0; c < 3; ++c) {
        const glm::vec3 a = glm::abs(rays.Corner(t, c));
        size = std::max<double>({size, a.x, a.y, a.z});
      }
    }
    step_ = std::max(size, 1e-30) * 0x1p-21;  // well above a float's last place
  }

  BakedLight Bake() {
    const std::uint32_t triangles = rays_.triangle_count();
    coarse_log2_.resize(triangles);
    first_.resize(triangles);
    std::size_t count = 0;
    for (std::uint32_t t = 0; t < triangles; ++t) {
      coarse_log2_[t] = Log2Resolution(t, params_.spacing_m, kMaxLog2Coarse);
      first_[t] = count;
      count += 2 * LatticeSize(std::size_t{1} << coarse_log2_[t]);
      if (count > kMaxSamples)
        throw std::invalid_argument("baked light: more than 2^28 samples are needed; make render.bake.spacing larger");
    }
    FindSamples(count);
    Compute();

    BakedLight baked;
    baked.has_lamps = with_lamps_;
    baked.layers = tracer_.layers();
    baked.resolutions.resize(triangles);
    std::vector<SideLight> sides(2 * std::size_t{triangles});
    tbb::parallel_for(std::size_t{0}, sides.size(),
                      [&](std::size_t i) { sides[i] = MakeSide(static_cast<std::uint32_t>(i / 2), i % 2 == 1); });
    count = 0;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      TriangleResolution& r = baked.resolutions[i / 2];
      (i % 2 == 0 ? r.log2_front : r.log2_back) = static_cast<std::uint8_t>(sides[i].log2);
      count += sides[i].values.size() / layers_;
      if (count > kMaxSamples)
        throw std::invalid_argument(
            "baked light: more than 2^28 samples are needed; make render.bake.min_spacing larger");
    }
    baked.samples.reserve(count * layers_);
    for (std::size_t layer = 0; layer < layers_; ++layer) {
      for (const SideLight& side : sides) {
        const std::size_t n = side.values.size() / layers_;
        for (std::size_t k = 0; k < n; ++k) baked.samples.push_back(PackShared(side.values[layer * n + k]));
      }
    }
    return baked;
  }

 private:
  int Log2Resolution(std::uint32_t t, double spacing_m, int most) const {
    const double longest = LongestSide(rays_, t);
    int log2 = 0;
    while (log2 < most && longest / static_cast<double>(1 << log2) > Most(spacing_m)) ++log2;
    return log2;
  }

  // The index of the equal sample, or of this one, newly added.
  std::uint32_t IndexOf(const Sample& sample, std::unordered_map<SampleKey, std::uint32_t, HashKey>& known) {
    SampleKey key = sample.key;
    for (;; ++key.back()) {
      const auto [entry, is_new] = known.try_emplace(key, static_cast<std::uint32_t>(samples_.size()));
      if (is_new) samples_.push_back(sample);
      if (is_new || tracer_.SeeEachOther(samples_[entry->second].point, sample.point)) return entry->second;
    }
  }

  Sample At(std::uint32_t t, bool back, int log2, std::size_t i, std::size_t j) const {
    const double r = static_cast<double>(std::size_t{1} << log2), u = static_cast<double>(i) / r,
                 v = static_cast<double>(j) / r;
    const glm::dvec3 a(rays_.Corner(t, 0)), b(rays_.Corner(t, 1)), c(rays_.Corner(t, 2));
    const glm::dvec3 place = (1 - u - v) * a + u * b + v * c, cross = glm::cross(b - a, c - a);
    const double area = glm::length(cross);
    Sample sample;
    sample.point.geometric = area > 0 ? cross / area : glm::dvec3(0, 1, 0);
    if (back) sample.point.geometric = -sample.point.geometric;
    const glm::dvec3 shading(rays_.ShadingNormal(t, static_cast<float>(u), static_cast<float>(v)));
    const double length = glm::length(shading);
    sample.point.normal = length > 0 ? shading / length : sample.point.geometric;
    if (glm::dot(sample.point.normal, sample.point.geometric) < 0) sample.point.normal = -sample.point.normal;
    // Towards the triangle's middle by a fiftieth of a cell: a ray from a corner of a room must not start in its walls.
    sample.point.position = place + (0.02 / r) * ((a + b + c) / 3.0 - place);
    const auto whole = [](double x) { return static_cast<std::int64_t>(std::floor(x + 0.5)); };
    const glm::dvec3& n = sample.point.normal;
    sample.key = {whole(place.x / step_), whole(place.y / step_), whole(place.z / step_),
                  whole(n.x * 512),       whole(n.y * 512),       whole(n.z * 512)};
    return sample;
  }

  void FindSamples(std::size_t count) {
    index_.reserve(count);
    std::unordered_map<SampleKey, std::uint32_t, HashKey> known;
    known.reserve(count / 2);
    for (std::uint32_t t = 0; t < rays_.triangle_count(); ++t) {
      const std::size_t r = std::size_t{1} << coarse_log2_[t];
      for (const bool back : {false, true}) {
        for (std::size_t j = 0; j <= r; ++j) {
          for (std::size_t i = 0; i + j <= r; ++i) {
            index_.push_back(IndexOf(At(t, back, coarse_log2_[t], i, j), known));
          }
        }
      }
    }
  }

  void Compute() {
    indirect_.assign(samples_.size() * layers_, glm::vec3(0.0f));
    if (with_lamps_) lamps_.assign(samples_.size() * layers_, glm::vec3(0.0f));
    tbb::parallel_for(std::size_t{0}, samples_.size(), [&](std::size_t k) {
      std::vector<glm::dvec3> sums(layers_, glm::dvec3(0.0));
      tracer_.AddIndirect(samples_[k].point, HashKey()(samples_[k].key), params_.paths, sums);
      std::copy(sums.begin(), sums.end(), indirect_.begin() + static_cast<std::ptrdiff_t>(k * layers_));
      if (with_lamps_) Lamps(samples_[k], &lamps_[k * layers_]);
    });
  }

  void Lamps(const Sample& sample, glm::vec3* light) const {
    std::vector<glm::dvec3> sums(layers_, glm::dvec3(0.0));
    tracer_.AddDirect(sample.point, HashKey()(sample.key), params_.lamp_rays, sums);
    std::copy(sums.begin(), sums.end(), light);
  }

  // Values of one layer after the other.
  SideLight MakeSide(std::uint32_t t, bool back) const {
    SideLight indirect = Coarse(indirect_, t, back);
    if (with_lamps_) {
      SideLight lamps = Refine(Coarse(lamps_, t, back), t, back);
      while (indirect.log2 < lamps.log2)
        indirect = Finer(indirect, [](std::size_t, std::size_t, const auto&, glm::vec3*) { return false; });
      for (std::size_t k = 0; k < indirect.values.size(); ++k) indirect.values[k] += lamps.values[k];
    }
    return Coarsest(indirect);
  }

  SideLight Coarse(const std::vector<glm::vec3>& from, std::uint32_t t, bool back) const {
    const std::size_t n = LatticeSize(std::size_t{1} << coarse_log2_[t]);
    SideLight side{coarse_log2_[t], std::vector<glm::vec3>(n * layers_)};
    for (std::size_t layer = 0; layer < layers_; ++layer) {
      for (std::size_t k = 0; k < n; ++k)
        side.values[layer * n + k] = from[std::size_t{index_[first_[t] + (back ? n : 0) + k]} * layers_ + layer];
    }
    return side;
  }

  SideLight Refine(SideLight side, std::uint32_t t, bool back) const {
    const int all = Log2Resolution(t, params_.spacing_m / 4, kMaxLog2Resolution),
              most = Log2Resolution(t, params_.min_spacing_m, kMaxLog2Resolution);
    while (side.log2 < most) {
      const bool everywhere = side.log2 < all;
      bool any = false;
      const int log2 = side.log2 + 1;
      side = Finer(
          side, [&](std::size_t i, std::size_t j, const std::vector<const glm::vec3*>& neighbours, glm::vec3* light) {
            if (!everywhere && Agree(neighbours, side.values.size() / layers_)) return false;
            any = true;
            Lamps(At(t, back, log2, i, j), light);
            return true;
          });
      if (!any) break;
    }
    return side;
  }

  bool Agree(const std::vector<const glm::vec3*>& samples, std::size_t stride) const {
    for (std::size_t layer = 0; layer < layers_; ++layer) {
      glm::vec3 low = samples[0][layer * stride], high = low;
      for (const glm::vec3* s : samples) {
        low = glm::min(low, s[layer * stride]);
        high = glm::max(high, s[layer * stride]);
      }
      if (glm::any(glm::greaterThan(glm::dvec3(high - low), kAgree * glm::dvec3(high)))) return false;
    }
    return true;
  }

  // The lattice of twice the resolution. A new sample lies in the middle of a side of the old cells: `compute` (i, j,
  // both ends, the corners opposite to them, out: by layer) returns whether it computed it; else it is their mean.
  template <class Function>
  SideLight Finer(const SideLight& old, const Function& compute) const {
    const std::size_t r = std::size_t{1} << old.log2, n = LatticeSize(r), fine_n = LatticeSize(2 * r);
    SideLight fine{old.log2 + 1, std::vector<glm::vec3>(fine_n * layers_)};
    std::vector<glm::vec3> computed(layers_);
    std::vector<const glm::vec3*> neighbours;
    for (std::size_t j = 0; j <= 2 * r; ++j) {
      for (std::size_t i = 0; i + j <= 2 * r; ++i) {
        const std::size_t k = LatticeIndex(2 * r, i, j);
        neighbours.clear();
        const auto add = [&](std::ptrdiff_t a, std::ptrdiff_t b) {
          if (a >= 0 && b >= 0 && a + b <= static_cast<std::ptrdiff_t>(r)) {
            neighbours.push_back(
                &old.values[LatticeIndex(r, static_cast<std::size_t>(a), static_cast<std::size_t>(b))]);
          }
        };
        const auto a = static_cast<std::ptrdiff_t>(i / 2), b = static_cast<std::ptrdiff_t>(j / 2);
        if (i % 2 == 0 && j % 2 == 0) {
          add(a, b);
        } else if (j % 2 == 0) {
          add(a, b), add(a + 1, b), add(a, b + 1), add(a + 1, b - 1);
        } else if (i % 2 == 0) {
          add(a, b), add(a, b + 1), add(a + 1, b), add(a - 1, b + 1);
        } else {
          add(a + 1, b), add(a, b + 1), add(a, b), add(a + 1, b + 1);
        }
        const bool is_new = neighbours.size() > 1 && compute(i, j, neighbours, computed.data());
        for (std::size_t layer = 0; layer < layers_; ++layer) {
          const glm::vec3 first = neighbours[0][layer * n];
          fine.values[layer * fine_n + k] = is_new                  ? computed[layer]
                                            : neighbours.size() > 1 ? 0.5f * (first + neighbours[1][layer * n])
                                                                    : first;
        }
      }
    }
    return fine;
  }

  // Light that is the same everywhere (none, mostly: the outside of a room) needs no more than a triangle's corners.
  SideLight Coarsest(SideLight side) const {
    const std::size_t n = side.values.size() / layers_;
    for (std::size_t k = 0; k < side.values.size(); ++k) {
      if (side.values[k] != side.values[k / n * n]) return side;
    }
    SideLight small{0, {}};
    for (std::size_t layer = 0; layer < layers_; ++layer)
      small.values.insert(small.values.end(), 3, side.values[layer * n]);
    return small;
  }

  const RayScene& rays_;
  PathTracer tracer_;
  BakeParams params_;
  bool with_lamps_;
  std::size_t layers_;
  double step_;
  std::vector<int> coarse_log2_;      // by triangle
  std::vector<std::size_t> first_;    // by triangle, in index_
  std::vector<std::uint32_t> index_;  // in samples_, of each sample of each coarse lattice
  std::vector<Sample> samples_;
  std::vector<glm::vec3> indirect_, lamps_;  // by sample, then layer
};

}  // namespace

std::vector<std::string> BakeWarnings(const Scene& scene, const RayScene& rays, LightMode mode,
                                      const BakeParams& params) {
  std::vector<std::string> warnings;
  std::ostringstream text;
  text.precision(3);
  const auto report = [&](const char* light, const char* key, double asked_m, int most_log2) {
    const int steps = 1 << most_log2;
    double farthest_m = 0;
    std::uint32_t count = 0;
    for (std::uint32_t t = 0; t < rays.triangle_count(); ++t) {
      const double apart_m = LongestSide(rays, t) / steps;
      if (apart_m > Most(asked_m)) farthest_m = std::max(farthest_m, apart_m), ++count;
    }
    if (count == 0) return;
    text << (text.tellp() > 0 ? "; " : "baked light: ") << light << " are up to " << farthest_m << " m apart on "
         << count << (count == 1 ? " triangle" : " triangles") << ", not render.bake." << key << " = " << asked_m
         << " m: a side is divided into " << steps << " at most";
  };
  report("samples", "spacing", params.spacing_m, kMaxLog2Coarse);
  if (mode == LightMode::baked) report("those of lamps", "min_spacing", params.min_spacing_m, kMaxLog2Resolution);
  if (text.tellp() > 0) warnings.push_back(text.str());
  const bool has_ambient = std::any_of(scene.lights.begin(), scene.lights.end(),
                                       [](const Light& l) { return std::holds_alternative<AmbientLight>(l); });
  if (!scene.objects.empty()) {
    warnings.push_back(std::string("moving objects are not in baked light: lamps shine on them in each frame, ") +
                       (has_ambient ? "and ambient light, which is for them alone"
                                    : "but nothing stands for what bounces: add ambient light") +
                       (mode == LightMode::baked ? "; they cast no shadows on what is baked" : ""));
  } else if (has_ambient) {
    warnings.emplace_back("ambient light is left out: it stands for what baked light computes");
  }
  return warnings;
}

std::vector<settings::FieldProblem> Problems(BakeParams p) {
  settings::FieldCheck check;
  Visit(check, p);
  check.Require(p.min_spacing_m <= p.spacing_m, "min_spacing", p.min_spacing_m, "m must not be above spacing");
  return check.problems;
}

BakedLight BakeLight(const Scene& scene, const RayScene& rays, LightMode mode, const BakeParams& params) {
  ThrowIfAny(Problems(params), "baked light");
  if (mode == LightMode::direct) throw std::invalid_argument("baked light: nothing to bake");
  return Baker(scene, rays, mode, params).Bake();
}

}  // namespace sim
