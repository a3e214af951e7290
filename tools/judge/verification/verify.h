// Verification of a sequence: its streams against each other, independent of the simulator.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "tools/judge/verification/check.h"

namespace verification {

// All checks, including those without anything to compare (count() 0). `progress` is called after each frame with the
// number done and the total. Throws std::runtime_error where there is no sequence.
std::vector<Check> Verify(const std::filesystem::path& sequence,
                          const std::function<void(std::size_t, std::size_t)>& progress = {});

}  // namespace verification
