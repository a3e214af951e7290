// Function that is compiled twice, the second time for AVX2, which is chosen where the machine has it. Both give the
// same numbers: AVX2 has no fused multiplication.
#pragma once

#if defined(__x86_64__) && !defined(__SANITIZE_THREAD__)  // which crashes where the choice is made, before it is loaded
#define VOBENCH_FOR_AVX2_TOO __attribute__((target_clones("default", "avx2")))
#else
#define VOBENCH_FOR_AVX2_TOO
#endif
