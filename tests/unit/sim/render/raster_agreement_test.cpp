// Images of the rasteriser against those of the ray tracer.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "sim/scenario/scenario.h"
#include "source_dir.h"
#include "tests/unit/sim/render/engines.h"

namespace sim::test {
namespace {

// The demo's room, with textures on all surfaces.
const Scenario& Room() {
  static const Scenario room = LoadScenario(std::filesystem::path(VOBENCH_SOURCE_DIR) / "scenes/room.yaml");
  return room;
}
const Scene& RoomScene() {
  static const Scene scene = LoadScene(Room().world);
  return scene;
}

Scene Moved(Scene scene, const glm::vec3& by) {
  for (Mesh& mesh : scene.meshes) {
    for (glm::vec3& p : mesh.positions) p += by;
  }
  return scene;
}

// Two poses in the room, with near and far, flat and curved surfaces in view.
const std::array<Pose, 2> kPoses = {Pose{{2.0, 1.4, 2.6}, glm::normalize(glm::dquat(0.02, 1.0, 0.03, -0.12))},
                                    Pose{{3.4, 1.5, 2.9}, glm::normalize(glm::dquat(-0.1, 1.0, -0.35, -0.2))}};

CameraParams Pinhole() {
  CameraParams params;
  params.width = 320, params.height = 240;
  params.fx = params.fy = 262.5;
  params.cx = 159.5, params.cy = 119.5;
  return params;
}
CameraParams Distorted() {
  CameraParams params = Pinhole();
  params.k1 = -0.28, params.k2 = 0.09, params.p1 = 0.001, params.p2 = -0.0007;
  return params;
}
// 92 degrees from the axis in the corners: beyond one pinhole image.
CameraParams FisheyeParams() {
  CameraParams params = Pinhole();
  params.lens = Lens::fisheye;
  params.fx = params.fy = 120;
  params.k1 = 0.01, params.k2 = -0.002;
  return params;
}

using Values = std::vector<float>;

// Writes an image of a failed test; `white` is the value of white.
void Write(const std::string& name, int width, int height, int channels, const Values& values, double white) {
  cv::Mat picture(height, width, channels == 3 ? CV_8UC3 : CV_8UC1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t to = channels == 3 ? i - i % 3 + 2 - i % 3 : i;
    picture.data[to] = static_cast<unsigned char>(255.0 * std::clamp(values[i] / white, 0.0, 1.0) + 0.5);
  }
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "raster_agreement";
  std::filesystem::create_directories(folder);
  cv::imwrite((folder / (name + ".png")).string(), picture);
  ADD_FAILURE() << "see " << folder / (name + ".png");
}

// sRGB encoding, as in a file.
Values Coded(const RadianceImage& image) {
  Values out;
  for (const float value : image.rgb) {
    const double x = std::clamp(double{value}, 0.0, 1.0);
    out.push_back(static_cast<float>(x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055));
  }
  return out;
}

// Scene with a different radiance for each triangle, which labels the triangle at each pixel's centre.
Scene Labelled(Scene scene) {
  for (Material& material : scene.materials) {
    material = Material();
    material.base_color = glm::vec3(1.0f);
  }
  scene.lights = {AmbientLight{{1, 1, 1}}};
  std::uint32_t label = 0;
  for (Mesh& mesh : scene.meshes) {
    Mesh apart;
    apart.name = mesh.name, apart.material = mesh.material;
    for (const glm::uvec3& t : mesh.triangles) {
      const auto first = static_cast<std::uint32_t>(apart.positions.size());
      const std::uint32_t bits = ++label * 2654435761u;
      for (int c = 0; c < 3; ++c) {
        apart.positions.push_back(mesh.positions[t[c]]);
        apart.colors.emplace_back(bits >> 24, (bits >> 16) & 255u, (bits >> 8) & 255u);
      }
      apart.triangles.emplace_back(first, first + 1, first + 2);
    }
    mesh = apart;
  }
  return scene;
}

class RasterAgreement : public EngineTest {
 protected:
  // Share of pixels with another triangle: below `most`. Control: more than three times that with the scene 2 mm aside.
  void ExpectTriangles(const CameraParams& params, double most) {
    const Camera camera(params);
    const Scene labelled = Labelled(RoomScene());
    const auto traced = MakeRayTracer(labelled, Centred()), drawn = MakeEngine(GetParam(), labelled),
               shifted = MakeEngine(GetParam(), Moved(labelled, {0, 0, 0.002f}));
    for (std::size_t k = 0; k < kPoses.size(); ++k) {
      const Pose& pose = kPoses[k];
      const RadianceImage expected = sim::test::Render(*traced, camera, pose);
      const auto share = [&](const Renderer& renderer) {
        const RadianceImage image = sim::test::Render(renderer, camera, pose);
        int others = 0;
        for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
          bool is_other = false;
          for (std::size_t c = i; c < i + 3; ++c) is_other |= std::abs(image.rgb[c] - expected.rgb[c]) > 0.01f;
          others += is_other;
        }
        return 3.0 * others / static_cast<double>(image.rgb.size());
      };
      const double same = share(*drawn), control = share(*shifted);
      EXPECT_LT(same, most);
      EXPECT_GT(control, 3 * same);
      RecordProperty("share_" + std::to_string(k), std::to_string(same));
      RecordProperty("control_" + std::to_string(k), std::to_string(control));
    }
  }

