#define VOBENCH_PACKET_NAMESPACE packet_base
#include "sim/render/packet.inc"
