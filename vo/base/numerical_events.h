// Purpose: how often the filter did something that its equations do not say. No such place is silent: each counts here.
#pragma once

namespace vo {

// Counts of one frame, over all particles.
struct Guards {
  int unsettled = 0;  // searches for a mode that their number of iterations ended, not the mode
  int behind = 0;     // matches that an update left out, because their landmark had come to lie behind the camera
  // Matrices that should have been positive definite and were not: what was found by them counts as impossible.
  int indefinite = 0;
  // Particles whose evidence was not a number: each became a copy of the heaviest, with half of its weight.
  int impossible = 0;

  Guards& operator+=(const Guards& more) {
    unsettled += more.unsettled;
    behind += more.behind;
    indefinite += more.indefinite;
    impossible += more.impossible;
    return *this;
  }
  bool operator==(const Guards&) const = default;
};

}  // namespace vo
