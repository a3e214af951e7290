#define VOBENCH_MATCH_NAMESPACE match_avx2
#define VOBENCH_MATCH_WIDTH 4
#include "vo/map/match_lanes.inc"
