// Sequence in the cache for an external program: rectified, and in its layout.
// Source: docs/campaign.md; Engel, Usenko and Cremers 2016, arXiv:1607.02555: times.txt, pcalib.txt, vignette.png.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/scenario/scenario.h"
#include "tools/bench/campaign/external_system.h"
#include "tools/bench/campaign/sequence_cache.h"

namespace vobench {

struct ServedSequence {
  std::filesystem::path folder;
  sim::CameraParams camera;
  std::vector<std::int64_t> stamps_ns;  // of its frames
};

// Links to the pictures in the cache, or rectified ones, without the truth; made where they are missing. `rendered`:
// with exposures and photometric calibration, unknown of recorded ones. With a `focal_error` (prior.focal_error) the
// camera given, here and in the folder's files, has fx and fy longer by this fraction. Throws BadInput,
// std::runtime_error.
ServedSequence Serve(const campaign::SequenceCache& cache, const std::string& key, const sim::Scenario& scenario,
                     bool rendered, const campaign::ExternalSystem& system, double focal_error = 0);

}  // namespace vobench
