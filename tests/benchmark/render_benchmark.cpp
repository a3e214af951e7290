// Cost of a shaded sample against that of a bare Embree ray, on the same rays, for each instruction set of this
// machine:
//
//   render_benchmark --benchmark_repetitions=5
//
// The scene is a generated hall of columns: 300 000 triangles, 31.6 MB of textures with their mip levels. One core,
// except for the last benchmarks. ns: per ray.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "sim/light/cache.h"
#include "sim/render/embree.h"
#include "sim/render/packet.h"
#include "sim/render/ray_scene.h"
#include "sim/render/ray_tracer.h"

namespace sim {
namespace {

constexpr int kWidth = 640, kHeight = 480;

CameraParams HallCamera() {
  CameraParams camera;
  camera.width = kWidth, camera.height = kHeight;
  camera.fx = camera.fy = 525;
  camera.cx = 319.5, camera.cy = 239.5;
  return camera;
}

Texture Picture(int number, int side) {
  std::vector<std::uint8_t> rgb;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double waves =
          std::sin(0.05 * x + number) * std::sin(0.07 * y + 2 * number) + 0.3 * std::sin(0.9 * x + 0.4 * y);
      const unsigned grain = static_cast<unsigned>(y * side + x) * 2654435761u >> 27;
      for (int c = 0; c < 3; ++c)
        rgb.push_back(static_cast<std::uint8_t>(110 + 50 * waves + grain + 10 * ((number + c) % 3)));
    }
  }
  return Texture("picture " + std::to_string(number), side, side, rgb);
}

// A surface X(s, t) over the unit square, s and t in n_s and n_t steps.
template <class Function>
void AddSheet(Scene& scene, int n_s, int n_t, int material, glm::vec2 repeats, const Function& place) {
  Mesh mesh;
  mesh.name = "sheet";
  mesh.material = material;
  for (int j = 0; j <= n_t; ++j) {
    for (int i = 0; i <= n_s; ++i) {
      const double s = static_cast<double>(i) / n_s, t = static_cast<double>(j) / n_t, d = 1e-4;
      const glm::dvec3 x = place(s, t);
      mesh.positions.emplace_back(x);
      mesh.normals.emplace_back(
          glm::normalize(glm::cross(place(s + d, t) - place(s - d, t), place(s, t + d) - place(s, t - d))));
      mesh.uvs.emplace_back(s * repeats.x, t * repeats.y);
    }
  }
  const auto row = static_cast<std::uint32_t>(n_s + 1);
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(n_t); ++j) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = j * row + i;
      mesh.triangles.emplace_back(a, a + 1, a + row);
      mesh.triangles.emplace_back(a + 1, a + row + 1, a + row);
    }
  }
  scene.meshes.push_back(std::move(mesh));
}

