// The program. Exit status: 0 done, 1 the work failed, 2 bad usage or bad input, 3 not consistent
// though that was required.
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
void Execute(const ExportOptions& options) { Export(options); }
void Execute(const SettingsOptions& options) { Settings(options); }

int Main(int argc, char** argv) {
  HoldInterrupts();
  cv::setNumThreads(1);  // how many threads there are says --jobs, of which OpenCV knows nothing
  try {
    const std::variant<Command, int> asked = ParseArguments(argc, argv);
    if (const int* status = std::get_if<int>(&asked)) return *status;
    std::visit([](const auto& options) { Execute(options); }, std::get<Command>(asked));
    if (std::fflush(stdout) != 0) {
      throw std::runtime_error("cannot write to standard output: " + std::generic_category().message(errno));
    }
    return 0;
  } catch (const BadInput& error) {
    std::fprintf(stderr, "vobench: %s\n", error.what());
    return 2;
  } catch (const NotConsistent& error) {
    std::fflush(stdout);
    std::fprintf(stderr, "vobench: %s\n", error.what());
    return 3;
  } catch (const std::bad_alloc&) {
    std::fputs("vobench: out of memory\n", stderr);
    return 1;
  } catch (const std::system_error& error) {
    // fmt calls standard output a file.
    const std::string unwritten = "cannot write to standard output: " + error.code().message();
    std::fprintf(stderr, "vobench: %s\n", std::ferror(stdout) != 0 ? unwritten.c_str() : WordsOf(error).c_str());
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vobench: %s\n", error.what());
    return 1;
  }
}

}  // namespace
}  // namespace vobench

int main(int argc, char** argv) { return vobench::Main(argc, argv); }
