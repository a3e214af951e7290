// Packet kernel, the inner loop of the ray tracer: its data in plain arrays, sixteen rays at a time. Private to
// sim/render.
//
// The loop (packet.inc) is compiled several times, for several instruction sets; PacketKernels() lists those of this
// machine. Those files must therefore not use inline functions of other headers: the linker keeps only one copy of such
// a function, perhaps one with instructions that this machine lacks.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/render/embree.h"

namespace sim {

constexpr int kLanes = 16;
constexpr int kBlockSide = 4;  // a packet is a block of 4 x 4 pixels

struct alignas(64) Lanes {
  float v[kLanes];
};
struct alignas(64) LaneInts {
  std::int32_t v[kLanes];
};

// value(u, v) = value_0 + u (value_1 - value_0) + v (value_2 - value_0): corner 0, and the differences of corners 1 and
// 2 to it.
template <int kSize>
struct OverTriangle {
  float first[kSize], du[kSize], dv[kSize];
};

// Shading data of a triangle, half a cache line.
struct alignas(32) TriangleShading {
  OverTriangle<2> uv;  // texture coordinates
  // Low 24 bits: the material; then 4 bits each: log2 of the baked light's resolution on the front and on the back
  // (sim/render/baked_light.h)
  std::uint32_t material;
  std::int32_t first_light;  // in a layer of PacketScene::light: the front's samples, then the back's
};
constexpr std::uint32_t kMaterialBits = 24;
// Unit vectors in the triangle's plane, to the right and up in its picture; 0 where it has none.
struct TriangleTangents {
  float right[3], up[3];
};
// A picture: its finest level, in PacketScene::levels, and how many there are.
struct PictureShading {
  std::int32_t first_level, level_count;
};
struct MaterialShading {
  float base_color[3], emission[3];
  PictureShading color, emission_picture, normal_map;  // where there is none: a white texel, a flat normal
  float normal_scale;
};
// Specular reflection of a material by glTF's model: a metal reflects its base colour, other surfaces reflect 4 %.
struct GlossShading {
  float metallic, roughness;  // times the picture's blue and green
  PictureShading picture;
  std::int32_t mirrors;  // -1, or 0: Lambert alone
};
// A one-sided rectangular lamp, as seen in reflections. A point of its plane is corner + a u + b v with
// a = dual_u . (point - corner), b likewise.
struct LampShading {
  float corner[3], normal[3], dual_u[3], dual_v[3], radiance[3];
  std::int32_t layer;  // of RaySample::layer_factors
};
struct LevelShading {
  std::uint32_t size;           // width | height << 16
  const std::uint32_t* texels;  // sim/world/texture.h's coding; rows are width + 1 long
};

// Radiance of rays that meet no surface. With a picture: of all directions, sim/world/sky.h.
struct SkyShading {
  float zenith[3], horizon[3], ground[3];  // blended by the direction's y
  const float* picture;                    // null, or rgb; rows are width + 1 long, the first pixel again at the end
  std::int32_t width, height;
  float turn;  // added to the horizontal coordinate, in turns
};

struct PacketScene {
  RTCScene embree;
  std::int32_t filtered_first;       // the triangle with number 0 in Embree's second geometry, that with filters
  const TriangleShading* triangles;  // by triangle
  const OverTriangle<3>* normals;    // by triangle; null: all flat
  const OverTriangle<3>* colors;     // by triangle; null: no vertex colours anywhere
  const TriangleTangents* tangents;  // by triangle; null: no normal maps anywhere
  const MaterialShading* materials;
  const LevelShading* levels;
  const std::uint32_t*
      light;  // baked, as PackShared (sim/render/baked_light.h) does, layer after layer; null: ambient light
  std::int32_t light_layers, light_stride;
  bool any_emission, any_emission_picture;
  const GlossShading* gloss;  // by material; null: nothing mirrors
  const LampShading* lamps;   // only where something does
  std::int32_t lamp_count;
  float ambient[3];
  SkyShading sky;
};

// Moving objects during an exposure. Embree's time runs from 0 to 1 over the exposure of all rows.
struct PacketObjects {
  RTCScene embree;                      // an instance for each object, numbered as Scene::objects
  const std::int32_t* first_triangles;  // by 2 * object + Embree's geometry in it
  const float* turns;                   // R_WO by columns, at `steps` times of each object; straight in between
  std::int32_t steps;
  bool own_lamps;  // lamps shine on objects alone: all else has their light baked
};

constexpr int kMaxLightLayers = 8;

// One light at one time sample. Irradiance at distance vector l, of length r, on a surface with normal n:
//   directional:         power * max(0, n . (x, y, z))
//   from point (x, y, z): power * max(0, n . l / r) / r^2, times max(0, -normal . l / r) when one_sided
struct LightSample {
  float place[3];  // (x, y, z) in W: towards the light (unit), or its position
  float power[3];
  float normal[3];
  bool directional, one_sided;
  std::int32_t layer;  // of RaySample::layer_factors
};

// One ray of each pixel, at a moment between the two ends of the sample's time: the camera is at (rotation, origin) at
// its beginning and at (rotation + turn, origin + way) at its end. Columns of rotation: the camera's axes in W. In
// between both are taken as straight, which turns a ray by (angle of the turn)^2 / 8 at most.
struct RaySample {
  float rotation[3][3], turn[3][3];  // R_WC, by columns
  float origin[3], way[3];           // p_WC
  std::uint32_t point_u, point_v;    // of the pixel's pattern, as 32-bit fractions
  float lens[2], inverse_focus;      // point of the lens in C [m], to be turned about the axis; 1 / Z of what is sharp
  float moment;                      // in [0, 1): see PixelBlock
  const LightSample* lights;
  int light_count;
  float layer_factors[kMaxLightLayers]
                     [kBlockSide];      // of lamps' light and of baked light, by layer and by row of the block
  const PacketObjects* objects;         // null: nothing moves; the same in all samples of a call
  float objects_begin, objects_length;  // Embree's time at the sample's beginning, and how much of it the sample is
};

// A block of pixels: (x, y, z) is a pixel centre's ray in C; du, dv are its derivatives by the pixel.
struct PixelBlock {
  Lanes x, y, z, x_du, x_dv, y_du, y_dv, z_du, z_dv;
  Lanes width;  // of the pixel: sqrt of |det(ray, ray_du, ray_dv)|, so that a surface at `ray * t` which faces it has t
                // width
  // A sample's time runs from 0 to 1. Of it the pixel's row looks at row_begin ... row_begin + row_part, and the
  // pixel's ray at the fraction `moment` + RaySample::moment of that, less 1 where it is not below.
  Lanes row_begin, moment;
  float row_part;
  Lanes lens_cos, lens_sin;         // the turn of the lens's points
  LaneInts valid;                   // -1: there is such a pixel, 0: not
  LaneInts scramble_u, scramble_v;  // random bits by pixel, exclusive-ored to the pattern
};

// Adds up the radiance of the block's pixels over `samples`. 0 < share <= 1: the side of a ray's part of the pixel.
using ExposeBlockFunction = void (*)(const PacketScene& scene, const RaySample* samples, int count, bool jitter,
                                     float share, const PixelBlock& block, Lanes sum[3]);

// PixelScramble (sim/render/sample_pattern.h) of the pixels of a block: its point's u and v, its time, its turn.
struct BlockBits {
  LaneInts word[4];
};
using ScrambleBlockFunction = void (*)(std::uint64_t key, std::uint32_t x0, std::uint32_t y0, BlockBits& bits);

struct KernelChoice {
  ExposeBlockFunction expose_block;
  ScrambleBlockFunction scramble_block;
  const char* name;
};
// Those that this machine can run; the fastest is the last.
std::vector<KernelChoice> PacketKernels();

}  // namespace sim