// Hall of 20 m x 8 m x 6 m: two rows of fluted columns, arches above them, an uneven floor. The number of triangles
// grows with the square of `detail`.
Scene Hall(double detail = 1) {
  Scene scene;
  const auto steps = [&](int n) { return std::max(2, static_cast<int>(std::lround(n * detail))); };
  for (int i = 0; i < 6; ++i) {
    scene.textures.push_back(Picture(i, 1024 - 64 * i % 128));
    Material material;
    material.name = "stone " + std::to_string(i);
    material.base_color = glm::vec3(0.9f);
    material.texture = i;
    scene.materials.push_back(material);
  }
  const auto wavy = [](double s, double t) { return 0.01 * std::sin(61 * s) * std::sin(47 * t); };
  AddSheet(scene, steps(200), steps(80), 0, {10, 4},
           [&](double s, double t) { return glm::dvec3(20 * s, wavy(s, t), 8 * t); });
  AddSheet(scene, steps(200), steps(80), 1, {10, 4},
           [&](double s, double t) { return glm::dvec3(20 * s, 6 + wavy(s, t), 8 * t); });
  AddSheet(scene, steps(200), steps(60), 2, {10, 3},
           [&](double s, double t) { return glm::dvec3(20 * s, 6 * t, wavy(s, t)); });
  AddSheet(scene, steps(200), steps(60), 2, {10, 3},
           [&](double s, double t) { return glm::dvec3(20 * s, 6 * t, 8 + wavy(s, t)); });
  AddSheet(scene, steps(80), steps(60), 3, {4, 3},
           [&](double s, double t) { return glm::dvec3(wavy(s, t), 6 * t, 8 * s); });
  AddSheet(scene, steps(80), steps(60), 3, {4, 3},
           [&](double s, double t) { return glm::dvec3(20 + wavy(s, t), 6 * t, 8 * s); });
  for (int side = 0; side < 2; ++side) {
    for (int k = 0; k < 9; ++k) {
      const double x0 = 2 + 2 * k, z0 = side == 0 ? 2 : 6;
      AddSheet(scene, steps(72), steps(60), 4, {3, 4}, [&](double s, double t) {
        const double angle = 2 * std::numbers::pi * s;
        const double radius =
            (0.22 + 0.012 * std::cos(16 * angle)) * (1 + 0.5 * std::exp(-40 * t) + 0.6 * std::exp(-40 * (1 - t)));
        return glm::dvec3(x0 + radius * std::cos(angle), 4 * t, z0 + radius * std::sin(angle));
      });
      if (k == 8) continue;
      AddSheet(scene, steps(48), steps(24), 5, {3, 1}, [&](double s, double t) {
        const double angle = std::numbers::pi * s, turn = 2 * std::numbers::pi * t, radius = 1 + 0.15 * std::cos(turn);
        return glm::dvec3(x0 + 1 - radius * std::cos(angle), 4 + radius * std::sin(angle), z0 + 0.15 * std::sin(turn));
      });
    }
  }
  scene.lights = {PointLight{{10, 5, 4}, {20, 20, 18}, {}}, SunLight{{0.3, -1, 0.2}, {1, 1, 1}}};
  scene.background = glm::vec3(0.5f);
  return scene;
}

std::size_t CountTriangles(const Scene& scene) {
  std::size_t count = 0;
  for (const Mesh& mesh : scene.meshes) count += mesh.triangles.size();
  return count;
}

Pose HallPose() {
  return {{1.2, 1.7, 3.6},
          glm::normalize(
              glm::dquat(glm::dmat3(glm::dvec3(0.1, 0, 0.995), glm::dvec3(0, -1, 0), glm::dvec3(0.995, 0, -0.1))))};
}

class Still : public Trajectory {
 public:
  Motion At(double) const override { return {HallPose()}; }
};

// Synthetic baked light: the cost of a lookup does not depend on the values.
BakedLight SomeLight(const RayScene& rays) {
  BakedLight light;
  light.layers.push_back({});
  for (std::uint32_t t = 0; t < rays.triangle_count(); ++t) {
    light.resolutions.push_back({1, 0});
    for (int k = 0; k < 9; ++k)
      light.samples.push_back((16u << 27) | (300u + t % 100u) | ((250u + t % 50u) << 9) | (200u << 18));
  }
  return light;
}

// Pixel blocks of one image and their ray sample.
struct Frame {
  std::vector<PixelBlock> blocks;
  RaySample sample{};
};

Frame MakeFrame() {
  Frame frame;
  const CameraParams camera = HallCamera();
  for (int y0 = 0; y0 < kHeight; y0 += kBlockSide) {
    for (int x0 = 0; x0 < kWidth; x0 += kBlockSide) {
      PixelBlock block{};
      for (int i = 0; i < kLanes; ++i) {
        block.x.v[i] = static_cast<float>((x0 + i % kBlockSide - camera.cx) / camera.fx);
        block.y.v[i] = static_cast<float>((y0 + i / kBlockSide - camera.cy) / camera.fy);
        block.x_du.v[i] = block.y_dv.v[i] = block.width.v[i] = static_cast<float>(1 / camera.fx);
        block.z.v[i] = 1;
        block.valid.v[i] = -1;
      }
      frame.blocks.push_back(block);
    }
  }
  const Pose pose = HallPose();
  const glm::dmat3 rotation = glm::mat3_cast(pose.q_WC);
  for (int c = 0; c < 3; ++c) {
    frame.sample.origin[c] = static_cast<float>(pose.p_WC[c]);
    for (int r = 0; r < 3; ++r) frame.sample.rotation[c][r] = static_cast<float>(rotation[c][r]);
  }
  for (float& factor : frame.sample.layer_factors[0]) factor = 1;
  return frame;
}

