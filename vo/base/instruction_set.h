// Machine-dependent choices that leave results bit-identical: instruction sets of inner loops, with dispatch at run
// time, and the block sizes of matrix products.
#pragma once

#include <vector>

namespace vo {

enum class InstructionSet { base, avx2, avx512 };
const char* Name(InstructionSet set);
// Those of this machine, in ascending order.
std::vector<InstructionSet> AvailableInstructionSets();
// The last of them, determined once.
InstructionSet BestInstructionSet();

// Fixes Eigen's blocking of large matrix products on every machine: its default depends on the caches, which changes
// the order of sums. Once for the process.
void FixBlocksOfProducts();

}  // namespace vo
