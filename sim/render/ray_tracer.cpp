#include "sim/render/ray_tracer.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/random/random.h"
#include "sim/render/packet.h"
#include "sim/render/placed_objects.h"
#include "sim/render/ray_scene.h"
#include "sim/render/sample_pattern.h"
#include "sim/render/surface_tracer.h"
#include "tools/base/text.h"

namespace sim {
namespace {

constexpr int kTileSide = 32;  // a multiple of the block's side; the tiles do not depend on the number of threads
static_assert(kTileSide % kBlockSide == 0);

// Times of a block's rows within a sample: the sample lasts from the start of the block's earliest row to the end of
// its latest.
struct BlockTime {
  double part_s = 0.0, row_s = 0.0;  // part_s: how long each row looks in one sample

  double length_s() const { return part_s + (kBlockSide - 1) * std::abs(row_s); }
  // From the middle of the block's middle rows at which the sample begins.
  double begin_s() const { return -0.5 * length_s(); }
  // Of the sample's time, from 0 to 1: where the row's own part begins, and how much of it that is.
  float RowBegin(int row) const {
    if (!(length_s() > 0)) return 0.5f;
    const double s = row_s * (row - 0.5 * (kBlockSide - 1)) - 0.5 * part_s - begin_s();
    return static_cast<float>(s / length_s());
  }
  float RowPart() const { return length_s() > 0 ? static_cast<float>(part_s / length_s()) : 0.0f; }
};

// The rays of the block's pixels, those beyond the picture too.
void StoreRays(const Camera& camera, int x0, int y0, PixelBlock& block) {
  if (camera.straight()) {
    const CameraParams& p = camera.params();
    const auto du = static_cast<float>(1 / p.fx), dv = static_cast<float>(1 / p.fy);
    const auto width = static_cast<float>(std::sqrt(1 / (p.fx * p.fy)));
    const auto cx = static_cast<float>(p.cx), cy = static_cast<float>(p.cy);
    for (int i = 0; i < kLanes; ++i) {
      const int x = x0 + i % kBlockSide, y = y0 + i / kBlockSide;
      block.x.v[i] = (static_cast<float>(x) - cx) * du;
      block.y.v[i] = (static_cast<float>(y) - cy) * dv;
      block.z.v[i] = 1.0f;
      block.x_du.v[i] = du, block.y_du.v[i] = 0.0f, block.z_du.v[i] = 0.0f;
      block.x_dv.v[i] = 0.0f, block.y_dv.v[i] = dv, block.z_dv.v[i] = 0.0f;
      block.width.v[i] = width;
    }
    return;
  }
  for (int i = 0; i < kLanes; ++i) {
    const auto u = static_cast<float>(std::min(x0 + i % kBlockSide, camera.width() - 1)),
               v = static_cast<float>(std::min(y0 + i / kBlockSide, camera.height() - 1));
    const glm::vec3 ray = camera.Ray(u, v);
    const glm::vec3 du = camera.Ray(u + 0.5f, v) - camera.Ray(u - 0.5f, v);
    const glm::vec3 dv = camera.Ray(u, v + 0.5f) - camera.Ray(u, v - 0.5f);
    block.x.v[i] = ray.x, block.y.v[i] = ray.y, block.z.v[i] = ray.z;
    block.x_du.v[i] = du.x, block.y_du.v[i] = du.y, block.z_du.v[i] = du.z;
    block.x_dv.v[i] = dv.x, block.y_dv.v[i] = dv.y, block.z_dv.v[i] = dv.z;
    block.width.v[i] = std::sqrt(std::abs(glm::dot(ray, glm::cross(du, dv))));
  }
}

// The block of pixels whose upper left one is (x0, y0). key: null for rays through the pixels' centres, at the middle
// of each sample's time. time: of the block's rows. lens: whether rays begin at points of it.
PixelBlock MakeBlock(const Camera& camera, int x0, int y0, const BlockTime& time, const std::uint64_t* key, bool lens,
                     ScrambleBlockFunction scramble) {
  PixelBlock block;
  block.row_part = time.RowPart();
  StoreRays(camera, x0, y0, block);
  BlockBits bits{};
  if (key != nullptr) scramble(*key, static_cast<std::uint32_t>(x0), static_cast<std::uint32_t>(y0), bits);
  block.scramble_u = bits.word[0];
  block.scramble_v = bits.word[1];
  for (int i = 0; i < kLanes; ++i) {
    block.row_begin.v[i] = time.RowBegin(i / kBlockSide);
    block.valid.v[i] = x0 + i % kBlockSide < camera.width() && y0 + i / kBlockSide < camera.height() ? -1 : 0;
    block.moment.v[i] =
        key != nullptr ? static_cast<float>(static_cast<std::uint32_t>(bits.word[2].v[i]) >> 8) * 0x1p-24f : 0.5f;
    block.lens_cos.v[i] = 1.0f, block.lens_sin.v[i] = 0.0f;
  }
  for (int i = 0; key != nullptr && lens && i < kLanes; ++i) {
    const auto [cosine, sine] = CosSinFast(static_cast<std::uint32_t>(bits.word[3].v[i]) >> 8);
    block.lens_cos.v[i] = cosine, block.lens_sin.v[i] = sine;
  }
  return block;
}

class RayTracer final : public Renderer {
 public:
  RayTracer(const Scene& scene, std::unique_ptr<RayScene> rays, const RayTracerOptions& options)
      : options_(options),
        lights_(rays->lamps_are_baked() && scene.objects.empty() ? std::vector<Light>() : scene.lights),
        layers_(Flickers(scene.lights)),
        scene_(std::move(rays)),
        surfaces_(*scene_, options.jobs),
        kernel_(PacketKernels().back()),
        arena_(options.jobs > 0 ? options.jobs : tbb::task_arena::automatic) {
    if (options.reflections) scene_->AddReflections(scene);
  }

