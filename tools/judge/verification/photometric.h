// Photometric checks: pictures against each other through depth and poses, for place and time of their stamps.
// Bounds: docs/truth.md.
#pragma once

#include <vector>

#include "tools/judge/verification/frames.h"

namespace verification {

class PhotometricChecks {
 public:
  explicit PhotometricChecks(Frames& frames);
  void Frame(std::size_t frame);
  const std::vector<Check>& checks() const { return checks_; }

 private:
  Frames& frames_;
  std::vector<Check> checks_;
};

}  // namespace verification
