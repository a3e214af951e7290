// Conversion between the types of an odometry and those of its filter: prior to filter, belief to estimate and map.
// Private to vo.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "vo/base/params.h"
#include "vo/base/result.h"
#include "vo/filter/filter.h"
#include "vo/scale_ambiguity.h"

namespace vo {

// Filter of params.filter.sampled. Throws std::invalid_argument listing every invalid parameter, else every invalid
// part of the prior.
std::unique_ptr<Filter> MakeFilter(const Params& params, const Prior& prior, std::uint64_t seed);

Estimate MakeEstimate(const Filter& filter, const ScaleAmbiguity& scale, std::int64_t stamp_ns,
                      FrameDiagnostics diagnostics);

// Landmarks in the filter's order, without ids.
std::vector<MapPoint> MakeMap(const Filter& filter, const ScaleAmbiguity& scale);

}  // namespace vo
