// Configuration files of visual-inertial programs for a sequence in EuRoC's layout: Kalibr, OpenVINS, VINS-Fusion,
// ORB-SLAM3, Basalt (docs/sequence_format.md). Their texts, with places to fill: sim/sequence/vio/*.in.
#pragma once

#include <vector>

#include "sim/sequence/layout.h"

namespace sim {

// None without an IMU. first: the frames of the first camera, whose times ORB-SLAM3 wants listed.
std::vector<StreamFile> VioFiles(const Scenario& scenario, std::span<const StampedTruth> first);

}  // namespace sim
