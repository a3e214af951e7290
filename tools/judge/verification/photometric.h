// Purpose: pictures against each other, through depth and poses: is each at the place and time that its stamp says?
//          docs/truth.md derives the bounds.
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
