#define VOBENCH_PACKET_NAMESPACE packet_avx2
#define VOBENCH_PACKET_NAME "avx2"
#include "sim/render/packet.inc"
