// The program. Exit status: 0 done, 1 the work failed, 2 bad usage or bad input, 3 not consistent
// though that was required.
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <new>
#include <opencv2/core/utility.hpp>
#include <stdexcept>
#include <string>
#include <system_error>

#include "tools/bench/errors.h"
#include "tools/bench/progress.h"
#include "tools/vobench/arguments.h"
#include "tools/vobench/large_memory.h"

namespace vobench {
namespace {

void Execute(const RenderOptions& options) { Render(options); }
void Execute(const TrackOptions& options) { Track(options); }
void Execute(const EvaluateOptions& options) { Evaluate(options); }
void Execute(const RunOptions& options) { Run(options); }
void Execute(const CheckOptions& options) { Check(options); }
void Execute(const ReportOptions& options) { Report(options); }
void Execute(const VerifyOptions& options) { Verify(options); }
void Execute(const CampaignOptions& options) { RunCampaign(options); }
void Execute(const BenchOptions& options) { Bench(options); }
void Execute(const ExportOptions& options) { Export(options); }
void Execute(const FitCameraOptions& options) { FitCamera(options); }
void Execute(const ImportOptions& options) { Import(options); }
void Execute(const LookOptions& options) { Look(options); }
void Execute(const SettingsOptions& options) { Settings(options); }

int Fail(int status, std::string reason) {
  std::ranges::replace_if(
      reason, [](unsigned char c) { return (c < ' ' && c != '\n') || c == 0x7f; }, '?');
  std::fflush(stdout);
  std::fprintf(stderr, "vobench: %s\n", reason.c_str());
  return status;
}

int Main(int argc, char** argv) try {
  HoldInterrupts();
  UseLargePagesForMatrices();
  cv::setNumThreads(1);  // --jobs bounds the threads; OpenCV's own would come on top
  const std::variant<Command, int> asked = ParseArguments(argc, argv);
  if (const int* status = std::get_if<int>(&asked)) return *status;
  std::visit([](const auto& options) { Execute(options); }, std::get<Command>(asked));
  if (std::fflush(stdout) != 0) throw std::system_error(errno, std::generic_category());
  return 0;
} catch (const BadInput& error) {
  return Fail(2, error.what());
} catch (const NotConsistent& error) {
  return Fail(3, error.what());
} catch (const std::bad_alloc&) {
  return Fail(1, "out of memory");
} catch (const std::system_error& error) {
  // fmt calls standard output a file.
  return Fail(1,
              std::ferror(stdout) != 0 ? "cannot write to standard output: " + error.code().message() : WordsOf(error));
} catch (const std::exception& error) {
  return Fail(1, error.what());
}

}  // namespace
}  // namespace vobench

int main(int argc, char** argv) { return vobench::Main(argc, argv); }
