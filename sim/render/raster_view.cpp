#include "sim/render/raster_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <stdexcept>
#include <string>

namespace sim {
namespace {

constexpr float kWidestTangent = 1.2f;  // of a single view: beyond, its border has ever more texels per pixel

bool IsPinhole(const CameraParams& c) {
  return c.lens == Lens::radial_tangential && c.k1 == 0 && c.k2 == 0 && c.p1 == 0 && c.p2 == 0 && c.k3 == 0;
}

glm::vec2 Tangents(const glm::vec3& ray, int face) {
  const glm::vec3 v = FaceFromCamera(face) * ray;
  return {v.x / v.z, v.y / v.z};
}

// Part of a face that some rays meet.
struct Box {
  glm::vec2 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};
  glm::ivec2 first{1 << 30}, last{-1};  // corners of pixels
  void Add(const glm::vec2& p, const glm::ivec2& corner) {
    low = glm::min(low, p), high = glm::max(high, p);
    first = glm::min(first, corner), last = glm::max(last, corner);
  }
  bool empty() const { return !(low.x <= high.x); }
};

class Corners {
 public:
  explicit Corners(const RasterViews& views, int width, int height)
      : views_(views), stride_(width + 1), height_(height) {}

  glm::vec3 At(int i, int j) const {
    return glm::vec3(
        views_.corners[static_cast<std::size_t>(j) * static_cast<std::size_t>(stride_) + static_cast<std::size_t>(i)]);
  }
  int Face(int i, int j) const { return views_.one_face ? 0 : FaceOf(At(i, j)); }

  // The shortest and the longest side of any pixel, as tangents of its face.
  glm::vec2 PixelSides() const {
    glm::vec2 sides(std::numeric_limits<float>::infinity(), 0.0f);
    const auto take = [&](const glm::vec3& a, const glm::vec3& b, int face) {
      const float side = glm::distance(Tangents(a, face), Tangents(b, face));
      sides = {std::min(sides.x, side), std::max(sides.y, side)};
    };
    for (int j = 0; j < height_; ++j) {
      for (int i = 0; i + 1 < stride_; ++i) {
        const int face = Face(i, j);
        if (Face(i + 1, j) == face) take(At(i, j), At(i + 1, j), face);
        if (Face(i, j + 1) == face) take(At(i, j), At(i, j + 1), face);
      }
    }
    return sides;
  }

  // Parts of each face met by some rows of pixels, enlarged by `reach` tangents.
  std::array<Box, kFaceCount> Boxes(int begin, int end, float reach) const {
    std::array<Box, kFaceCount> boxes;
    for (int j = begin; j <= end; ++j) {
      for (int i = 0; i < stride_; ++i) {
        for (int face = 0; face < (views_.one_face ? 1 : kFaceCount); ++face) {
          const glm::vec3 v = FaceFromCamera(face) * At(i, j);
          const bool is_near = v.z > 0 && std::max(std::abs(v.x), std::abs(v.y)) <= (1 + reach) * v.z;
          if (views_.one_face || is_near) boxes[static_cast<std::size_t>(face)].Add({v.x / v.z, v.y / v.z}, {i, j});
        }
      }
    }
    return boxes;
  }

 private:
  const RasterViews& views_;
  int stride_, height_;
};

}  // namespace

int FaceOf(const glm::vec3& d) {
  const glm::vec3 s = glm::abs(d);
  if (s.z >= s.x && s.z >= s.y) return d.z >= 0 ? 0 : 1;
  if (s.x >= s.y) return d.x >= 0 ? 2 : 3;
  return d.y >= 0 ? 4 : 5;
}

glm::mat3 FaceFromCamera(int face) {
  const int axis = face < 2 ? 2 : (face < 4 ? 0 : 1);
  glm::mat3 rows(0.0f);
  rows[0][(axis + 1) % 3] = 1.0f;
  rows[1][(axis + 2) % 3] = 1.0f;
  rows[2][axis] = face % 2 == 0 ? 1.0f : -1.0f;
  return glm::transpose(rows);
}

