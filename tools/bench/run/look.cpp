#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <memory>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "sim/motion/path.h"
#include "sim/motion/placement.h"
#include "sim/render/ray_scene.h"
#include "sim/render/ray_tracer.h"
#include "sim/render/scene_surroundings.h"
#include "sim/scenario/readers.h"
#include "sim/sensor/sensor.h"
#include "sim/world/scene.h"
#include "tools/base/files.h"
#include "tools/bench/errors.h"
#include "tools/bench/run/commands.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/experiment.h"

namespace vobench {
namespace {

constexpr int kWidth = 480, kHeight = 360, kLabel = 22, kGap = 8, kColumns = 3;
constexpr double kFocal = 394;  // 63 degrees across

struct LabelledView {
  sim::Pose pose;
  std::string label;
  bool cut_away = false;
};

sim::Pose Towards(const glm::dvec3& from, const glm::dvec3& to) { return {from, sim::LookAt(from, to, 0)}; }

// Removes the triangles whose back faces the point: of a room seen from outside, near walls and ceiling.
sim::Scene CutAway(sim::Scene scene, const glm::dvec3& from) {
  for (sim::Mesh& mesh : scene.meshes) {
    std::erase_if(mesh.triangles, [&](const glm::uvec3& t) {
      const glm::vec3 a = mesh.positions[t.x];
      return glm::dot(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a), glm::vec3(from) - a) <= 0;
    });
  }
  std::erase_if(scene.meshes, [](const sim::Mesh& mesh) { return mesh.triangles.empty(); });
  scene.background = glm::vec3(0);
  return scene;
}

// Of 400 random places in the world's box, level views of the largest visual interest, not too near to surfaces; a
// fifth of the box apart.
std::vector<LabelledView> Inside(const sim::Surroundings& around) {
  constexpr int kPlaces = 400;
  constexpr std::size_t kViews = 3;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  const glm::dvec3 low = around.low(), size = around.high() - low;
  const double extent = glm::length(size);
  std::vector<std::pair<double, sim::Pose>> found;
  for (int i = 0; i < kPlaces; ++i) {
    const double x = share(random), y = share(random), z = share(random),
                 heading = 2 * std::numbers::pi * share(random);
    const glm::dvec3 p = low + size * glm::dvec3(x, 0.3 + 0.4 * y, z),
                     ahead(std::cos(heading), -0.15, std::sin(heading));
    if (around.Nearest(p, 0.05 * extent)) continue;
    const sim::Pose view = Towards(p, p + ahead);
    const auto hit = around.Between(p, p + extent * ahead);
    const double depth = hit ? glm::distance(hit->point, p) : 0;
    found.emplace_back(around.Interest(view) * std::min(depth, 0.4 * extent), view);
  }
  std::ranges::sort(found, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<LabelledView> views;
  for (const auto& [worth, view] : found) {
    const auto near = [&, at = view.p_WC](const LabelledView& of) {
      return glm::distance(of.pose.p_WC, at) < 0.2 * extent;
    };
    if (views.size() < kViews && worth > 0 && std::ranges::none_of(views, near))
      views.push_back({view, "from " + sim::FormatPlace(view.p_WC)});
  }
  return views;
}

struct Still : sim::Trajectory {
  explicit Still(const sim::Pose& at) : pose(at) {}
  sim::Motion At(double) const override { return {.pose = pose}; }
  sim::Pose pose;
};

sim::RadianceImage Radiance(const sim::Renderer& renderer, const sim::Pose& pose) {
  const sim::Camera camera({.width = kWidth,
                            .height = kHeight,
                            .fx = kFocal,
                            .fy = kFocal,
                            .cx = 0.5 * (kWidth - 1),
                            .cy = 0.5 * (kHeight - 1)});
  sim::RadianceImage radiance;
  renderer.Expose(camera, Still(pose), {.time_samples = 4}, 1, radiance);
  return radiance;
}

// Mean over non-black pixels; 0 where all are black.
double MeanLuminance(const sim::RadianceImage& radiance) {
  double sum = 0, count = 1e-9;
  for (std::size_t i = 0; i < radiance.rgb.size(); i += 3) {
    const float luminance = sim::Luminance(&radiance.rgb[i]);
    sum += luminance, count += luminance > 0;
  }
  return sum / count;
}

// Without noise; the mean luminance becomes a quarter of white.
cv::Mat Picture(const sim::RadianceImage& radiance) {
  sim::SensorParams sensor;
  sensor.shot_noise = false;
  sensor.read_noise_e = 0;
  const double mean = MeanLuminance(radiance);
  sim::Image image =
      sim::Sensor(sensor, 1).Capture(radiance, 0, sim::ExposureSetting{sensor.exposure_s, mean > 0 ? 0.25 / mean : 1});
  cv::Mat picture;
  cv::cvtColor(cv::Mat(kHeight, kWidth, CV_8UC3, image.data.data()), picture, cv::COLOR_RGB2BGR);
  return picture;
}

}  // namespace

void Look(const LookOptions& options) {
  if (options.output.extension() != ".png") throw BadInput(options.output.string() + ": its name must end in '.png'");
  sim::Scenario scenario = ReadExperiment(options.scenario, options.overrides).scenario;
  if (scenario.points) throw BadInput(options.scenario.string() + ": a world of points has no pictures");
  sim::Scene scene = Input([&] { return sim::LoadScene(scenario.world); });
  auto rays = std::make_unique<sim::RayScene>(scene);
  const auto around = sim::SurroundingsOf(scene, *rays);
  PrintWarnings(scene.warnings);

  std::vector<LabelledView> views;
  try {
    const double end_s = sim::Seconds(sim::StampNs(sim::CountFrames(scenario.time) - 1, scenario.time));
    const auto path = sim::MakeTrajectory(scenario.motion, scenario.seed, end_s, 0.1, around.get());
    for (const double t_s : {0.0, 0.5 * end_s, end_s})
      views.push_back({path->At(t_s).pose, fmt::format("the path at {:.2f} s", t_s)});
    sim::RequireFree(*path, end_s, *around);
  } catch (const std::invalid_argument& error) {
    PrintWarnings({std::string("trajectory: ") + error.what()});
  }
  std::ranges::move(Inside(*around), std::back_inserter(views));
  const glm::dvec3 middle = 0.5 * (around->low() + around->high());
  const double away = 0.45 * glm::distance(around->low(), around->high()) / std::sin(std::atan(0.5 * kHeight / kFocal));
  for (const auto& [where, side] : {std::pair("from outside", glm::dvec3(0.6, 0.75, 1)),
                                    {"from outside", {-1, 0.75, -0.6}},
                                    {"from above", {0, 1, 1e-3}}})
    views.push_back({Towards(middle + away * glm::normalize(side), middle), where + std::string(", cut away"), true});

  const int rows = (static_cast<int>(views.size()) + kColumns - 1) / kColumns;
  cv::Mat sheet(rows * (kHeight + kLabel + kGap) + kGap, kColumns * (kWidth + kGap) + kGap, CV_8UC3,
                cv::Scalar(255, 255, 255));
  auto whole = sim::MakeRayTracer(scene, std::move(rays), {});
  const auto is_ambient = [](const sim::Light& light) { return std::holds_alternative<sim::AmbientLight>(light); };
  if (std::ranges::none_of(scene.lights, is_ambient)) {  // in place of baked light: shadows would be black
    const double mean = MeanLuminance(Radiance(*whole, views.front().pose));
    if (mean == 0)
      PrintWarnings({"no light reaches the first view: ambient light of 1 is added here, but not in the scenario"});
    scene.lights.push_back(sim::AmbientLight{glm::dvec3(mean > 0 ? 0.5 * mean : 1.0)});
    whole = sim::MakeRayTracer(scene);
  }
  for (int i = 0; const auto& [pose, label, cut] : views) {
    const int x = kGap + i % kColumns * (kWidth + kGap), y = kGap + i / kColumns * (kHeight + kLabel + kGap);
    const auto part = cut ? sim::MakeRayTracer(CutAway(scene, pose.p_WC)) : nullptr;
    Picture(Radiance(cut ? *part : *whole, pose)).copyTo(sheet({x, y, kWidth, kHeight}));
    cv::putText(sheet, label, {x, y + kHeight + kLabel - 6}, cv::FONT_HERSHEY_SIMPLEX, 0.5, {60, 60, 60}, 1,
                cv::LINE_AA);
    ++i;
  }
  std::vector<unsigned char> png;
  cv::imencode(".png", sheet, png);
  base::WriteFile(options.output, std::string(png.begin(), png.end()));
  fmt::print("{}: {} views, by direct and ambient light\n", options.output.string(), views.size());
}

}  // namespace vobench
