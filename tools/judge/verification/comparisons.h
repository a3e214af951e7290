// Comparisons of the streams of a sequence with each other. Bounds: docs/truth.md.
// What is not there is not compared: the count() of its check stays as it is.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
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

// The motions that the point which a pixel sees may have made, between two pictures.
using Motions = std::function<std::span<const Relative>(std::size_t pixel)>;

// For pixels that `from` sees at one frame and `to`, perhaps of another camera, at another: the difference of their
// depths over its bound, by `add`.
void MatchDepths(Frames& from, std::size_t frame, Frames& to, std::size_t to_frame, const Motions& motions,
                 const std::function<void(std::size_t pixel, double ratio)>& add);

// The mask `stream` of what is hidden there.
void CompareHidden(Frames& from, std::size_t frame, const std::string& stream, Frames& to, std::size_t to_frame,
                   const Motions& motions, Check& check);

// A camera's sequence with its pictures. arm_m: from the body of the rig, whose roughness the manifest has.
struct Part {
  Part(const std::filesystem::path& folder, const std::filesystem::path& manifest, double arm_m = 0);
  Check files{"files: present, readable, of one size", ""}, stamps{"stamps: increasing, the same in all lists", ""};
  Sequence sequence;
  Frames frames;
};
// A rig: its cameras against each other, the body and the IMU.
std::vector<Check> CheckRig(const std::filesystem::path& folder, const std::vector<RigCamera>& rig,
                            const std::vector<std::unique_ptr<Part>>& parts);

// Instances, classes and boxes, against each other, the legend and depth. None without a legend.
std::vector<Check> LabelChecks(const Sequence& sequence);
void CompareLabels(Frames& frames, std::size_t frame, std::vector<Check>& checks);

}  // namespace verification
