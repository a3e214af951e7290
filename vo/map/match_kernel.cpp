#include "vo/map/match_lanes.h"

namespace vo {

const MatchKernel& MatchKernelOf(InstructionSet set) {
#ifdef __x86_64__
  if (set == InstructionSet::avx512) return match_avx512::kKernel;
  if (set == InstructionSet::avx2) return match_avx2::kKernel;
#endif
  static_cast<void>(set);
  return match_base::kKernel;
}

}  // namespace vo