  void ExpectPicture(const CameraParams& params, double least) {
    const Camera camera(params);
    const SteadyMotion still(kPoses[0]);
    const double psnr = PictureDistance(RoomScene(), camera, still, Exposure{}, Centred(), "sharp", least);
    EXPECT_GT(psnr, least);
    RecordProperty("psnr", std::to_string(psnr));
    // Controls: everything 2 mm aside; the textures upside down.
    const double aside =
        PictureDistance(Moved(RoomScene(), {0.002f, 0, 0}), camera, still, Exposure{}, Centred(), "", 0);
    EXPECT_LT(aside, least - 2);
    RecordProperty("aside", std::to_string(aside));
    Scene flipped = RoomScene();
    for (Mesh& mesh : flipped.meshes) {
      for (glm::vec2& uv : mesh.uvs) uv.y = -uv.y;
    }
    EXPECT_LT(PictureDistance(flipped, camera, still, Exposure{}, Centred(), "", 0), 30);
  }

  // PSNR [dB] between the ray tracer's and the engine's images of `exposure` along `motion`.
  double PictureDistance(const Scene& scene, const Camera& camera, const Trajectory& motion, const Exposure& exposure,
                         const RayTracerOptions& options, const std::string& name, double least) {
    RadianceImage a, b;
    MakeRayTracer(RoomScene(), options)->Expose(camera, motion, exposure, 1, a);
    MakeEngine(GetParam(), scene, options)->Expose(camera, motion, exposure, 1, b);
    const Values x = Coded(a), y = Coded(b);
    const double psnr = Psnr(x, y);
    if (psnr < least) {
      Values difference;
      for (std::size_t i = 0; i < x.size(); ++i) difference.push_back(std::abs(x[i] - y[i]));
      const std::string file = std::string(GetParam().name) + "_" + name;
      Write(file + "_ray_tracer", a.width, a.height, 3, x, 1.0);
      Write(file + "_rasteriser", a.width, a.height, 3, y, 1.0);
      Write(file + "_difference", a.width, a.height, 3, difference, 0.2);
    }
    return psnr;
  }
};

INSTANTIATE_TEST_SUITE_P(Engine, RasterAgreement, testing::Values(kEgl, kOsmesa), EngineName);

TEST_P(RasterAgreement, TrianglesThroughAPinhole) { ExpectTriangles(Pinhole(), 1e-3); }
TEST_P(RasterAgreement, TrianglesThroughADistortedLens) { ExpectTriangles(Distorted(), 6e-3); }
TEST_P(RasterAgreement, TrianglesThroughAFisheye) { ExpectTriangles(FisheyeParams(), 5e-3); }

// One ray through the middle of each pixel: differences at shadows and edges only.
TEST_P(RasterAgreement, SharpPicture) { ExpectPicture(Pinhole(), 42); }
TEST_P(RasterAgreement, SharpPictureThroughADistortedLens) { ExpectPicture(Distorted(), 35); }
TEST_P(RasterAgreement, SharpPictureThroughAFisheye) { ExpectPicture(FisheyeParams(), 35); }

// Motion blur, defocus and rolling shutter, with samples enough for negligible noise of the ray tracer.
TEST_P(RasterAgreement, BlurredPicture) {
  CameraParams params = Pinhole();
  params.width = 112, params.height = 84;
  params.fx = params.fy = 91.875;
  params.cx = 55.5, params.cy = 41.5;
  const Camera camera(params);
  const SteadyMotion motion(kPoses[0], {0.5, -0.2, 0.3}, {0.4, 0.6, -0.5});
  Exposure blur;
  blur.exposure_s = 0.03;
  blur.time_samples = 128;
  Exposure lens = blur;
  lens.aperture_m = 0.04, lens.focus_m = 1.5;
  Exposure rolling = blur;
  rolling.row_delay_s = 0.02 / 119;
  for (const auto& [exposure, name, least] :
       {std::tuple(blur, "blur", 42.0), {lens, "lens", 38.0}, {rolling, "rolling", 42.0}}) {
    const double psnr = PictureDistance(RoomScene(), camera, motion, exposure, {}, name, least);
    EXPECT_GT(psnr, least) << name;
    RecordProperty(name, std::to_string(psnr));
  }
  // Control: one renderer, with the exposure a tenth of its length late.
  Exposure late = blur;
  late.middle_s = 0.003;
  const auto engine = MakeEngine(GetParam(), RoomScene(), {});
  RadianceImage in_time, too_late;
  engine->Expose(camera, motion, blur, 1, in_time);
  engine->Expose(camera, motion, late, 1, too_late);
  const double control = Psnr(Coded(in_time), Coded(too_late));
  EXPECT_LT(control, 40);
  RecordProperty("control", std::to_string(control));
}

}  // namespace
}  // namespace sim::test
