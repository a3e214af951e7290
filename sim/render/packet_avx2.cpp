#define VOBENCH_PACKET_NAMESPACE packet_avx2
#include "sim/render/packet.inc"
