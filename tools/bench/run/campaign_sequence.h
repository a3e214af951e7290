// Sequences of a campaign in the cache: name by content, rendering.
#pragma once

#include <optional>
#include <string>

#include "sim/scenario/scenario.h"
#include "tools/bench/campaign/sequence_cache.h"

namespace vobench {

// Of the contents of the files that the motion in a world of points is read from; empty where there is none.
std::string DigestOfPointFiles(const sim::Scenario& scenario);

// Reads the world of a scenario and gives the cache the names of its files. Throws BadInput where one cannot be read.
void FindWorld(const sim::Scenario& scenario, campaign::SequenceCache& cache);

// Of all that the pictures depend on: settings, contents of files, version of the program. None where the files of the
// world have changed or were never found.
std::optional<std::string> SequenceKey(const sim::Scenario& scenario, campaign::SequenceCache& cache);

// Renders the sequence unless it is there, going on with what a killed process left. Waits where another one is at it.
// Throws BadInput, std::runtime_error.
void RenderInto(const campaign::SequenceCache& cache, const std::string& key, const sim::Scenario& scenario, int jobs);

}  // namespace vobench
