#include "sim/render/rasteriser.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "sim/render/gl_context.h"
#include "sim/render/gl_objects.h"
#include "sim/render/raster_light.h"
#include "sim/render/raster_scene.h"
#include "sim/render/raster_shaders.h"
#include "sim/render/raster_view.h"
#include "sim/render/sample_pattern.h"
#include "sim/world/mesh_loader.h"
#include "tools/base/text.h"

namespace sim {
namespace {

void Check(const RasteriserOptions& o) {
  std::vector<std::string> problems;
  const auto within = [&](int value, int low, int high, const char* name) {
    if (value >= low && value <= high) return;
    problems.push_back(std::string(name) + " = " + std::to_string(value) + " must lie in " + std::to_string(low) +
                       " ... " + std::to_string(high));
  };
  within(o.rays_per_time_sample, 1, 4096, "rays_per_time_sample");
  within(o.shadow_map_side, 16, 8192, "shadow_map_side");
  within(o.strip_rows, 1, 1 << 14, "strip_rows");
  if (!problems.empty()) throw std::invalid_argument("rasteriser: " + base::Join(problems, "; "));
}

// Elements of the scene that are not rendered, a sentence for each kind.
std::vector<std::string> UnsupportedFeatures(const Scene& scene) {
  WarningList materials;
  const auto is_ambient = [](const Light& light) { return std::holds_alternative<AmbientLight>(light); };
  const bool has_direction = !std::ranges::all_of(scene.lights, is_ambient);
  for (const Material& m : scene.materials) {
    const std::string who = "material '" + m.name + "': ";
    if (m.normal_map >= 0 && has_direction) materials.Add(who, "normal maps are not rendered");
    if (m.emission_texture >= 0) materials.Add(who, "of pictures that shine only the mean is rendered");
    if (IsCutOut(scene, m)) materials.Add(who, "nothing is cut out of surfaces");
  }
  std::vector<std::string> features = materials.Summed();
  bool has_flicker = false, has_visible = false;
  for (const Light& lamp : scene.lights) {
    const auto* rect = std::get_if<RectLight>(&lamp);
    has_visible = has_visible || (rect != nullptr && rect->visible);
    has_flicker = has_flicker || FlickerOf(lamp).depth > 0;
  }
  const auto any_one_sided = [](const auto& of) { return std::ranges::any_of(of.meshes, &Mesh::one_sided); };
  if (any_one_sided(scene) || std::ranges::any_of(scene.objects, any_one_sided))
    features.emplace_back("of faces that coincide one is seen from both sides");
  if (has_flicker) features.emplace_back("lamps do not flicker");
  if (has_visible) features.emplace_back("visible lamps are not seen");
  if (scene.sky) features.emplace_back("the sky is not seen; world.background is");
  return features;
}

// Moves points to a mean in the middle, so that the picture is not shifted.
void Centre(std::vector<glm::dvec2>& points) {
  glm::dvec2 mean(0.0);
  for (const glm::dvec2& point : points) mean += point / static_cast<double>(points.size());
  for (glm::dvec2& point : points) point -= mean;
}

// Point in the pixel of sample i of n, from its middle [px]: the ray tracer's pattern, centred.
std::vector<glm::vec2> Jitter(int count, bool jitter) {
  std::vector<glm::dvec2> points(static_cast<std::size_t>(count), glm::dvec2(0.0));
  for (std::uint32_t i = 0; jitter && i < points.size(); ++i)
    points[i] = {ToUnit(SobolPoint(i).u), ToUnit(SobolPoint(i).v)};
  Centre(points);
  return {points.begin(), points.end()};
}

// Point on the lens, in its radii, of sample i of n: the ray tracer's points, which it turns from pixel to pixel,
// centred.
std::vector<glm::dvec2> LensPoints(int count) {
  std::vector<glm::dvec2> points = DiscPoints(count);
  Centre(points);
  return points;
}

// All OpenGL objects of the rasteriser and the operations on them: only while the context is current.
class Drawing {
 public:
  Drawing(const GlApi& gl, const Scene& scene, const RasteriserOptions& options)
      : gl_(gl),
        options_(options),
        lights_(scene.lights),
        background_(scene.background),
        triangles_(gl, "triangles", kTriangleVertex, kNumberFragment),
        depth_(gl, "depth", kTriangleVertex, kNothingFragment),
        shade_(gl, "shade", kScreenVertex, ShadeFragment()),
        scene_(gl, scene),
        shadows_(gl, options.shadow_map_side),
        screen_array_(MakeVertexArray(gl)) {
    gl_.GetIntegerv(GL_MAX_TEXTURE_SIZE, &longest_side_);
    for (const Light& light : lights_) {
      if (const auto* ambient = std::get_if<AmbientLight>(&light)) ambient_ += glm::vec3(ambient->radiance);
    }
  }

