// Purpose: the inner loop's data and its one entry, in plain arrays: sixteen rays at a time. Private to sim/render.
//
// The loop (packet.inc) is compiled several times, for several instruction sets, and PacketKernel() picks the best that
// this machine has. Those files must therefore not use inline functions of other headers: the linker keeps only one
// copy of such a function, perhaps the one that this machine cannot run.
#pragma once

#include <cstdint>

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

// What is looked up at a hit: the value at corner 0 and the differences of corners 1 and 2 to it, since
// value(u, v) = value_0 + u (value_1 - value_0) + v (value_2 - value_0).
struct TriangleShading {
  float normal[3], normal_du[3], normal_dv[3];
  float uv[2], uv_du[2], uv_dv[2];
  float texels_per_metre;  // of texture level 0, sqrt of (area in texels / area in W)
  std::int32_t material;
};
struct TriangleColor {
  float color[3], color_du[3], color_dv[3];
};
struct MaterialShading {
  float base_color[3], emission[3];
  std::int32_t first_level;  // in PacketScene::levels
  std::int32_t level_count;
};
struct LevelShading {
  std::int32_t width, height, first_texel;  // in PacketScene::texels
};

struct PacketScene {
  RTCScene embree;
  const TriangleShading* triangles;  // by primitive
  const TriangleColor* colors;       // by primitive; null: no vertex colours anywhere
  const MaterialShading* materials;
  const LevelShading* levels;
  const std::uint32_t* texels;  // sim/world/texture.h's coding
  float ambient[3], background[3];
};

// One light as one time sample sees it. Irradiance at distance vector l, of length r, on a surface with normal n:
//   directional:         power * max(0, n . (x, y, z))
//   from point (x, y, z): power * max(0, n . l / r) / r^2, times max(0, -normal . l / r) when one_sided
struct LightSample {
  float x, y, z;  // W: towards the light (unit), or its position
  float power[3];
  float normal[3];
  bool directional, one_sided;
};

// One ray of each pixel, at a moment between the two ends of the sample's time: the camera is at (rotation, origin) at
// its beginning and at (rotation + turn, origin + way) at its end. Columns of rotation: the camera's axes in W. In
// between both are taken as straight, which turns a ray by (angle of the turn)^2 / 8 at most.
struct RaySample {
  float rotation[3][3], turn[3][3];  // R_WC, by columns
  float origin[3], way[3];           // p_WC
  std::uint32_t point_u, point_v;    // of the pixel's pattern, as 32-bit fractions
  float lens[2], inverse_focus;      // point of the lens in C [m], to be turned about the axis; 1 / Z of what is sharp
  const LightSample* lights;
  int light_count;
};

// A block of pixels: (x, y, z) is a pixel centre's ray in C; du, dv are its derivatives by the pixel.
struct PixelBlock {
  Lanes x, y, z, x_du, x_dv, y_du, y_dv, z_du, z_dv;
  Lanes width;  // of the pixel: sqrt of |det(ray, ray_du, ray_dv)|, so that a surface at `ray * t` which faces it has t
                // width
  Lanes time;   // of the pixel's rays: 0 at the beginning of each sample's time, 1 at its end
  Lanes lens_cos, lens_sin;         // the turn of the lens's points
  LaneInts valid;                   // -1: there is such a pixel, 0: not
  LaneInts scramble_u, scramble_v;  // random bits by pixel, exclusive-ored to the pattern
};

// Adds up the radiance of the block's pixels over `samples`. share: the side of a ray's part of the pixel, 0 < share
// <= 1.
using ExposeBlockFunction = void (*)(const PacketScene& scene, const RaySample* samples, int count, bool jitter,
                                     float share, const PixelBlock& block, Lanes sum[3]);

struct KernelChoice {
  ExposeBlockFunction expose_block;
  const char* name;
};
KernelChoice PacketKernel();

namespace packet_base {
void ExposeBlock(const PacketScene&, const RaySample*, int, bool, float, const PixelBlock&, Lanes[3]);
}
namespace packet_avx2 {
void ExposeBlock(const PacketScene&, const RaySample*, int, bool, float, const PixelBlock&, Lanes[3]);
}
namespace packet_avx512 {
void ExposeBlock(const PacketScene&, const RaySample*, int, bool, float, const PixelBlock&, Lanes[3]);
}

}  // namespace sim
