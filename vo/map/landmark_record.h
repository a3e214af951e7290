// Record of a landmark that all particles share: appearance and existence. The estimate is each particle's own.
#pragma once

#include "vo/features/matcher.h"
#include "vo/map/residual_history.h"

namespace vo {

struct LandmarkRecord {
  int id = 0;
  Appearance appearance;
  double score = 0;           // existence (44)-(49)
  int age = 0;                // frames since it was first seen
  int frames_unsearched = 0;  // in a row; a blind frame searches for nothing
  bool searched = false;      // in the last frame, blind or not, or begun in it
  bool permanent = false;
  ResidualHistory residuals;  // of its matches; used with MatchNoise::adaptive
};

}  // namespace vo
