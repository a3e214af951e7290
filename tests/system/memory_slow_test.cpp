// Memory of `vobench run` over ten minutes of video. VOBENCH_LONG_RUN=H: H hours.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <thread>

#include "source_dir.h"
#include "tests/system/program.h"

namespace vobench::system_test {
namespace {
namespace fs = std::filesystem;

std::size_t ResidentBytes(int process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/statm");
  std::size_t total = 0, resident = 0;
  file >> total >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

// Progress of the run: number of images written, of 24 evenly spaced frames.
std::size_t Pictures(const fs::path& where) {
  std::size_t count = 0;
  std::error_code gone;  // folders are renamed meanwhile
  for (fs::recursive_directory_iterator at(where, gone), end; !gone && at != end; at.increment(gone))
    count += at->path().extension() == ".jpg" && at->path().parent_path().filename() == "frames";
  return count;
}

// Resident memory from the third image (a tenth of the way) to the last (at 47/48, before the evaluation): at most 1 %
// above its value at the third.
TEST(MemorySlowTest, OfARunDoesNotGrow) {
  const char* hours = std::getenv("VOBENCH_LONG_RUN");
  const double seconds = hours != nullptr ? std::atof(hours) * 3600 : 600;
  const TemporaryFolder here;
  const int child =
      StartVobench({"run", VOBENCH_SOURCE_DIR "/tests/consistency/long_flight.yaml", "-o", "out", "--system", "rb2pf",
                    "--set", "time.duration=" + std::to_string(seconds) + " s", "--set", "sensor.time_samples=4"},
                   here.path());
  std::size_t early = 0, most = 0, peak = 0, looks = 0;
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    const std::size_t bytes = ResidentBytes(child), pictures = Pictures(here.path());
    if (early == 0 && pictures >= 3) early = bytes;
    if (early > 0 && pictures < 24) most = std::max(most, bytes), ++looks;
    peak = std::max(peak, bytes);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  ASSERT_EQ(status, 0);
  ASSERT_GT(looks, 100u);
  const auto mb = [](std::size_t bytes) { return 1e-6 * static_cast<double>(bytes); };
  std::cout << 30 * seconds << " frames. Resident MB: " << mb(early) << " at a tenth of the way, then at most "
            << mb(most) << "; while it was judged " << mb(peak) << '\n';
  EXPECT_LT(mb(most), 1.01 * mb(early));
}

}  // namespace
}  // namespace vobench::system_test
