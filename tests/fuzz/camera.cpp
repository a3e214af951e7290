// Calibration files: the project's, EuRoC's, Kalibr's, ROS's and OpenCV's (YAML and XML).
#include "tests/fuzz/hold.h"
#include "vo/geometry/camera_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile file("camera.yaml");
  file.Write({data, size});
  fuzz::Hold(file.path().string(), [] { vo::ReadCamera(file.path()); });
  return 0;
}
