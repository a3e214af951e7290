#include "sim/render/packet.h"

namespace sim {

KernelChoice PacketKernel() {
#if defined(__x86_64__) && defined(__GNUC__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("fma")) {
    return {packet_avx512::ExposeBlock, packet_avx512::ScrambleBlock, "avx512"};
  }
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return {packet_avx2::ExposeBlock, packet_avx2::ScrambleBlock, "avx2"};
#endif
  return {packet_base::ExposeBlock, packet_base::ScrambleBlock, "base"};
}

}  // namespace sim
