// Pinhole views that cover the rays of a lens: the render targets of the triangles. Private to sim/render.
// Units: tangents: x / z and y / z of a direction in the view's own axes.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "sim/sensor/camera.h"

namespace sim {

constexpr int kFaceCount = 6;  // of a cube about the eye: +z, -z, +x, -x, +y, -y

// The face that a direction goes through, and the directions, by rows, that are its right, its down and what it looks
// along (left-handed for every other face).
int FaceOf(const glm::vec3& direction);
glm::mat3 FaceFromCamera(int face);

// Near plane, along the view's axis [m]; what is nearer is not seen. Depth is reversed: kNear / z, 1 at the near plane,
// 0 at infinity. In 32-bit floats its error is 1e-7 z relative far from the near plane; for a triangle that reaches up
// to the near plane it is 1e-7 z / kNear.
constexpr float kNear = 0.01f;

// From a view's axes (x right, y down, z along) to clip space: `low` and `high` are the tangents of its corners.
glm::mat4 ClipFromView(const glm::vec2& low, const glm::vec2& high);

struct RasterView {
  int face = 0;
  glm::vec2 low{0.0f}, texel{1.0f};  // tangents: of the outer corner of the first texel, and the side of one
  int width = 0, height = 0;         // [texel]
  int x_begin = 0, x_end = 0, y_begin = 0, y_end = 0;  // the camera's pixels that may look into it
};

// The views of some rows of a picture.
struct RasterStrip {
  int begin = 0, end = 0;  // rows
  std::vector<RasterView> views;
};

struct RasterViews {
  bool one_face = true;  // every ray goes through the face +z
  bool exact = true;     // a pinhole: the views' texels are the pixels
  std::vector<RasterStrip> strips;
  int width = 0, height = 0;       // the most of any view
  std::vector<glm::vec4> corners;  // rays in C of the pixels' corners, (camera width + 1) a row; w: nothing
};

// A pinhole's view is its picture. Any other lens has one view a strip where its rays are within 50 degrees of the
// axis, else one for each visible face of the cube; their texels are at most half as wide as the narrowest pixel, so
// that an edge is off by a quarter of a pixel at most, and surfaces between edges not at all. margin: by how much, in
// tangents, rays may leave the lens's own because of the aperture; used for faces of a cube only. Throws
// std::invalid_argument when a view would need more than `longest_side` texels a side or 2^26 in all.
RasterViews MakeRasterViews(const Camera& camera, int strip_rows, double margin, int longest_side);

}  // namespace sim
