#include "sim/render/packet.h"

namespace sim {

namespace packet_base {
extern const KernelChoice kKernel;
}
namespace packet_avx2 {
extern const KernelChoice kKernel;
}
namespace packet_avx512 {
extern const KernelChoice kKernel;
}

std::vector<KernelChoice> PacketKernels() {
  std::vector<KernelChoice> kernels{packet_base::kKernel};
#if defined(__x86_64__) && defined(__GNUC__)
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return kernels;
  kernels.push_back(packet_avx2::kKernel);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl")) {
    kernels.push_back(packet_avx512::kKernel);
  }
#endif
  return kernels;
}

}  // namespace sim
