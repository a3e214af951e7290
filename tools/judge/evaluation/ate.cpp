#include "tools/judge/evaluation/ate.h"

#include "tools/judge/evaluation/so3.h"

namespace evaluation {

Ate ComputeAte(const MatchedTrajectories& matched, Alignment alignment) {
  Ate ate;
  ate.alignment = alignment;
  ate.similarity = Align(matched, alignment);
  for (std::size_t i = 0; i < matched.estimate.size(); ++i) {
    const StampedPose aligned = Apply(ate.similarity, matched.estimate[i]);
    ate.position_errors.push_back((aligned.p_WC - matched.truth[i].p_WC).norm());
    if (ate.similarity.rotation_determined) {
      ate.orientation_errors.push_back(AngleBetween(matched.truth[i].q_WC, aligned.q_WC));
    }
  }
  ate.position = Summarise(ate.position_errors);
  ate.orientation = Summarise(ate.orientation_errors);
  return ate;
}

}  // namespace evaluation
