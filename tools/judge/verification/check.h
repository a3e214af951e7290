// One check of `vobench verify`: the worst of many comparisons, each against its bound.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace verification {

// The largest value / bound of those added; NaN is larger than all.
struct LargestRatio {
  double value = 0, bound = 1, ratio = -1;
  std::size_t count = 0;  // of all
  // Adds a value; whether it is the largest so far.
  bool Add(double v, double b) {
    const double r = v == v ? v / b : std::numeric_limits<double>::infinity();
    ++count;
    if (!(r > ratio)) return false;
    ratio = r, value = v, bound = b;
    return true;
  }
};

class Check {
 public:
  Check(std::string name, std::string unit) : name_(std::move(name)), unit_(std::move(unit)) {}

  // |difference| against its bound (> 0); `where`: the file, frame or pixel. NaN fails.
  void Add(double value, double bound, const std::string& where) {
    if (worst_.Add(value, bound)) where_ = where;
    if (!(value <= bound)) failures_.push_back(where);
  }
  // The worst of what was added to it, if anything was.
  void Add(const LargestRatio& worst, const std::string& where) {
    if (worst.count > 0) Add(worst.value, worst.bound, where);
  }
  // A failure without a size, such as a missing file.
  void Fail(const std::string& what) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    ++worst_.count;
    failures_.push_back(what);
    if (where_.empty() || worst_.ratio < kInfinity) where_ = what;
    worst_.ratio = worst_.value = kInfinity;
  }

  // Prefixes the name with the part checked.
  void Prefix(const std::string& part) { name_ = part + ": " + name_; }

  const std::string& name() const { return name_; }
  const std::string& unit() const { return unit_; }
  std::size_t count() const { return worst_.count; }
  double value() const { return worst_.value; }  // where value / bound is largest
  double bound() const { return worst_.bound; }
  const std::string& where() const { return where_; }
  bool failed() const { return !failures_.empty(); }
  // The places that failed, in the order in which they were added.
  const std::vector<std::string>& failures() const { return failures_; }

 private:
  std::string name_, unit_, where_;
  LargestRatio worst_{0, 0, -1, 0};
  std::vector<std::string> failures_;
};

}  // namespace verification
