#define VOBENCH_PACKET_NAMESPACE packet_avx512
#define VOBENCH_PACKET_NAME "avx512"
#include "sim/render/packet.inc"
