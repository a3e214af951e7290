// Cameras in the glTF files of a world, by name.
// Source: Khronos, "glTF 2.0 Specification", 3.10: a camera looks along -z of its node, up is y, and scaling of nodes is
// ignored.
#pragma once

#include <string>
#include <vector>

#include "sim/motion/pose.h"
#include "sim/sensor/camera.h"
#include "sim/world/description.h"
#include "sim/world/imported_scene.h"

namespace sim {

struct FileCamera {
  std::string mesh, name;  // the mesh's name in the world; that of the camera's node, or without one the camera's own
  Pose T_WC;
  double yfov_rad = 0, aspect = 0;  // as in ImportedCamera
};

// Whose file states `in`. mesh: the file's place in the world.
FileCamera CameraOf(const ImportedCamera& in, const MeshDescription& mesh);

class FileCameras {
 public:
  // The world must outlive it. Files are opened when the first camera is asked for.
  explicit FileCameras(const WorldDescription& world) : world_(world) {}

  // name: NAME, or MESH/NAME. Throws std::runtime_error where none is called so, or more than one, with all that there
  // are.
  const FileCamera& At(const std::string& name);

 private:
  void Read();

  const WorldDescription& world_;
  bool is_read_ = false;
  std::vector<FileCamera> cameras_;
  std::string problems_;  // of files, each with its own
};

// Gives the focal lengths and the principal point of a picture of params.width x params.height; one of them that is 0 is
// made to fit the file's aspect ratio. Throws std::runtime_error for an orthographic camera, an impossible angle, and a
// size that does not fit.
void SetIntrinsics(const FileCamera& from, CameraParams& params);

}  // namespace sim
