// Sequence in the cache as an external program wants it: rectified, and in its layout.
// Source: docs/campaign.md, "External systems"; Engel, Usenko and Cremers 2016, "A photometrically calibrated benchmark
//   for monocular visual odometry", for times.txt, pcalib.txt and vignette.png.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "sim/sensor/camera.h"
#include "sim/sensor/description.h"
#include "tools/bench/campaign/external_system.h"
#include "tools/bench/campaign/sequence_cache.h"

namespace vobench {

// What is known of the pictures of a sequence.
struct PicturesOfSequence {
  sim::CameraParams camera;
  double rate_hz = 30;
  std::optional<sim::SensorParams> sensor;  // of rendered ones
};

// Pinhole of the largest upright rectangle of rays that this camera's picture holds, without a black border; its sides
// are multiples of 16. Of a pinhole the middle of its picture. Throws std::invalid_argument where the lens looks
// behind it.
sim::CameraParams RectifiedCamera(const sim::CameraParams& camera);

// Line of pcalib.txt: the irradiance, 0 to 255, of each code of 8 bits. Empty where pictures are processed after the
// response.
std::string InverseResponse(const sim::SensorParams& sensor);

struct ServedSequence {
  std::filesystem::path folder;
  sim::CameraParams camera;
};

// Links to the pictures in the cache, or rectified ones; made where they are missing. Throws BadInput,
// std::runtime_error.
ServedSequence Serve(const campaign::SequenceCache& cache, const std::string& key, const PicturesOfSequence& pictures,
                     const campaign::ExternalSystem& system);

}  // namespace vobench
