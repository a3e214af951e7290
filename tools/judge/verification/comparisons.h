// Comparisons of the streams of a sequence with each other. Bounds: docs/truth.md.
// Missing streams are not compared: the count() of their check stays unchanged.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "tools/judge/verification/files.h"

namespace verification {

// Pictures of a sequence, decoded on demand, and the geometry between two frames.
class Frames {
 public:
  // Failures (a file that is missing, unreadable, of another size or type) go to `files`, each file once.
  Frames(const Sequence& sequence, Check& files);

  const Sequence& sequence() const { return sequence_; }
  std::size_t count() const { return sequence_.stamps.size(); }
  std::string Stamp(std::size_t frame) const;

  // Empty when the frame has none, or an invalid one. The last few frames are kept.
  cv::Mat Picture(const std::string& stream, std::size_t frame);
  // Z [m], CV_32FC1, from depth_exr where there is one, else from depth. Empty when there is neither.
  cv::Mat Depth(std::size_t frame);
  // Grey, 0 ... 255, a little blurred, CV_32FC1: for comparing pictures.
  cv::Mat Smooth(std::size_t frame);
  // Bound on the error of a depth: half a step of the 16-bit picture, or of a float.
  double DepthError(double Z) const { return Z * 1.2e-7 + (exact_ ? 0 : 1.0001e-4); }

  // (x, y, 1) of each pixel's centre, row by row.
  const std::vector<Eigen::Vector3d>& rays() const { return rays_; }

 private:
  const Sequence& sequence_;
  Check& files_;
  bool exact_;
  std::vector<Eigen::Vector3d> rays_;
  std::map<std::size_t, std::map<std::string, cv::Mat>> pictures_;  // by frame, by stream
  std::set<std::string> complained_;
};

// From C of one frame to C of another: X' = R X + t.
struct Relative {
  Eigen::Matrix3d R;
  Eigen::Vector3d t;
};
Relative Between(const vo::Pose& from, const vo::Pose& to);
std::optional<Relative> Between(const Sequence& sequence, std::size_t from, std::size_t to);

// From C of one frame to C of another, for each pixel of the first: with the static world or, where the mask `moving`
// is set, with one of the objects, which it does not identify. Without a mask a pixel may be of any of them.
class PixelMotions {
 public:
  PixelMotions(Frames& frames, std::size_t from, std::size_t to);

  bool known() const { return !motions_.empty(); }  // false: a frame has no pose
  bool IsMoving(std::size_t pixel) const { return !mask_.empty() && mask_.data[pixel] != 0; }
  std::span<const Relative> Of(std::size_t pixel) const;
  // Motions excluded by the mask.
  std::span<const Relative> Others(std::size_t pixel) const;

 private:
  cv::Mat mask_;
  std::vector<Relative> motions_;  // the world's, then the objects'
};

// Bilinear, where all four pixels around (x, y) are in the picture.
struct Corners {
  int x, y;    // of the upper left
  float a, b;  // the place between: 0 ... 1
};
std::optional<Corners> CornersAt(const cv::Mat& picture, double x, double y);
inline float Mix(const Corners& c, float p00, float p10, float p01, float p11) {
  return (1 - c.b) * ((1 - c.a) * p00 + c.a * p10) + c.b * ((1 - c.a) * p01 + c.a * p11);
}

// The pictures that a frame is compared with: its neighbours, and at the ends the two on one side.
std::vector<std::size_t> Partners(std::size_t frame, std::size_t count);

// Poses, velocities, accelerations and inertial readings. velocity.txt: position and orientation from stamp to stamp;
// acceleration.txt: velocities; imu0: all three.
std::vector<Check> CheckMotion(const Sequence& sequence);

// Pictures against each other through depth and poses, for place and time of their stamps.
std::vector<Check> PhotometricChecks();  // before the first comparison
void ComparePictures(Frames& frames, std::size_t frame, std::vector<Check>& checks);

// Surfaces of the pixels: depth, distance, normals, ids, flow, occlusion, landmarks.
std::vector<Check> SurfaceChecks(const Sequence& sequence);
void CompareSurfaces(Frames& frames, std::size_t frame, std::vector<Check>& checks);

// The possible motions of a pixel's surface point, between two pictures.
using Motions = std::function<std::span<const Relative>(std::size_t pixel)>;

// For pixels of `from` at one frame that are visible in `to`, perhaps of another camera, at another: the difference of
// their depths over its bound, by `add`.
void MatchDepths(Frames& from, std::size_t frame, Frames& to, std::size_t to_frame, const Motions& motions,
                 const std::function<void(std::size_t pixel, double ratio)>& add);

// The mask `stream` of surfaces hidden there.
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
