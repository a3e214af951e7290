#define VOBENCH_PACKET_NAMESPACE packet_avx512
#include "sim/render/packet.inc"