struct World {
  Scene scene = Hall();
  RayScene rays{scene};
  Frame frame = MakeFrame();
};
World& TheWorld() {
  static World world;
  return world;
}

void Rate(benchmark::State& state) {
  state.counters["ns"] = benchmark::Counter(static_cast<double>(state.iterations()) * kWidth * kHeight * 1e-9,
                                            benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

// Bare rays: generated, traced, and one distance read.
void Bare(benchmark::State& state) {
  const World& world = TheWorld();
  const RaySample& sample = world.frame.sample;
  for (auto _ : state) {
    float sum = 0;
    for (const PixelBlock& block : world.frame.blocks) {
      RTCRayHit16 rays;
      for (int i = 0; i < kLanes; ++i) {
        rays.ray.dir_x[i] =
            sample.rotation[0][0] * block.x.v[i] + sample.rotation[1][0] * block.y.v[i] + sample.rotation[2][0];
        rays.ray.dir_y[i] =
            sample.rotation[0][1] * block.x.v[i] + sample.rotation[1][1] * block.y.v[i] + sample.rotation[2][1];
        rays.ray.dir_z[i] =
            sample.rotation[0][2] * block.x.v[i] + sample.rotation[1][2] * block.y.v[i] + sample.rotation[2][2];
        rays.ray.org_x[i] = sample.origin[0], rays.ray.org_y[i] = sample.origin[1],
        rays.ray.org_z[i] = sample.origin[2];
        rays.ray.tnear[i] = 0;
        rays.ray.tfar[i] = __builtin_inff();
        rays.ray.time[i] = 0;
        rays.ray.mask[i] = 0xffffffffu;
        rays.ray.id[i] = rays.ray.flags[i] = 0;
        rays.hit.geomID[i] = rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
      }
      Intersect16(block.valid.v, world.rays.embree(), &rays, true);
      sum += rays.ray.tfar[5];
    }
    benchmark::DoNotOptimize(sum);
  }
  Rate(state);
}

void Shaded(benchmark::State& state, ExposeBlockFunction expose, int lights, bool baked) {
  World& world = TheWorld();
  static const BakedLight light = SomeLight(world.rays);
  if (baked && world.rays.packet_scene().light == nullptr) world.rays.SetLight(light);
  PacketScene scene = world.rays.packet_scene();
  if (!baked) scene.light = nullptr;
  LightSample lamp{};
  lamp.place[0] = 10, lamp.place[1] = 5, lamp.place[2] = 4;
  for (float& p : lamp.power) p = 20;
  RaySample sample = world.frame.sample;
  sample.lights = &lamp;
  sample.light_count = lights;
  for (auto _ : state) {
    for (const PixelBlock& block : world.frame.blocks) {
      Lanes sum[3];
      expose(scene, &sample, 1, false, 1.0f, block, sum);
      benchmark::DoNotOptimize(sum);
    }
  }
  Rate(state);
}

// The hall as a glTF file with its textures in files beside it.
void WriteGltf(const Scene& scene, const std::filesystem::path& folder) {
  std::string data, views, accessors, meshes, nodes, materials, textures, images, roots;
  const auto add = [&](const void* from, std::size_t size, std::size_t count, const char* type, int component,
                       const std::string& more) {
    views += (views.empty() ? "" : ",") + ("{\"buffer\":0,\"byteOffset\":" + std::to_string(data.size())) +
             ",\"byteLength\":" + std::to_string(size) + "}";
    const std::string number = std::to_string(std::count(accessors.begin(), accessors.end(), '}'));
    accessors += (accessors.empty() ? "" : ",") + ("{\"bufferView\":" + number) +
                 ",\"componentType\":" + std::to_string(component) + ",\"count\":" + std::to_string(count) +
                 ",\"type\":\"" + type + "\"" + more + "}";
    data.append(static_cast<const char*>(from), size);
    return number;
  };
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    const std::size_t n = mesh.positions.size(), t = mesh.triangles.size();
    const std::string p = add(mesh.positions.data(), 12 * n, n, "VEC3", 5126, ",\"min\":[-1,-1,-1],\"max\":[21,9,9]");
    const std::string normal = add(mesh.normals.data(), 12 * n, n, "VEC3", 5126, ""),
                      uv = add(mesh.uvs.data(), 8 * n, n, "VEC2", 5126, "");
    const std::string index = add(mesh.triangles.data(), 12 * t, 3 * t, "SCALAR", 5125, "");
    const std::string comma = m == 0 ? "" : ",";
    meshes += comma + "{\"primitives\":[{\"attributes\":{\"POSITION\":" + p + ",\"NORMAL\":" + normal +
              ",\"TEXCOORD_0\":" + uv + "},\"indices\":" + index + ",\"material\":" + std::to_string(mesh.material) +
              "}]}";
    nodes += comma + "{\"mesh\":" + std::to_string(m) + "}";
    roots += comma + std::to_string(m);
  }
  for (std::size_t k = 0; k < scene.textures.size(); ++k) {
    const Texture& texture = scene.textures[k];
    cv::Mat picture(texture.height(), texture.width(), CV_8UC3);
    for (int y = 0; y < picture.rows; ++y) {
      for (int x = 0; x < picture.cols; ++x) {
        const glm::vec3 c = glm::sqrt(texture.Texel(0, x, y)) * 255.0f;
        picture.at<cv::Vec3b>(y, x) = {static_cast<std::uint8_t>(c.z), static_cast<std::uint8_t>(c.y),
                                       static_cast<std::uint8_t>(c.x)};
      }
    }
    const std::string name = "picture" + std::to_string(k) + ".jpg", comma = k == 0 ? "" : ",",
                      number = std::to_string(k);
    cv::imwrite((folder / name).string(), picture);
    images += comma + "{\"uri\":\"" + name + "\"}";
    textures += comma + "{\"source\":" + number + "}";
    materials += comma + "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":" + number + "}}}";
  }
  std::ofstream(folder / "hall.bin", std::ios::binary) << data;
  std::ofstream(folder / "hall.gltf") << "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":["
                                      << roots << "]}],\"nodes\":[" << nodes << "],\"meshes\":[" << meshes
                                      << "],\"materials\":[" << materials << "],\"textures\":[" << textures
                                      << "],\"images\":[" << images
                                      << "],\"buffers\":[{\"uri\":\"hall.bin\",\"byteLength\":" << data.size()
                                      << "}],\"bufferViews\":[" << views << "],\"accessors\":[" << accessors << "]}";
}

