// Tables read by the verification or a report: one file has the input bytes, the others are valid.
#include <array>
#include <memory>

#include "tests/fuzz/hold.h"
#include "tools/bench/result/verdict.h"
#include "tools/judge/verification/check.h"
#include "tools/judge/verification/files.h"

namespace {

struct Table {
  const char *folder, *name, *good;
};

constexpr const char* kPose = "1.0 0 0 0 0 0 0 1\n";
constexpr std::array kTables = {Table{"truth", "groundtruth.txt", kPose},
                                Table{"velocity", "velocity.txt", ""},
                                Table{"flow", "flow.txt", ""},
                                Table{"objects", "objects/cup.txt", ""},
                                Table{"landmarks", "landmarks.txt", ""},
                                Table{"tracks", "landmark_tracks.txt", ""},
                                Table{"imu", "imu0/data.csv", ""},
                                Table{"labels", "labels.json", ""}};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static std::array<std::unique_ptr<fuzz::InputFile>, kTables.size()> files;
  static fuzz::InputFile ranks("result/ranks.csv"), verdict("result/verdict.csv");
  if (!files[0]) {
    for (std::size_t i = 0; i < kTables.size(); ++i) {
      const std::string folder = std::string(kTables[i].folder) + "/";
      fuzz::WriteBeside(folder + "rgb.txt", "1.0 rgb/a.png\n");
      fuzz::WriteBeside(folder + "groundtruth.txt", kPose);
      fuzz::WriteBeside(folder + "camera.yaml", "{width: 8, height: 8, fx: 8, fy: 8, cx: 4, cy: 4}\n");
      fuzz::WriteBeside(folder + "imu0/sensor.yaml", "rate: 200\n");
      files[i] = std::make_unique<fuzz::InputFile>(folder + kTables[i].name);
    }
  }
  // One table per run, chosen by the size of the input: saves time.
  const std::size_t chosen = size % kTables.size();
  files[chosen]->Write({data, size});
  const std::filesystem::path folder = fuzz::Folder() / kTables[chosen].folder;
  fuzz::Hold(folder.string(), [&] {
    verification::Check problems("files", "1"), stamps("stamps", "1");
    verification::ReadSequence(folder, folder, problems, stamps);
  });
  for (fuzz::InputFile* file : {&ranks, &verdict}) file->Write({data, size});
  fuzz::Hold(ranks.path().string(), [] { vobench::ReadRanks(ranks.path().parent_path()); });
  fuzz::Hold(verdict.path().string(), [] { vobench::ReadVerdict(verdict.path().parent_path()); });
  return 0;
}
