// A world of one coloured wall, and a scenario in it, in a folder.
#pragma once

#include <string>

#include "tests/unit/sim/temporary_folder.h"

namespace sim {

// 4 m x 3 m at z = -2, facing the origin, in 16 x 12 squares of different colours.
inline std::string WallPly() {
  std::string vertices, faces;
  int count = 0;
  for (int j = 0; j < 12; ++j) {
    for (int i = 0; i < 16; ++i) {
      const int shade = 40 + (i * 53 + j * 97 + i * j * 31) % 200;
      for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        vertices += std::to_string(-2 + 0.25 * (i + dx)) + " " + std::to_string(-1.5 + 0.25 * (j + dy)) + " -2 " +
                    std::to_string(shade) + " " + std::to_string(255 - shade) + " " +
                    std::to_string((shade * 7) % 256) + "\n";
      }
      faces += "4 " + std::to_string(count) + " " + std::to_string(count + 1) + " " + std::to_string(count + 2) + " " +
               std::to_string(count + 3) + "\n";
      count += 4;
    }
  }
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty "
         "uchar blue\n"
         "element face " +
         std::to_string(count / 4) + "\nproperty list uchar int vertex_indices\nend_header\n" + vertices + faces;
}

inline std::string WallScenario() {
  return "name: wall\n"
         "seed: 5\n"
         "world:\n"
         "  meshes: [{file: wall.ply}]\n"
         "  lights: [{type: ambient, radiance: [1, 1, 1]}]\n"
         "camera: {width: 64, height: 48, fx: 52, fy: 52, cx: 31.5, cy: 23.5}\n"
         "sensor: {exposure: 10 ms, time_samples: 4}\n"
         "time: {rate: 30 Hz, duration: 0.3 s}\n"
         "trajectory:\n"
         "  type: sampled\n"
         "  start: {position: [0, 0, 0], look_at: [0, 0, -2], velocity: [0.3, 0, 0]}\n"
         "  position_noise: 0.5\n"
         "  orientation_noise: 0.5\n";
}

struct SmallWorld {
  SmallWorld() {
    folder.Write("wall.ply", WallPly());
    folder.Write("wall.yaml", WallScenario());
  }
  TemporaryFolder folder;
  std::filesystem::path scenario() const { return folder.path() / "wall.yaml"; }
};

}  // namespace sim
