#include "tools/judge/evaluation/compat/evo.h"

#include <algorithm>
#include <cmath>

#include "tools/base/text.h"
#include "tools/judge/evaluation/compat/format.h"
#include "tools/judge/evaluation/rpe.h"
#include "tools/judge/evaluation/so3.h"

namespace evaluation::compat {
namespace {

MatchedTrajectories Match(const Trajectory& estimate, const Trajectory& truth, const EvoOptions& options) {
  return MatchTrajectories(Shifted(estimate, options.t_offset_ns), truth,
                           {AssociationRule::nearest, options.t_max_diff_ns});
}

Similarity AlignmentOf(const MatchedTrajectories& matched, const EvoOptions& options) {
  if (options.align || options.correct_scale) {
    MatchedTrajectories first = matched;
    if (options.n_to_align > 0 && options.n_to_align < matched.estimate.size()) {
      first.estimate.resize(options.n_to_align);
      first.truth.resize(options.n_to_align);
    }
    Similarity similarity = Align(first, options.correct_scale ? Alignment::sim3 : Alignment::se3);
    if (!similarity.rotation_determined) {
      throw InputError(
          {"evo: the positions lie on one line or one point, where Umeyama's alignment is not "
           "determined; leave out -a and -s, or use --align_origin"});
    }
    if (!options.align) {
      const double scale = similarity.scale;
      similarity = {};
      similarity.scale = scale;
    }
    return similarity;
  }
  return options.align_origin ? Align(matched, Alignment::first) : Similarity{};
}

std::string RelationName(EvoRelation relation) {
  switch (relation) {
    case EvoRelation::translation:
      return "translation part (m)";
    case EvoRelation::rotation:
      return "rotation part (unit-less)";
    case EvoRelation::full:
      return "full transformation (unit-less)";
    case EvoRelation::angle_deg:
      return "rotation angle in degrees (deg)";
    case EvoRelation::angle_rad:
      break;
  }
  return "rotation angle in radians (rad)";
}

std::string AlignmentName(const EvoOptions& options) {
  std::string name = "(not aligned)";
  if (options.align) {
    name = options.correct_scale ? "(with Sim(3) Umeyama alignment)" : "(with SE(3) Umeyama alignment)";
  } else if (options.correct_scale) {
    name = "(scale corrected)";
  } else if (options.align_origin) {
    name = "(with origin alignment)";
  }
  if ((options.align || options.correct_scale) && options.n_to_align > 0) {
    name += " (aligned poses: " + std::to_string(options.n_to_align) + ")";
  }
  return name;
}

// Of an error that moves by `distance` [m] and turns by `angle` [rad]. |R - I| in the Frobenius norm is
// 2 sqrt(2) sin(angle / 2).
double ErrorOf(double distance, double angle, EvoRelation relation) {
  const double rotation = 2 * std::sqrt(2.0) * std::sin(angle / 2);
  switch (relation) {
    case EvoRelation::translation:
      return distance;
    case EvoRelation::rotation:
      return rotation;
    case EvoRelation::full:
      return std::hypot(rotation, distance);
    case EvoRelation::angle_deg:
      return angle * kDegrees;
    case EvoRelation::angle_rad:
      break;
  }
  return angle;
}

}  // namespace

EvoResult ComputeEvoApe(const Trajectory& estimate, const Trajectory& truth, const EvoOptions& options) {
  const MatchedTrajectories matched = Match(estimate, truth, options);
  EvoResult result;
  result.title = "APE w.r.t. " + RelationName(options.relation) + "\n" + AlignmentName(options);
  result.similarity = AlignmentOf(matched, options);
  for (std::size_t i = 0; i < matched.estimate.size(); ++i) {
    const StampedPose aligned = Apply(result.similarity, matched.estimate[i]);
    result.errors.push_back(ErrorOf((aligned.p_WC - matched.truth[i].p_WC).norm(),
                                    AngleBetween(matched.truth[i].q_WC, aligned.q_WC), options.relation));
  }
  result.statistics = Summarise(result.errors);
  return result;
}

EvoResult ComputeEvoRpe(const Trajectory& estimate, const Trajectory& truth, const EvoRpeOptions& options) {
  MatchedTrajectories matched = Match(estimate, truth, options.common);
  const bool frames = options.unit == EvoDeltaUnit::frames;
  EvoResult result;
  result.similarity = AlignmentOf(matched, options.common);
  matched.estimate = Apply(result.similarity, matched.estimate);
  const PairSelection selection = options.all_pairs ? PairSelection::all : PairSelection::consecutive;
  const std::size_t poses = matched.truth.size();
  const std::vector<IndexPair> pairs =
      frames ? PairsByFrames(poses, static_cast<std::size_t>(std::min(options.delta, static_cast<double>(poses))),
                             selection)
             : PairsByPath(options.pairs_from_reference ? matched.truth : matched.estimate, options.delta, selection,
                           options.delta_tolerance);
  if (pairs.empty()) {
    throw InputError({"evo: no pair of poses is " + Significant(options.delta, 6) + (frames ? " frames" : " m") +
                      " apart; choose a smaller --delta"});
  }
  const Rpe rpe = ComputeRpe(matched, pairs);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    result.errors.push_back(ErrorOf(rpe.position[k], rpe.orientation[k], options.common.relation));
  }
  result.statistics = Summarise(result.errors);
  result.title =
      "RPE w.r.t. " + RelationName(options.common.relation) + "\nfor delta = " +
      (frames ? base::Significant(options.delta, 12) + " (frames)" : Significant(options.delta, 12) + " (m)") +
      " using " + (options.all_pairs ? "all" : "consecutive") + " pairs\n" + AlignmentName(options.common);
  return result;
}

std::string Print(const EvoResult& result) {
  const Statistics& s = result.statistics;
  std::string text = result.title + "\n\n";
  const auto add = [&](const std::string& name, double value) {
    text += std::string(10 - name.size(), ' ') + name + "\t" + Fixed(value, 6) + "\n";
  };
  add("max", s.max);
  add("mean", s.mean);
  add("median", s.median);
  add("min", s.min);
  add("rmse", s.rmse);
  add("sse", static_cast<double>(s.count) * s.rmse * s.rmse);
  add("std", s.std);
  return text + "\n";
}

}  // namespace evaluation::compat
