// What of the machine may differ while the bits stay: instruction sets of inner loops, with dispatch at run time, and the
// block sizes of matrix products.
#pragma once

#include <vector>

namespace vo {

enum class InstructionSet { base, avx2, avx512 };
const char* Name(InstructionSet set);
// Those of this machine, in ascending order.
std::vector<InstructionSet> AvailableInstructionSets();
// The last of them, determined once.
InstructionSet BestInstructionSet();

// Makes Eigen cut products of large matrices alike on every machine: by itself it does so by the caches it finds, and
// sums then have another order. Once for the process.
void FixBlocksOfProducts();

}  // namespace vo
