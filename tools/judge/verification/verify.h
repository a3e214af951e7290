// Verification of a sequence: its streams against each other, with nothing of the simulator.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "tools/judge/verification/check.h"

namespace verification {

// All checks, those that found nothing to compare included (count() 0). `progress` is called after each frame with the
// number done and that of all. Throws std::runtime_error where there is no sequence.
std::vector<Check> Verify(const std::filesystem::path& sequence,
                          const std::function<void(std::size_t, std::size_t)>& progress = {});

}  // namespace verification
