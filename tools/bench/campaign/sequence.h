// Purpose: what a campaign's scenario reads from files, and its pictures in the cache: what they are named after, and how
//          they get there.
#pragma once

#include <filesystem>
#include <string>

#include "sim/scenario/scenario.h"
#include "tools/bench/campaign/external_system.h"
#include "tools/bench/campaign/sequence_cache.h"

namespace vobench {

// Of the contents of the files that the motion in a world of points is read from; empty where there is none.
std::string DigestOfPointFiles(const sim::Scenario& scenario);

// The files of a scenario's world, by which the cache knows it. They are found by reading all of it once: `Find` does
// so, and throws BadInput where it cannot be read. Files have changed or never been looked at: not known.
bool WorldIsKnown(const sim::Scenario& scenario, campaign::SequenceCache& cache);
void FindWorld(const sim::Scenario& scenario, campaign::SequenceCache& cache);

// Of all that the pictures depend on: settings, contents of files, version of the program. The world must be known
// (std::logic_error).
std::string SequenceKey(const sim::Scenario& scenario, campaign::SequenceCache& cache);

// Renders the sequence unless it is there, going on with what a killed process left. Waits where another one is at it.
// Throws BadInput, std::runtime_error.
void RenderInto(const campaign::SequenceCache& cache, const std::string& key, const sim::Scenario& scenario, int jobs);

// The sequence in another layout, made of links to the pictures in the cache; itself for TUM's. Made where it is not
// there.
std::filesystem::path InLayout(const campaign::SequenceCache& cache, const std::string& key,
                               const sim::Scenario& scenario, campaign::SequenceLayout layout);

}  // namespace vobench
