// Cameras in the glTF files of a world, by name.
// Source: Khronos, "glTF 2.0 Specification", 3.10: a camera looks along -z of its node, up is y, and scaling of nodes
// is ignored.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/motion/pose.h"
#include "sim/sensor/camera.h"
#include "sim/world/description.h"

namespace sim {

struct FileCamera {
  std::string name;  // MESH/NAME: the mesh's in the world, and that of the camera's node, or without one its own
  Pose T_WC;
  double yfov_rad = 0, aspect = 0;  // as in ImportedCamera
};

class FileCameras {
 public:
  // The world must outlive it. Files are opened at the first call of At.
  explicit FileCameras(const WorldDescription& world) : world_(world) {}

  // name: NAME, or MESH/NAME. Throws std::runtime_error listing all cameras unless exactly one has this name.
  const FileCamera& At(const std::string& name);

 private:
  const WorldDescription& world_;
  std::optional<std::vector<FileCamera>> cameras_;
};

// Focal lengths and principal point of a picture of params.width x params.height; a height of 0 is made to fit the
// file's aspect ratio. Throws std::runtime_error for an orthographic camera and for a size that does not fit.
void SetIntrinsics(const FileCamera& from, CameraParams& params);

}  // namespace sim
