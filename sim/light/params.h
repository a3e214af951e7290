// Parameters of the illumination: which part of it is baked, and how finely.
#pragma once

#include <vector>

#include "tools/base/settings/fields.h"

namespace sim {

enum class LightMode {
  direct,          // lamps with shadow rays in each frame, and ambient light; nothing is baked
  baked_indirect,  // lamps with shadow rays in each frame; the sky and all that bounces is baked
  baked            // all is baked: frames cost only their primary rays
};

struct BakeParams {
  double spacing_m = 0.1;
  double min_spacing_m = 0.01;
  int paths = 256;
  int lamp_rays = 64;
};

template <class V>
void Visit(V& v, BakeParams& p) {
  using settings::Range, settings::Unit;
  v("spacing", p.spacing_m, {Unit::length, Range::Positive(), "largest, of a triangle's samples; 2^8 to a side"});
  v.Renamed("finest", "min_spacing");
  v("min_spacing", p.min_spacing_m,
    {Unit::length, Range::Positive(), "at edges of baked lamps' light; 2^11 to a side"});
  v("paths", p.paths, {Range::PowerOfTwo(1 << 20), "of each sample"});
  v("lamp_rays", p.lamp_rays, {Range::PowerOfTwo(1 << 20), "of each sample to each area lamp, where lamps are baked"});
}
std::vector<settings::FieldProblem> Problems(BakeParams params);

}  // namespace sim
