// Comparisons of the streams of a sequence with each other. Bounds: docs/truth.md.
// What is not there is not compared: the count() of its check stays as it is.
#pragma once

#include <vector>

#include "tools/judge/verification/frames.h"

namespace verification {

// Poses, velocities, accelerations and inertial readings. velocity.txt: position and orientation from stamp to stamp;
// acceleration.txt: velocities; imu0: all three.
std::vector<Check> CheckMotion(const Sequence& sequence);

// Pictures against each other through depth and poses, for place and time of their stamps.
std::vector<Check> PhotometricChecks();  // before the first comparison
void ComparePictures(Frames& frames, std::size_t frame, std::vector<Check>& checks);

// What each pixel sees: depth, distance, normals, ids, flow, occlusion, landmarks.
std::vector<Check> SurfaceChecks(const Sequence& sequence);
void CompareSurfaces(Frames& frames, std::size_t frame, std::vector<Check>& checks);

// Instances, classes and boxes, against each other, the legend and depth. None without a legend.
std::vector<Check> LabelChecks(const Sequence& sequence);
void CompareLabels(Frames& frames, std::size_t frame, std::vector<Check>& checks);

}  // namespace verification
