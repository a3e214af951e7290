#include "tools/judge/evaluation/compat/tum.h"

#include <cmath>

#include "tools/judge/evaluation/compat/format.h"

namespace evaluation::compat {
namespace {

std::string Lines(const std::string& what, const Statistics& s, double factor, const std::string& unit) {
  std::string text;
  const auto add = [&](const char* name, double value) {
    text += what + "." + name + " " + Fixed(factor * value, 6) + " " + unit + "\n";
  };
  add("rmse", s.rmse);
  add("mean", s.mean);
  add("median", s.median);
  add("std", s.std);
  add("min", s.min);
  add("max", s.max);
  return text;
}

std::string Compared(std::size_t pairs) { return "compared_pose_pairs " + std::to_string(pairs) + " pairs\n"; }

}  // namespace

Ate ComputeTumAte(const Trajectory& estimate, const Trajectory& truth, const TumAteOptions& options) {
  const Trajectory moved = Shifted(estimate, options.offset_ns, options.scale);
  const AssociationOptions association{AssociationRule::tum, options.max_difference_ns};
  return ComputeAte(MatchTrajectories(moved, truth, association), Alignment::se3);
}

std::string Print(const Ate& ate, const TumAteOptions& options) {
  if (!options.verbose) return Fixed(ate.position.rmse, 6) + "\n";
  return Compared(ate.position.count) + Lines("absolute_translational_error", ate.position, 1, "m");
}

std::string Print(const Rpe& rpe, const TumRpeOptions& options) {
  // Without --verbose the script prints as many digits as a double has; twelve are the same on every machine.
  if (!options.verbose) return Significant(rpe.position_statistics.mean, 12) + "\n";
  return Compared(rpe.pairs.size()) + Lines("translational_error", rpe.position_statistics, 1, "m") +
         Lines("rotational_error", rpe.orientation_statistics, kDegrees, "deg");
}

}  // namespace evaluation::compat
