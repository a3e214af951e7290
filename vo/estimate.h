// Purpose: what Odometry and PointOdometry share: checked parameters, the filter and its start, the answer, the time spent. Not for users.
#pragma once

#include <cstdint>
#include <memory>

#include "vo/base/params.h"
#include "vo/base/stopwatch.h"
#include "vo/filter/watched_filter.h"
#include "vo/odometry.h"
#include "vo/unknown_scale.h"

namespace vo {

// Throws std::invalid_argument listing every bad parameter.
Params Checked(const Params& params);

// The member of the family that params.filter.sampled names.
std::unique_ptr<Filter> MakeFilter(const Params& params, const Prior& prior, std::uint64_t seed);

Estimate MakeEstimate(const Filter& filter, const UnknownScale& scale, std::int64_t stamp_ns,
                      FrameDiagnostics diagnostics);

// The filter's landmarks in its order, without their ids.
std::vector<MapPoint> MakeMap(const Filter& filter, const UnknownScale& scale);

// Throws std::invalid_argument when `stamp_ns` is not after `last_ns`.
void RequireIncreasing(std::int64_t stamp_ns, std::int64_t last_ns);

}  // namespace vo
