#define VOBENCH_MATCH_NAMESPACE match_base
#define VOBENCH_MATCH_WIDTH 2
#include "vo/map/match_lanes.inc"
