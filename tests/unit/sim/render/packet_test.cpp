// Agreement of the inner loop's images between the instruction sets of this machine, up to rounding.
#include "sim/render/packet.h"

#include <gtest/gtest.h>

#include <vector>

#include "sim/render/placed_objects.h"
#include "sim/render/ray_scene.h"
#include "sim/render/sample_pattern.h"
#include "tests/unit/sim/render/moving_worlds.h"

namespace sim::test {
namespace {

// moving: the sphere is an object.
void ExpectInstructionSetsToAgree(bool moving) {
  Scene scene;
  std::vector<std::uint8_t> rgb;
  for (unsigned i = 0; i < 30 * 20 * 3; ++i) rgb.push_back(static_cast<std::uint8_t>((i * 2654435761u) >> 24));
  scene.textures.emplace_back("noise", 30, 20, rgb);
  AddMaterial(scene, {0.9f, 0.8f, 0.7f}, glm::vec3(0.1f), 0);
  AddMaterial(scene, {0.3f, 0.8f, 0.4f});
  AddQuad(scene, {-6, -6, 4}, {12, 0, 1}, {0, 12, 1}, 0, 3.0f);
  AddSphere(scene, {0.0, 0.0, 2.2}, 0.5, 20, 1);
  scene.lights = {AmbientLight{{0.1, 0.1, 0.1}}};
  if (moving) MakeObject(scene, 1, Carried());
  const RayScene rays(scene);
  const PlacedObjects placed(rays, 0.0, 0.1);

  LightSample lamp{};
  lamp.place[0] = 1, lamp.place[1] = -1, lamp.place[2] = 0;
  for (float& p : lamp.power) p = 9;
  RaySample samples[4]{};
  for (std::uint32_t i = 0; i < 4; ++i) {
    for (int c = 0; c < 3; ++c) samples[i].rotation[c][c] = 1, samples[i].way[c] = 0.02f;
    samples[i].moment = 0.3f * static_cast<float>(i);
    samples[i].turn[0][1] = 0.03f, samples[i].turn[1][0] = -0.03f;
    samples[i].point_u = SobolPoint(i).u;
    samples[i].point_v = SobolPoint(i).v;
    for (float& factor : samples[i].layer_factors[0]) factor = 1;
    samples[i].lights = &lamp;
    samples[i].light_count = 1;
    if (moving) samples[i].objects = &placed.packet();
    samples[i].objects_begin = 0.2f * static_cast<float>(i), samples[i].objects_length = 0.2f;
  }
  PixelBlock block{};
  for (int i = 0; i < kLanes; ++i) {
    block.x.v[i] = 0.05f * static_cast<float>(i % 4), block.y.v[i] = 0.08f * static_cast<float>(i / 4);
    block.z.v[i] = 1, block.row_begin.v[i] = 0.02f * static_cast<float>(i / 4);
    block.moment.v[i] = 0.06f * static_cast<float>(i), block.row_part = 0.9f;
    block.x_du.v[i] = block.y_dv.v[i] = block.width.v[i] = 0.01f;
    block.valid.v[i] = i == 5 ? 0 : -1;
    block.scramble_u.v[i] = static_cast<std::int32_t>(PixelScramble(1, static_cast<std::uint32_t>(i), 0).point.u);
  }
  Lanes base[3];
  const std::vector<KernelChoice> kernels = PacketKernels();
  kernels[0].expose_block(rays.packet_scene(), samples, 4, true, 0.5f, block, base);
  for (int i = 0; i < kLanes; ++i) EXPECT_GE(base[0].v[i], i == 5 ? 0.0f : 0.01f);

  if (kernels.size() == 1) GTEST_SKIP() << "this machine has only the base instruction set";
  for (const KernelChoice& kernel : kernels) {
    Lanes sum[3];
    kernel.expose_block(rays.packet_scene(), samples, 4, true, 0.5f, block, sum);
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i < kLanes; ++i)
        EXPECT_NEAR(sum[c].v[i], base[c].v[i], 1e-4f * (1 + base[c].v[i])) << kernel.name << ", " << c << ", " << i;
    }
  }
}

TEST(Packet, InstructionSetsAgree) { ExpectInstructionSetsToAgree(false); }
TEST(Packet, InstructionSetsAgreeOnObjects) { ExpectInstructionSetsToAgree(true); }

TEST(Packet, BitsWithEveryInstructionSet) {
  for (const KernelChoice& kernel : PacketKernels()) {
    for (const std::uint64_t key : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{0xfedcba9876543210}}) {
      BlockBits bits;
      kernel.scramble_block(key, 636, 1000, bits);
      for (int i = 0; i < kLanes; ++i) {
        const PixelBits expected =
            PixelScramble(key, 636u + static_cast<std::uint32_t>(i % 4), 1000u + static_cast<std::uint32_t>(i / 4));
        EXPECT_EQ(static_cast<std::uint32_t>(bits.word[0].v[i]), expected.point.u);
        EXPECT_EQ(static_cast<std::uint32_t>(bits.word[1].v[i]), expected.point.v);
        EXPECT_EQ(static_cast<std::uint32_t>(bits.word[2].v[i]), expected.time);
        EXPECT_EQ(static_cast<std::uint32_t>(bits.word[3].v[i]), expected.turn);
      }
    }
  }
}

}  // namespace
}  // namespace sim::test
