// Checks of what each pixel sees: depth, distance, normals, ids, flow, occlusion, landmarks.
// Bounds: docs/truth.md.
#pragma once

#include <vector>

#include "tools/judge/verification/frames.h"

namespace verification {

class SurfaceChecks {
 public:
  explicit SurfaceChecks(Frames& frames);
  void Frame(std::size_t frame);  // in order
  const std::vector<Check>& checks() const { return checks_; }

 private:
  void DepthPictures(std::size_t frame);
  void Distance(std::size_t frame);
  void Normals(std::size_t frame);
  void SurfaceIds(std::size_t frame);
  void DepthInNeighbours(std::size_t frame);
  void Flow(std::size_t frame, const std::string& stream, std::size_t to, Check& check);
  void FlowThereAndBack(std::size_t frame);
  void Occlusion(std::size_t frame, const std::string& stream, std::size_t to, Check& check);
  void Landmarks(std::size_t frame);

  Frames& frames_;
  std::vector<Check> checks_;
};

}  // namespace verification
