#define VOBENCH_MATCH_NAMESPACE match_avx512
#define VOBENCH_MATCH_WIDTH 8
#include "vo/map/match_lanes.inc"
