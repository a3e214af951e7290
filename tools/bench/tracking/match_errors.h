// Errors of matches and predictions, and lifetimes of landmarks, against the truth of a sequence, frame by frame:
// `vobench track --truth`. A landmark is the scene point at the pixel of its first view. Where the sequence has depth
// at the stamp of that view, the point is known and a match has an error of two dimensions; from the poses alone a
// match is known to lie on the epipolar line of the first view. A rolling shutter is taken into account; the scene is
// assumed static. Units: pixels, seconds.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "tools/bench/points/truth.h"
#include "vo/base/result.h"
#include "vo/geometry/camera.h"

namespace vobench {

// True pose T_WC of the camera at any time, from the truth of a sequence.
class TrueMotion {
 public:
  explicit TrueMotion(Truth truth) : truth_(std::move(truth)) {}

  // Between two poses of the truth: cubic Hermite in position and rotation vector where both have a velocity, else
  // linear; beyond the ends at constant velocity. None in gaps of more than 0.25 s, and beyond half of that after an
  // end.
  std::optional<vo::Pose> At(std::int64_t stamp_ns) const;

 private:
  Truth truth_;
};

class MatchErrors {
 public:
  // Measured quantities of features; each has its values over a frame, and over the sequence.
  enum Quantity {
    kMatch,        // |match - true pixel| of matches whose landmark is known and on a smooth surface [px]
    kEpipolar,     // distance of a match to the first view's epipolar line beyond 0.1 m of depth [px]
    kPrediction,   // |match - prediction| [px]
    kTruePredict,  // |true pixel - prediction| of all searched landmarks that are known and in the image [px]
    kInnovation,   // nu' S^-1 nu / 2 of matches: 1 on average where prediction and noise are right
    kQuantities
  };

  // The camera as it is, and the sequence's truth and depth (depth.txt, at the stamps of frames). Throws
  // evaluation::InputError where depth.txt is malformed.
  MatchErrors(const std::filesystem::path& sequence, const vo::Camera& camera, Truth truth);

  // The features of the next frame. Throws std::runtime_error naming a depth picture that cannot be read.
  void Add(std::int64_t stamp_ns, const std::vector<vo::FeatureView>& features);

  // matches.csv and lives.csv (docs/result_folder.md). Throws std::runtime_error.
  void Write(const std::filesystem::path& folder) const;
  // Of all frames, for a terminal.
  std::string Table() const;

 private:
  struct Landmark {
    std::int64_t first_ns = 0, last_ns = 0;  // first view, last match
    int matches = 0;
    std::optional<vo::Pose> view;        // true pose of the first view's row
    Eigen::Vector3d ray;                 // of the first view, (x, y, 1) in C
    std::optional<Eigen::Vector3d> X_W;  // none: depth is not known
    bool smooth = false;                 // no depth edge in the patch of 9 x 9 pixels
  };
  struct Frame {
    std::int64_t stamp_ns = 0;
    std::array<int, 4> count{};  // by FeatureView::Status
    int reobserved = 0;          // matches of landmarks that had none for a second or more
    std::array<std::vector<double>, kQuantities> values;
  };

  std::optional<vo::Pose> RowPose(std::int64_t stamp_ns, double row) const;
  std::optional<Eigen::Vector2d> TruePixel(const Eigen::Vector3d& X_W, std::int64_t stamp_ns) const;
  std::optional<double> EpipolarDistance(const Landmark& landmark, const Eigen::Vector2d& pixel,
                                         std::int64_t stamp_ns) const;
  void Begin(std::int64_t stamp_ns, const std::vector<vo::FeatureView>& features);
  void Measure(const vo::FeatureView& feature, Landmark& landmark, Frame& frame) const;

  vo::Camera camera_;
  TrueMotion motion_;
  std::map<std::int64_t, std::filesystem::path> depths_;  // by stamp
  std::unordered_map<int, Landmark> landmarks_;           // by FeatureView::id
  std::vector<Frame> frames_;
};

}  // namespace vobench
