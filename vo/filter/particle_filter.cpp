#include "vo/filter/particle_filter.h"

#include "vo/filter/algorithm1.h"
#include "vo/filter/fixed_lag.h"
#include "vo/filter/initialisation.h"

namespace vo {
namespace {

// Windows require a sampled pose, a linearising proposal, and a weight other than the density ratio at the sample.
bool SupportsWindows(const FilterParams& params) {
  return params.sampled == Sampled::pose &&
         (params.proposal == Proposal::ekf || params.proposal == Proposal::iterated) &&
         params.weight != Weight::importance;
}

std::unique_ptr<ParticlePhase> FirstPhase(const ParticleFilterSettings& settings, const FilterPrior& prior) {
  const FilterParams& params = settings.filter;
  if (SupportsWindows(params) && params.start_window > params.lag)
    return std::make_unique<Initialisation>(settings, prior);
  if (params.lag > 0) return std::make_unique<FixedLag>(settings, prior);
  return std::make_unique<Algorithm1>(settings, prior);
}

}  // namespace

ParticleFilter::ParticleFilter(const MotionParams& motion, const FilterParams& filter, const LandmarkParams& landmark,
                               const FilterPrior& prior, std::uint64_t seed)
    : phase_(FirstPhase({motion, filter, landmark, seed}, prior)) {}

const FilterAnswer& ParticleFilter::Update(std::span<const Match> matches) {
  phase_->Update(matches);
  if (std::unique_ptr<ParticlePhase> next = phase_->Next()) phase_ = std::move(next);
  return phase_->answer();
}

}  // namespace vo
