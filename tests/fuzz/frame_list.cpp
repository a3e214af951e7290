// rgb.txt (TUM), associations.txt (ICL-NUIM) and mav0/cam0/data.csv (EuRoC): the same bytes as each. Image: a.png.
#include <opencv2/imgcodecs.hpp>

#include "tests/fuzz/hold.h"
#include "vo/sequence/reader.h"

namespace {

std::string Picture() {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", cv::Mat(2, 2, CV_8UC1, cv::Scalar(7)), bytes);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile lists[] = {fuzz::InputFile("tum/rgb.txt"), fuzz::InputFile("icl/associations.txt"),
                                    fuzz::InputFile("euroc/mav0/cam0/data.csv")};
  static const bool once = [] {
    for (const char* name : {"tum/a.png", "icl/a.png", "euroc/mav0/cam0/data/a.png"})
      fuzz::WriteBeside(name, Picture());
    return true;
  }();
  static_cast<void>(once);
  for (const char* folder : {"tum", "icl", "euroc"}) {
    fuzz::InputFile& list = lists[folder[0] == 't' ? 0 : folder[0] == 'i' ? 1 : 2];
    list.Write({data, size});
    fuzz::Hold((fuzz::Folder() / folder).string(), [&] {
      vo::SequenceReader reader(fuzz::Folder() / folder);
      for (int i = 0; i < 3 && reader.Next(); ++i) {
      }
    });
  }
  return 0;
}
