// Purpose: the instruction sets that inner loops are compiled for; which of them this machine has is asked at run time.
//          All of them give the same bits.
#pragma once

#include <vector>

namespace vo {

enum class InstructionSet { base, avx2, avx512 };
const char* Name(InstructionSet set);
// What this machine has, in rising order.
std::vector<InstructionSet> AvailableInstructionSets();
// The last of them, asked once.
InstructionSet BestInstructionSet();

}  // namespace vo