  void Expose(const Camera& camera, const Trajectory& motion, const Exposure& exposure, RadianceImage& out) {
    const int count = exposure.time_samples * options_.rays_per_time_sample;
    Prepare(camera, exposure.row_delay_s != 0 ? options_.strip_rows : camera.height(),
            exposure.aperture_m / exposure.focus_m);
    gl_.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    gl_.DepthFunc(GL_GREATER);
    gl_.Enable(GL_SCISSOR_TEST);
    const std::vector<glm::vec2> jitter = Jitter(count, options_.jitter);
    const std::vector<glm::dvec2> lens = LensPoints(count);
    const std::vector<glm::dvec2> on_light = PointsOnLight(count);
    std::vector<std::vector<RasterLight>> lights;
    std::vector<RasterLight> table;
    const double part_s = exposure.exposure_s / count;
    const auto moment = [&](double middle_s, int i) { return middle_s + part_s * (i + 0.5 - 0.5 * count); };
    for (int i = 0; i < count; ++i) {
      scene_.Move(moment(exposure.middle_s, i));
      lights.push_back(LightsOfSample(lights_, on_light[static_cast<std::size_t>(i)], scene_));
      table.insert(table.end(), lights.back().begin(), lights.back().end());
    }
    if (options_.shadows && !scene_.moves()) shadows_.Draw(scene_, depth_, lights);
    const BufferTexture light_table(gl_, GL_RGBA32F, table, "the lights", sizeof(RasterLight) / sizeof(glm::vec4));
    const GlObject target = MakeFramebuffer(gl_), sum = MakeTexture(gl_, GL_RGBA32F, camera.width(), camera.height());
    Attach(target, sum);
    gl_.Scissor(0, 0, camera.width(), camera.height());
    const glm::vec4 nothing(0.0f);
    gl_.ClearNamedFramebufferfv(target.id(), GL_COLOR, 0, &nothing[0]);

    shade_.Use();
    shade_.Set("materials", Bind(3, scene_.materials()));
    shade_.Set("levels", Bind(4, scene_.levels()));
    shade_.Set("texels", Bind(5, scene_.texels()));
    shade_.Set("lights", Bind(6, light_table.texture.id()));
    shade_.Set("light_count", static_cast<int>(lights[0].size()));
    shade_.Set("ambient", ambient_);
    shade_.Set("background", background_);
    shade_.Set("shadows", options_.shadows ? 1 : 0);
    shade_.Set("share", options_.jitter ? 1.0f / std::sqrt(static_cast<float>(count)) : 1.0f);
    shade_.Set("inverse_focus", static_cast<float>(1 / exposure.focus_m));
    for (int i = 0; i < count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (options_.shadows && scene_.moves()) {
        scene_.Move(moment(exposure.middle_s, i));
        shadows_.DrawSample(scene_, depth_, lights[k]);
      }
      const glm::vec2 lens_C(0.5 * exposure.aperture_m * lens[k]);
      for (const RasterStrip& strip : views_.strips) {
        const double t_s = moment(exposure.RowMiddle(0.5 * (strip.begin + strip.end - 1), camera.height()), i);
        const Pose pose = motion.At(t_s).pose;
        scene_.Move(t_s);
        const glm::dmat3 rotation = glm::mat3_cast(pose.q_WC);
        const glm::vec3 origin(pose.p_WC + rotation * glm::dvec3(lens_C, 0.0));
        for (const RasterView& still : strip.views) {
          const RasterView view = Moved(still, jitter[k], -lens_C / static_cast<float>(exposure.focus_m));
          DrawView(view, glm::mat3(rotation), origin);
          shade_.Use();
          SetLookUp(shade_, view, glm::mat3(rotation), origin, jitter[k], lens_C);
          shade_.Set("first_light", 6 * i * static_cast<int>(lights[0].size()));
          shade_.Set("lasting_shadows", Bind(7, shadows_.lasting()));
          shade_.Set("sample_shadows", Bind(8, shadows_.of_sample(scene_.moves() ? 0 : k)));
          gl_.Enable(GL_BLEND);
          gl_.BlendFunc(GL_ONE, GL_ONE);
          DrawPixels(target, camera, view);
          gl_.Disable(GL_BLEND);
        }
      }
    }
    Read(camera, 1.0f / static_cast<float>(count), out);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
  }

