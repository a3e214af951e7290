#define VOBENCH_PACKET_NAMESPACE packet_base
#define VOBENCH_PACKET_NAME "base"
#include "sim/render/packet.inc"
