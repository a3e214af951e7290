// One check of `vobench verify`: the worst of many comparisons, each against its bound.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace verification {

class Check {
 public:
  Check(std::string name, std::string unit) : name_(std::move(name)), unit_(std::move(unit)) {}

  // |difference| against what it may be at most (> 0); `where`: the file, frame or pixel. What is not a number fails.
  void Add(double value, double bound, const std::string& where);
  // Something that has no size, such as a missing file.
  void Fail(const std::string& what);

  const std::string& name() const { return name_; }
  const std::string& unit() const { return unit_; }
  std::size_t count() const { return count_; }
  double value() const { return value_; }  // where value / bound is largest
  double bound() const { return bound_; }
  const std::string& where() const { return where_; }
  bool failed() const { return !failures_.empty(); }
  // The places that failed, in the order in which they were added.
  const std::vector<std::string>& failures() const { return failures_; }

 private:
  std::string name_, unit_, where_;
  std::size_t count_ = 0;
  double value_ = 0, bound_ = 0, worst_ = -1;
  std::vector<std::string> failures_;
};

}  // namespace verification