  void Expose(const Camera& camera, const Trajectory& motion, const Exposure& exposure, std::uint64_t key,
              RadianceImage& out) const override {
    const std::vector<std::string> problems = Problems(exposure);
    if (!problems.empty()) throw std::invalid_argument("Expose: " + base::Join(problems, "; "));
    ExposureSamples samples = MakeSamples(camera, motion, exposure);
    if (!scene_->objects().empty()) samples.Place(*scene_, scene_->lamps_are_baked());
    const int count = samples.per_row;
    const float share = options_.jitter ? 1.0f / std::sqrt(static_cast<float>(count)) : 1.0f;
    const float scale = 1.0f / static_cast<float>(count);
    out.width = camera.width();
    out.height = camera.height();
    out.rgb.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height) * 3);

    ForEachBlock(camera, [&](int x0, int y0) {
      Lanes sum[3];
      const PixelBlock block = MakeBlock(camera, x0, y0, samples.time, options_.jitter ? &key : nullptr,
                                         exposure.aperture_m > 0, kernel_.scramble_block);
      kernel_.expose_block(scene_->packet_scene(), samples.OfRow(y0), count, options_.jitter, share, block, sum);
      for (int i = 0; i < kLanes; ++i) {
        if (block.valid.v[i] == 0) continue;
        const std::size_t x = static_cast<std::size_t>(x0 + i % kBlockSide),
                          y = static_cast<std::size_t>(y0 + i / kBlockSide);
        float* pixel = &out.rgb[(y * static_cast<std::size_t>(out.width) + x) * 3];
        for (int c = 0; c < 3; ++c) pixel[c] = sum[c].v[i] * scale;
      }
    });
  }

  const SurfaceTracer* surfaces() const override { return &surfaces_; }

 private:
  // Samples of an exposure: with a rolling shutter each row of blocks has its own.
  struct ExposureSamples {
    int per_row = 0;
    bool rolls = false;
    BlockTime time;
    std::vector<RaySample> samples;
    std::vector<std::vector<LightSample>> lights;  // of sample i of every row
    std::vector<double> begins_s;                  // of each of `samples`
    std::unique_ptr<const PlacedObjects> objects;  // null: nothing moves
    PacketObjects packet_objects{};

    // Objects through the whole of the exposure.
    void Place(const RayScene& scene, bool own_lamps) {
      const auto [first, last] = std::minmax_element(begins_s.begin(), begins_s.end());
      objects = std::make_unique<const PlacedObjects>(scene, *first, *last + time.length_s());
      packet_objects = objects->packet();
      packet_objects.own_lamps = own_lamps;
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const double begin = objects->TimeOf(begins_s[i]), end = objects->TimeOf(begins_s[i] + time.length_s());
        samples[i].objects = &packet_objects;
        samples[i].objects_begin = static_cast<float>(begin);
        samples[i].objects_length = static_cast<float>(end - begin);
      }
    }