glm::mat4 ClipFromView(const glm::vec2& low, const glm::vec2& high) {
  glm::mat4 clip(0.0f);  // by columns
  clip[0][0] = 2.0f / (high.x - low.x);
  clip[1][1] = 2.0f / (high.y - low.y);
  clip[2][0] = -(high.x + low.x) / (high.x - low.x);
  clip[2][1] = -(high.y + low.y) / (high.y - low.y);
  clip[3][2] = kNear;
  clip[2][3] = 1.0f;
  return clip;
}

RasterViews MakeRasterViews(const Camera& camera, int strip_rows, double margin, int longest_side) {
  RasterViews out;
  const int width = camera.width(), height = camera.height();
  out.exact = IsPinhole(camera.params());
  out.corners.reserve((static_cast<std::size_t>(width) + 1) * (static_cast<std::size_t>(height) + 1));
  for (int j = 0; j <= height; ++j) {
    for (int i = 0; i <= width; ++i) {
      const glm::vec3 ray = camera.Ray(static_cast<float>(i) - 0.5f, static_cast<float>(j) - 0.5f);
      out.corners.emplace_back(ray, 0.0f);
      out.one_face = out.one_face && ray.z > 0 && std::max(std::abs(ray.x), std::abs(ray.y)) <= kWidestTangent * ray.z;
    }
  }
  out.one_face = out.one_face || out.exact;
  const Corners corners(out, width, height);
  const glm::vec2 pixel = out.exact ? glm::vec2(0.0f) : corners.PixelSides();
  const float texel = 0.5f * pixel.x;
  // Distance of a pixel's rays from its corners: the part of a face without a corner is drawn too.
  const float reach = 2 * pixel.y + (out.one_face ? 0.0f : static_cast<float>(margin));
  for (int begin = 0; begin < height; begin += strip_rows) {
    RasterStrip strip;
    strip.begin = begin;
    strip.end = std::min(begin + strip_rows, height);
    if (out.exact) {
      const CameraParams& p = camera.params();
      const glm::vec2 low((-0.5 - p.cx) / p.fx, (begin - 0.5 - p.cy) / p.fy), texel_side(1 / p.fx, 1 / p.fy);
      strip.views.push_back({0, low, texel_side, width, strip.end - begin, 0, width, begin, strip.end});
    } else {
      const std::array<Box, kFaceCount> boxes = corners.Boxes(strip.begin, strip.end, reach);
      for (int face = 0; face < kFaceCount; ++face) {
        const Box& box = boxes[static_cast<std::size_t>(face)];
        if (box.empty()) continue;
        const glm::vec2 low = box.low - reach, high = box.high + reach;
        const glm::dvec2 size = glm::ceil(glm::dvec2(high - low) / static_cast<double>(texel));
        if (!(size.x <= longest_side && size.y <= longest_side && size.x * size.y <= 67108864.0)) {
          throw std::invalid_argument(
              "rasteriser: this lens needs a picture of " + std::to_string(static_cast<long long>(size.x)) + " x " +
              std::to_string(static_cast<long long>(size.y)) +
              " texels, half as wide as its narrowest pixel; at most " + std::to_string(longest_side) +
              " a side and 2^26 in all are possible. The ray tracer has no such limit");
        }
        strip.views.push_back({face, low, glm::vec2(texel), static_cast<int>(size.x), static_cast<int>(size.y),
                               std::max(0, box.first.x - 1), std::min(width, box.last.x + 1),
                               std::max(begin, box.first.y - 1), std::min(strip.end, box.last.y + 1)});
      }
    }
    for (const RasterView& view : strip.views) {
      out.width = std::max(out.width, view.width);
      out.height = std::max(out.height, view.height);
    }
    out.strips.push_back(std::move(strip));
  }
  if (std::max({out.width, out.height, width + 1, height + 1}) > longest_side) {
    throw std::invalid_argument("rasteriser: a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                                " pixels is larger than this OpenGL's textures, " + std::to_string(longest_side) +
                                " a side");
  }
  return out;
}

}  // namespace sim
