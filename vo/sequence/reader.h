// Reader of image sequences: TUM RGB-D layout (docs/sequence_format.md); ICL-NUIM's original layout (associations.txt,
// `index file index file`, the depth first or last, stamp = index / 30 s); EuRoC (mav0/cam0/data.csv, `stamp in
// ns,filename`); KITTI's odometry (times.txt, a time a line, and image_0 or image_2, NNNNNN.png); TUM's monocular data
// set (times.txt, `number time exposure`, and images/NUMBER.jpg).
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "vo/base/source.h"

namespace vo {

// Problem of a rig's folder where a camera's sequence is expected; empty: it is none.
std::string RigProblem(const std::filesystem::path& folder);

class SequenceReader : public FrameSource {
 public:
  enum class Images { needed, not_asked_for };
  // Reads and checks the list of frames. Throws std::runtime_error naming file and lines: folder or list missing, no
  // frames, a malformed line, stamps that do not increase (both lines named), missing image files.
  // camera: of EuRoC, 1: mav0/cam1.
  explicit SequenceReader(const std::filesystem::path& folder, Images images = Images::needed, int camera = 0);

  struct Entry {
    std::int64_t stamp_ns;
    std::filesystem::path image;
  };
  const std::vector<Entry>& entries() const { return entries_; }
  std::size_t size() const { return entries_.size(); }
  std::optional<std::int64_t> Count() const override { return static_cast<std::int64_t>(size()); }
  std::optional<Frame> Next() override;

 private:
  std::vector<Entry> entries_;
  std::size_t next_ = 0;
  cv::Size size_;  // of the first image
};

}  // namespace vo
