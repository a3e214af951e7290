#include "tools/judge/verification/check.h"

#include <limits>

namespace verification {

void Check::Add(double value, double bound, const std::string& where) {
  ++count_;
  const bool good = value <= bound;
  const double ratio = value == value ? value / bound : std::numeric_limits<double>::infinity();
  if (ratio > worst_) worst_ = ratio, value_ = value, bound_ = bound, where_ = where;
  if (!good) failures_.push_back(where);
}

void Check::Fail(const std::string& what) {
  ++count_;
  failures_.push_back(what);
  if (where_.empty() || worst_ < std::numeric_limits<double>::infinity()) where_ = what;
  worst_ = value_ = std::numeric_limits<double>::infinity();
}

}  // namespace verification
