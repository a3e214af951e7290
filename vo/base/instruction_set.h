// Instruction sets that inner loops are compiled for, with dispatch at run time. All of them give the same bits.
#pragma once

#include <vector>

namespace vo {

enum class InstructionSet { base, avx2, avx512 };
const char* Name(InstructionSet set);
// Those of this machine, in ascending order.
std::vector<InstructionSet> AvailableInstructionSets();
// The last of them, determined once.
InstructionSet BestInstructionSet();

}  // namespace vo