 private:
  static std::string ShadeFragment() {
    std::string text = kShadeFragment;
    const std::size_t at = text.find("NEAR");
    return text.replace(at, 4, std::to_string(kNear));
  }

  // Views and their target of a camera, kept for the next frame of the same.
  void Prepare(const Camera& camera, int strip_rows, double margin) {
    const CameraParams& p = camera.params();
    const auto key = std::tuple(p.width, p.height, p.fx, p.fy, p.cx, p.cy, p.k1, p.k2, p.p1, p.p2, p.k3, p.k4, p.lens,
                                strip_rows, margin);
    if (key_ && *key_ == key) return;
    key_.reset();
    views_ = MakeRasterViews(camera, strip_rows, margin, longest_side_);
    rays_ = MakeTexture(gl_, GL_RGBA32F, p.width + 1, p.height + 1);
    gl_.TextureSubImage2D(rays_.id(), 0, 0, 0, p.width + 1, p.height + 1, GL_RGBA, GL_FLOAT, views_.corners.data());
    view_numbers_ = MakeTexture(gl_, GL_R32I, views_.width, views_.height);
    view_depth_ = MakeTexture(gl_, GL_DEPTH_COMPONENT32F, views_.width, views_.height);
    view_target_ = MakeFramebuffer(gl_);
    gl_.NamedFramebufferTexture(view_target_.id(), GL_DEPTH_ATTACHMENT, view_depth_.id(), 0);
    Attach(view_target_, view_numbers_);
    CheckGl(gl_, "targets of the camera");
    key_ = key;
  }