    const RaySample* OfRow(int y) const {
      return samples.data() +
             (rolls ? static_cast<std::size_t>(y / kBlockSide) * static_cast<std::size_t>(per_row) : 0);
    }
  };

  ExposureSamples MakeSamples(const Camera& camera, const Trajectory& motion, const Exposure& exposure) const {
    ExposureSamples out;
    const int count = exposure.time_samples * options_.rays_per_time_sample;
    out.per_row = count;
    out.rolls = exposure.row_delay_s != 0;
    out.time = {exposure.exposure_s / count, exposure.row_delay_s};
    out.lights.resize(static_cast<std::size_t>(count));
    const std::vector<glm::dvec2> on_light = PointsOnLight(count);
    for (int i = 0; i < count; ++i) {
      for (const Light& light : lights_) {
        const std::optional<LightSource> source = SourceOf(light, on_light[static_cast<std::size_t>(i)]);
        if (!source) continue;
        LightSample& s = out.lights[static_cast<std::size_t>(i)].emplace_back();
        Store(s.place, source->place);
        s.directional = source->kind == LightSource::Kind::sun;
        s.one_sided = source->kind == LightSource::Kind::rectangle;
        Store(s.power, s.one_sided ? source->power * glm::length(source->area) : source->power);
        if (s.one_sided) Store(s.normal, glm::normalize(source->area));
        s.layer = LayerOf(light, layers_);
      }
    }
    const std::vector<glm::dvec2> lens = DiscPoints(count);
    const int rows = out.rolls ? (camera.height() + kBlockSide - 1) / kBlockSide : 1;
    out.samples.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(count));
    out.begins_s.resize(out.samples.size());
    for (int row = 0; row < rows; ++row) {
      const double middle_s = exposure.RowMiddle(kBlockSide * row + 0.5 * (kBlockSide - 1), camera.height());
      for (int i = 0; i < count; ++i) {
        const double begin_s = middle_s + out.time.part_s * (i + 0.5 - 0.5 * count) + out.time.begin_s();
        RaySample& s = out.samples[static_cast<std::size_t>(row * count + i)];
        out.begins_s[static_cast<std::size_t>(row * count + i)] = begin_s;
        StoreMotion(motion.At(begin_s).pose, motion.At(begin_s + out.time.length_s()).pose, s);
        const PatternPoint point = SobolPoint(static_cast<std::uint32_t>(i));
        s.point_u = point.u;
        s.point_v = point.v;
        s.moment = options_.jitter ? Moment(i) : 0.0f;
        Store(s.lens, 0.5 * exposure.aperture_m * lens[static_cast<std::size_t>(i)]);
        s.inverse_focus = static_cast<float>(1 / exposure.focus_m);
        s.lights = out.lights[static_cast<std::size_t>(i)].data();
        s.light_count = static_cast<int>(out.lights[static_cast<std::size_t>(i)].size());
        StoreFlicker(middle_s + out.time.part_s * (i + 0.5 - 0.5 * count), out.time, s);
      }
    }
    return out;
  }

  // The factors in the mean over the part of the exposure that this sample is of each row.
  void StoreFlicker(double middle_s, const BlockTime& time, RaySample& s) const {
    for (std::size_t layer = 0; layer < layers_.size(); ++layer) {
      for (int row = 0; row < kBlockSide; ++row) {
        const double t_s = middle_s + time.row_s * (row - 0.5 * (kBlockSide - 1));
        s.layer_factors[layer][row] = static_cast<float>(FlickerFactor(layers_[layer], t_s, time.part_s));
      }
    }
  }

  // Moment of a sample, advanced by the golden ratio from sample to sample: a pixel's moments in its parts of the
  // exposure are spread evenly, so that their mean is unbiased, and still independent from pixel to pixel.
  static float Moment(int sample) {
    const double turns = sample * 0.6180339887498949;
    return std::min(static_cast<float>(turns - std::floor(turns)), 0x1.fffffep-1f);
  }

  static void StoreMotion(const Pose& begin, const Pose& end, RaySample& s) {
    const glm::dmat3 first = glm::mat3_cast(begin.q_WC), turn = glm::mat3_cast(end.q_WC) - first;
    for (int c = 0; c < 3; ++c) Store(s.rotation[c], first[c]), Store(s.turn[c], turn[c]);
    Store(s.origin, begin.p_WC);
    Store(s.way, end.p_WC - begin.p_WC);
  }

  template <class Function>
  void ForEachBlock(const Camera& camera, const Function& function) const {
    const int tiles_x = (camera.width() + kTileSide - 1) / kTileSide,
              tiles_y = (camera.height() + kTileSide - 1) / kTileSide;
    arena_.execute([&] {
      tbb::parallel_for(0, tiles_x * tiles_y, [&](int tile) {
        const int tile_x = tile % tiles_x * kTileSide, tile_y = tile / tiles_x * kTileSide;
        const int x_end = std::min(tile_x + kTileSide, camera.width()),
                  y_end = std::min(tile_y + kTileSide, camera.height());
        for (int y = tile_y; y < y_end; y += kBlockSide) {
          for (int x = tile_x; x < x_end; x += kBlockSide) function(x, y);
        }
      });
    });
  }

  RayTracerOptions options_;
  std::vector<Light> lights_;    // that shadow rays are sent to
  std::vector<Flicker> layers_;  // of lamps and of baked light; the first is steady
  std::unique_ptr<RayScene> scene_;
  SurfaceTracer surfaces_;
  KernelChoice kernel_;
  mutable tbb::task_arena arena_;
};

}  // namespace

std::unique_ptr<Renderer> MakeRayTracer(const Scene& scene, std::unique_ptr<RayScene> rays,
                                        const RayTracerOptions& options) {
  if (options.rays_per_time_sample < 1 || options.rays_per_time_sample > 4096) {
    throw std::invalid_argument("ray tracer: rays_per_time_sample = " + std::to_string(options.rays_per_time_sample) +
                                " must lie in 1 ... 4096");
  }
  if (options.jobs < 0)
    throw std::invalid_argument("ray tracer: jobs = " + std::to_string(options.jobs) + " must not be negative");
  return std::make_unique<RayTracer>(scene, std::move(rays), options);
}

std::unique_ptr<Renderer> MakeRayTracer(const Scene& scene, const RayTracerOptions& options) {
  return MakeRayTracer(scene, std::make_unique<RayScene>(scene), options);
}

}  // namespace sim
