// Trajectories, `timestamp tx ty tz qx qy qz qw`, by the readers of judge and simulator; velocities, `timestamp vx vy
// vz wx wy wz`.
#include "tools/judge/evaluation/trajectory.h"

#include "sim/motion/recorded.h"
#include "tests/fuzz/hold.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile file("trajectory.txt");
  file.Write({data, size});
  const std::string name = file.path().string();
  fuzz::Hold(name, [] { evaluation::ReadTrajectory(file.path()); });
  fuzz::Hold(name, [] { evaluation::ReadTrajectory(file.path(), evaluation::Reading::as_written); });
  fuzz::Hold(name, [] { evaluation::ReadVelocities(file.path()); });
  fuzz::Hold(name, [] {
    sim::RecordedMotion motion;
    motion.file = file.path();
    sim::MakeRecordedTrajectory(motion, 0.1)->At(0.05);
  });
  return 0;
}
