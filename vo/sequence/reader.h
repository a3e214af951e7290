// Purpose: frames from a folder in TUM RGB-D layout (docs/sequence_format.md), or in that of the original ICL-NUIM files, which have
//          associations.txt (`index depth-file index image-file`) instead of rgb.txt: their time is index / 30 s; or in that of EuRoC
//          (mav0/cam0/data.csv, `timestamp in ns,filename`).
//          Truth is not read here: what the odometry is fed has no field for it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

namespace vo {

struct Frame {
  std::int64_t stamp_ns = 0;  // mid-exposure
  cv::Mat image;              // CV_8UC1 or CV_8UC3 (BGR)
};

class SequenceReader {
 public:
  // Reads and checks the list of frames. Throws std::runtime_error naming file and lines: folder or list missing, no frames,
  // a malformed line, stamps that do not increase (both lines named), image files that are not there.
  explicit SequenceReader(const std::filesystem::path& folder);

  std::size_t size() const { return entries_.size(); }
  // The next frame, or none after the last. Throws std::runtime_error naming an image that cannot be decoded.
  std::optional<Frame> Next();

 private:
  struct Entry {
    std::int64_t stamp_ns;
    std::filesystem::path image;
  };
  std::vector<Entry> entries_;
  std::size_t next_ = 0;
};

}  // namespace vo