// Time from the file to the first image: loading, acceleration structure and tables, one frame. Baked light comes from
// a warm cache.
void FirstFrame(benchmark::State& state, LightMode mode) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("vobench_hall_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  WriteGltf(TheWorld().scene, folder);
  WorldDescription world;
  world.meshes.emplace_back().file = folder / "hall.gltf";
  world.lights = TheWorld().scene.lights;
  std::vector<std::string> warnings;
  const auto make = [&](const Scene& scene) {
    return MakeRayTracer(scene, LitScene(scene, mode, {1.0, 1.0, 2, 1}, {folder}, warnings), {});
  };
  const Camera camera(HallCamera());
  if (mode != LightMode::direct) make(LoadScene(world));
  double load_s = 0, build_s = 0;
  const auto now = [] { return std::chrono::steady_clock::now(); };
  for (auto _ : state) {
    const auto begin = now();
    const Scene scene = LoadScene(world);
    const auto loaded = now();
    const auto renderer = make(scene);
    const auto built = now();
    RadianceImage image;
    renderer->Expose(camera, Still(), Exposure{}, 1, image);
    load_s += std::chrono::duration<double>(loaded - begin).count();
    build_s += std::chrono::duration<double>(built - loaded).count();
  }
  state.counters["load_s"] = load_s / static_cast<double>(state.iterations());
  state.counters["build_s"] = build_s / static_cast<double>(state.iterations());
  std::filesystem::remove_all(folder);
}

struct FrameSettings {
  int width = kWidth, height = kHeight;
  LightMode light = LightMode::baked;
  int time_samples = 1;
  double row_delay_s = 0;
  double detail = 1;
};

// A walk along the hall: camera motion for the rolling shutter.
class Walk : public Trajectory {
 public:
  Motion At(double t_s) const override {
    Motion motion{HallPose()};
    motion.v_WC = {1.2, 0, 0.3};
    motion.pose.p_WC += t_s * motion.v_WC;
    return motion;
  }
};

