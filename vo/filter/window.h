// Window of frames whose poses are not sampled, the same for all particles: their matches, the landmarks' tracks
// through them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vo/filter/landmark_table.h"
#include "vo/filter/path_window.h"

namespace vo {

class Window {
 public:
  struct Frame {
    double dt = 0;  // [s] since the one before
    std::uint32_t number = 0;
    MotionInput input;
    std::vector<Match> matches;
  };

  int size() const { return static_cast<int>(frames_.size()); }
  const std::vector<Frame>& frames() const { return frames_; }
  std::span<const Track> tracks() const { return tracks_; }
  Track TrackOf(int landmark, const LandmarkTable& table) const;      // empty where the window does not see it
  int anchor_slot(int anchor) const { return anchor_slot_[anchor]; }  // -1: sampled

  // The table is that of the landmarks, for the tracks.
  void Append(double dt, std::uint32_t number, const MotionInput& input, const LandmarkTable& table);
  void SetMatches(std::span<const Match> matches, const LandmarkTable& table);  // of the last frame
  void DropOldest(int count, const LandmarkTable& table);
  bool LastIsUnused() const;                    // no match, no anchor
  double DropLast(const LandmarkTable& table);  // returns its dt
  // The anchor of landmarks that were added in the last frame, or before the first.
  void AddAnchor(int anchor, const LandmarkTable& table);
  void Keep(const std::vector<int>& index, const LandmarkTable& table);  // of the table's Keep
  // Drops the matches of landmarks of other anchors.
  void KeepMatchesOf(const std::vector<bool>& anchors, const LandmarkTable& table);
  // The same window with f(slot, match) in the place of each match.
  template <class Function>
  Window WithMatches(const Function& f, const LandmarkTable& table) const {
    Window window = *this;
    for (int slot = 0; slot < size(); ++slot)
      for (Match& match : window.frames_[slot].matches) match = f(slot, match);
    window.BuildTracks(table);
    return window;
  }

  // Anchors' poses on a path: `sampled`, and those of the window's frames.
  void PlaceAnchors(const PathGaussian& path, std::vector<Pose>& anchors) const;

 private:
  void BuildTracks(const LandmarkTable& table);

  std::vector<Frame> frames_;     // the last is the present one
  std::vector<int> anchor_slot_;  // per anchor
  std::vector<Track> tracks_;     // of the landmarks with a match
  std::vector<int> track_of_;     // per landmark: index into tracks_ or -1
};

// Kalman gain of a match given the pose, and the landmark's covariance after it, for all particles that are alike.
struct LandmarkGain {
  bool in_front = false;
  Matrix23 J;                     // of the match by the landmark
  Eigen::Matrix<double, 3, 2> K;  // P J' S^-1
  Eigen::Matrix3d P;
};
// Of one particle, one for each match.
std::vector<LandmarkGain> GainsOf(std::span<const Match> matches, const LandmarkTable& table, const Pose& pose,
                                  std::span<const Pose> anchors, std::span<const Eigen::Vector3d> modes,
                                  std::span<const Landmark> landmarks);
// Landmarks given one sampled pose and its matches, linearised at the modes.
void UpdateLandmarks(std::span<const Match> matches, std::span<const LandmarkGain> gains, const LandmarkTable& table,
                     const Pose& pose, std::span<const Pose> anchors, std::span<const Eigen::Vector3d> modes,
                     std::vector<Landmark>& landmarks);

// Modes of the landmarks given the path, by Gauss-Newton from those of the solution: all views of a landmark linearised
// together.
std::vector<Eigen::Vector3d> Triangulate(const Window& window, const LandmarkTable& table, const WindowInput& in,
                                         const PathSolution& solution);

}  // namespace vo
