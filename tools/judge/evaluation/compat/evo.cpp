#include "tools/judge/evaluation/compat/evo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "tools/judge/evaluation/compat/format.h"
#include "tools/judge/evaluation/rpe.h"
#include "tools/judge/evaluation/text_file.h"

namespace evaluation::compat {
namespace {

MatchedTrajectories Match(const Trajectory& estimate, const Trajectory& truth, const EvoOptions& options) {
  return MatchTrajectories(Shifted(estimate, options.t_offset_ns), truth,
                           {AssociationRule::nearest, options.t_max_diff_ns});
}

Similarity AlignmentOf(const MatchedTrajectories& matched, const EvoOptions& options) {
  if (!options.align && !options.correct_scale) {
    return options.align_origin ? Align(matched, Alignment::first) : Similarity{};
  }
  MatchedTrajectories first = matched;
  if (options.n_to_align > 0 && options.n_to_align < matched.estimate.size()) {
    first.estimate.resize(options.n_to_align);
    first.truth.resize(options.n_to_align);
  }
  const Similarity similarity = Align(first, options.correct_scale ? Alignment::sim3 : Alignment::se3);
  if (!similarity.rotation_determined) {
    throw InputError(
        {"evo: the positions lie on one line or one point, where Umeyama's alignment is not "
         "determined; leave out -a and -s, or use --align_origin"});
  }
  return options.align ? similarity : Similarity{.scale = similarity.scale};
}

// In the order of EvoRelation.
constexpr std::array kRelations = {"translation part (m)", "rotation part (unit-less)",
                                   "full transformation (unit-less)", "rotation angle in degrees (deg)",
                                   "rotation angle in radians (rad)"};

std::string TitleOf(const std::string& error, EvoRelation relation) {
  return error + " w.r.t. " + kRelations.at(static_cast<std::size_t>(relation)) + "\n";
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

// Of errors that move by distances [m] and turn by angles [rad]. |R - I| in the Frobenius norm is
// 2 sqrt(2) sin(angle / 2).
EvoResult ResultOf(const std::vector<double>& distances, const std::vector<double>& angles, EvoRelation relation) {
  EvoResult result;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const double angle = angles[i], rotation = 2 * std::sqrt(2.0) * std::sin(angle / 2);
    const std::array by_relation = {distances[i], rotation, std::hypot(rotation, distances[i]), angle * kDegrees,
                                    angle};
    result.errors.push_back(by_relation.at(static_cast<std::size_t>(relation)));
  }
  result.statistics = Summarise(result.errors);
  return result;
}

}  // namespace

EvoResult ComputeEvoApe(const Trajectory& estimate, const Trajectory& truth, const EvoOptions& options) {
  const MatchedTrajectories matched = Match(estimate, truth, options);
  const Similarity similarity = AlignmentOf(matched, options);
  const PoseErrors errors = ErrorsAfter(similarity, matched);
  EvoResult result = ResultOf(errors.position, errors.orientation, options.relation);
  result.title = TitleOf("APE", options.relation) + AlignmentName(options);
  result.similarity = similarity;
  return result;
}

EvoResult ComputeEvoRpe(const Trajectory& estimate, const Trajectory& truth, const EvoRpeOptions& options) {
  MatchedTrajectories matched = Match(estimate, truth, options.common);
  const bool frames = options.unit == EvoDeltaUnit::frames;
  const Similarity similarity = AlignmentOf(matched, options.common);
  matched.estimate = Apply(similarity, matched.estimate);
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
  EvoResult result = ResultOf(rpe.position, rpe.orientation, options.common.relation);
  result.title =
      TitleOf("RPE", options.common.relation) + "for delta = " +
      (frames ? base::Significant(options.delta, 12) + " (frames)" : Significant(options.delta, 12) + " (m)") +
      " using " + (options.all_pairs ? "all" : "consecutive") + " pairs\n" + AlignmentName(options.common);
  result.similarity = similarity;
  return result;
}

std::string Print(const EvoResult& result) {
  const Statistics& s = result.statistics;
  const auto parts = Parts(s);
  std::map<std::string, double> sorted(parts.begin(), parts.end());
  sorted["sse"] = static_cast<double>(s.count) * s.rmse * s.rmse;
  std::string text = result.title + "\n\n";
  for (const auto& [name, value] : sorted) {
    text += std::string(10 - name.size(), ' ') + name + "\t" + Fixed(value, 6) + "\n";
  }
  return text + "\n";
}

}  // namespace evaluation::compat
