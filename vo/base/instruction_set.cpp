#include "vo/base/instruction_set.h"

#include <Eigen/Core>

namespace vo {

const char* Name(InstructionSet set) {
  constexpr const char* kNames[] = {"base", "AVX2", "AVX-512"};
  return kNames[static_cast<int>(set)];
}

std::vector<InstructionSet> AvailableInstructionSets() {
  std::vector<InstructionSet> sets = {InstructionSet::base};
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) sets.push_back(InstructionSet::avx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    sets.push_back(InstructionSet::avx512);
#endif
  return sets;
}

InstructionSet BestInstructionSet() {
  static const InstructionSet best = AvailableInstructionSets().back();
  return best;
}

void FixBlocksOfProducts() {
  constexpr std::ptrdiff_t kKibibyte = 1024;
  static const bool fixed = (Eigen::setCpuCacheSizes(32 * kKibibyte, 512 * kKibibyte, 8192 * kKibibyte), true);
  static_cast<void>(fixed);
}

}  // namespace vo
