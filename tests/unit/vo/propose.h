// Optimal proposal from a map and matches, with a batch of its own. No matches: the prediction itself.
#pragma once

#include <span>

#include "vo/filter/proposal.h"

namespace vo_test {

inline vo::PoseProposal Propose(const vo::PoseGaussian& prediction, const vo::LocalMap& map,
                                std::span<const vo::Match> matches, const vo::FilterParams& params) {
  if (matches.empty()) return {prediction, 0.0, {}};
  vo::MatchBatch batch;
  batch.SetMatches(matches);
  batch.Load(map);
  return vo::Propose(prediction, batch, params, prediction.mean);
}

}  // namespace vo_test