// Whole images by the renderer, with its threads.
void WholeFrame(benchmark::State& state, const FrameSettings& settings) {
  RayTracerOptions options;
  options.jobs = static_cast<int>(state.range(0));
  const bool other = settings.detail != 1;
  const Scene detailed = other ? Hall(settings.detail) : Scene();
  const Scene& scene = other ? detailed : TheWorld().scene;
  std::vector<std::string> warnings;
  const BakeParams quick{1.0, 1.0, 2, 1};  // the cost of a frame does not depend on the paths
  const auto renderer = MakeRayTracer(scene, LitScene(scene, settings.light, quick, {}, warnings), options);
  CameraParams params = HallCamera();
  params.fx = params.fy *= static_cast<double>(settings.width) / kWidth;
  params.width = settings.width, params.height = settings.height;
  params.cx = 0.5 * (settings.width - 1), params.cy = 0.5 * (settings.height - 1);
  const Camera camera(params);
  Exposure exposure;
  exposure.time_samples = settings.time_samples;
  exposure.exposure_s = settings.time_samples > 1 ? 0.01 : 0.0;
  exposure.row_delay_s = settings.row_delay_s;
  RadianceImage image;
  for (auto _ : state) renderer->Expose(camera, Walk(), exposure, 1, image);
  state.counters["frames/s"] = benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["triangles"] = static_cast<double>(CountTriangles(scene));
}

void RegisterFrame(const std::string& name, const FrameSettings& settings, const std::vector<int>& jobs) {
  auto* benchmark =
      benchmark::RegisterBenchmark(name.c_str(), WholeFrame, settings)->Unit(benchmark::kMillisecond)->UseRealTime();
  for (const int n : jobs) benchmark->Arg(n);
}

}  // namespace
}  // namespace sim

int main(int argc, char** argv) {
  using namespace sim;
  benchmark::Initialize(&argc, argv);
  {
    const auto begin = std::chrono::steady_clock::now();
    const Scene& scene = TheWorld().scene;
    std::size_t bytes = 0;
    for (const Texture& t : scene.textures) bytes += t.texels().size() * 4;
    std::printf("%zu triangles, %.1f MB of pictures, made in %.2f s; best instruction set: %s\n", CountTriangles(scene),
                static_cast<double>(bytes) * 1e-6,
                std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
                PacketKernels().back().name);
  }
  benchmark::RegisterBenchmark("bare/rtcIntersect16", Bare)->Unit(benchmark::kMillisecond);
  for (const KernelChoice& kernel : PacketKernels()) {
    const std::string name = kernel.name;
    benchmark::RegisterBenchmark(("sample/baked/" + name).c_str(), Shaded, kernel.expose_block, 0, true)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("sample/ambient/" + name).c_str(), Shaded, kernel.expose_block, 0, false)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("sample/one_lamp/" + name).c_str(), Shaded, kernel.expose_block, 1, false)
        ->Unit(benchmark::kMillisecond);
  }
  for (const int samples : {1, 16})
    RegisterFrame("frame/baked/" + std::to_string(samples), {.time_samples = samples}, {1, 2});
  RegisterFrame("frame/rolling/1", {.row_delay_s = 0.03 / kHeight}, {1, 2});
  RegisterFrame("frame/rolling/16", {.time_samples = 16, .row_delay_s = 0.03 / kHeight}, {1, 2});
  // Scaling of the time on one core. 10 000 to 5 000 000 triangles, in direct light: no time for baking.
  for (const int samples : {2, 4, 8, 32})
    RegisterFrame("samples/" + std::to_string(samples), {.time_samples = samples}, {1});
  for (const int width : {320, 640, 1280, 2560}) {
    RegisterFrame("pixels/" + std::to_string(width * width * 3 / 4), {.width = width, .height = width * 3 / 4}, {1});
  }
  for (const double detail : {0.176, 0.32, 0.556, 1.0, 1.76, 3.93}) {
    RegisterFrame("triangles/" + std::to_string(static_cast<int>(323584 * detail * detail / 1000)) + "k",
                  {.light = LightMode::direct, .detail = detail}, {1});
  }
  benchmark::RegisterBenchmark("first_frame/direct", FirstFrame, LightMode::direct)
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
  benchmark::RegisterBenchmark("first_frame/baked_warm", FirstFrame, LightMode::baked)
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