  void Attach(const GlObject& target, const GlObject& texture) const {
    gl_.NamedFramebufferTexture(target.id(), GL_COLOR_ATTACHMENT0, texture.id(), 0);
    gl_.NamedFramebufferDrawBuffer(target.id(), GL_COLOR_ATTACHMENT0);
    gl_.NamedFramebufferReadBuffer(target.id(), GL_COLOR_ATTACHMENT0);
    const GLenum status = gl_.CheckNamedFramebufferStatus(target.id(), GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
      throw std::runtime_error("rasteriser: this OpenGL cannot draw into such a target, status " +
                               std::to_string(status));
  }

  GLint Bind(int unit, GLuint texture) const {
    gl_.BindTextureUnit(static_cast<GLuint>(unit), texture);
    return unit;
  }

  // A sample's view: its texels' centres are the rays of a pinhole.
  RasterView Moved(RasterView view, const glm::vec2& jitter, const glm::vec2& by_lens) const {
    view.low += jitter * view.texel + (views_.one_face ? by_lens : glm::vec2(0.0f));
    return view;
  }

  void DrawView(const RasterView& view, const glm::mat3& rotation, const glm::vec3& origin) const {
    const GLint none[4] = {};
    gl_.Scissor(0, 0, view.width, view.height);
    gl_.ClearNamedFramebufferiv(view_target_.id(), GL_COLOR, 0, none);
    const glm::ivec2 size(view.width, view.height);
    const glm::vec2 high = view.low + view.texel * glm::vec2(size);
    scene_.Draw(triangles_, view_target_, size, origin,
                ClipFromView(view.low, high) * glm::mat4(FaceFromCamera(view.face) * glm::transpose(rotation)));
  }

  void SetLookUp(const Program& program, const RasterView& view, const glm::mat3& rotation, const glm::vec3& origin,
                 const glm::vec2& jitter, const glm::vec2& lens) const {
    program.Set("rays", Bind(0, rays_.id()));
    program.Set("numbers", Bind(1, view_numbers_.id()));
    program.Set("view_face", view.face);
    program.Set("only_own_face", views_.one_face ? 0 : 1);
    program.Set("exact", views_.exact ? 1 : 0);
    program.Set("triangles", Bind(2, scene_.triangles()));
    program.Set("texels_per_triangle", scene_.texels_per_triangle());
    program.Set("rotation", rotation);
    program.Set("origin", origin);
    program.Set("view_low", view.low);
    program.Set("view_texel", view.texel);
    program.Set("view_size", glm::ivec2(view.width, view.height));
    program.Set("jitter", jitter);
    program.Set("lens", lens);
  }

  void DrawPixels(const GlObject& target, const Camera& camera, const RasterView& view) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target.id());
    gl_.Viewport(0, 0, camera.width(), camera.height());
    gl_.Scissor(view.x_begin, view.y_begin, view.x_end - view.x_begin, view.y_end - view.y_begin);
    gl_.Disable(GL_DEPTH_TEST);
    gl_.BindVertexArray(screen_array_.id());
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  }

  void Read(const Camera& camera, float scale, RadianceImage& out) const {
    out.width = camera.width();
    out.height = camera.height();
    const std::size_t pixels = static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
    out.rgb.resize(3 * pixels);
    gl_.PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl_.ReadPixels(0, 0, out.width, out.height, GL_RGB, GL_FLOAT, out.rgb.data());
    CheckGl(gl_, "reading the picture");
    for (float& value : out.rgb) value *= scale;
  }

  const GlApi& gl_;
  RasteriserOptions options_;
  std::vector<Light> lights_;
  glm::vec3 ambient_{0.0f}, background_;
  Program triangles_, depth_, shade_;
  RasterScene scene_;
  ShadowMaps shadows_;
  GlObject screen_array_;
  GLint longest_side_ = 0;

  std::optional<std::tuple<int, int, double, double, double, double, double, double, double, double, double, double,
                           Lens, int, double>>
      key_;
  RasterViews views_;
  GlObject rays_, view_numbers_, view_depth_, view_target_;
};

class Rasteriser final : public Renderer {
 public:
  Rasteriser(const Scene& scene, const RasteriserOptions& options) : context_(MakeGlContext(options.platform)) {
    const GlContext::Current current(*context_);
    drawing_ = std::make_unique<Drawing>(context_->gl(), scene, options);
  }
  ~Rasteriser() override {
    try {
      const GlContext::Current current(*context_);
      drawing_.reset();
    } catch (...) {  // freed with the context
      static_cast<void>(drawing_.release());
    }
  }

  void Expose(const Camera& camera, const Trajectory& motion, const Exposure& exposure, std::uint64_t /*key*/,
              RadianceImage& out) const override {
    const std::vector<std::string> problems = Problems(exposure);
    if (!problems.empty()) throw std::invalid_argument("Expose: " + base::Join(problems, "; "));
    const GlContext::Current current(*context_);
    drawing_->Expose(camera, motion, exposure, out);
  }

 private:
  std::unique_ptr<GlContext> context_;
  std::unique_ptr<Drawing> drawing_;
};

}  // namespace

std::unique_ptr<Renderer> MakeRasteriser(const Scene& scene, const RasteriserOptions& options,
                                         std::vector<std::string>* warnings) {
  Check(options);
  auto rasteriser = std::make_unique<Rasteriser>(scene, options);
  if (warnings != nullptr) {
    for (const std::string& feature : UnsupportedFeatures(scene)) warnings->push_back("rasteriser: " + feature);
  }
  return rasteriser;
}

}  // namespace sim
