#include "vo/filter/window.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vo/geometry/so3.h"

namespace vo {
namespace {

constexpr int kTriangulations = 3;

}  // namespace

Track Window::TrackOf(int landmark, const LandmarkTable& table) const {
  if (track_of_[landmark] >= 0) return tracks_[track_of_[landmark]];
  const int anchor = table.anchor_of(landmark);
  return {landmark, anchor, anchor_slot_[anchor], {}};
}

void Window::Append(double dt, std::uint32_t number, const MotionInput& input, const LandmarkTable& table) {
  frames_.push_back({dt, number, input, {}});
  BuildTracks(table);
}

void Window::SetMatches(std::span<const Match> matches, const LandmarkTable& table) {
  frames_.back().matches.assign(matches.begin(), matches.end());
  BuildTracks(table);
}

void Window::DropOldest(int count, const LandmarkTable& table) {
  frames_.erase(frames_.begin(), frames_.begin() + count);
  for (int& slot : anchor_slot_) slot = std::max(slot - count, -1);
  BuildTracks(table);
}

bool Window::LastIsUnused() const {
  return !frames_.empty() && frames_.back().matches.empty() &&
         std::find(anchor_slot_.begin(), anchor_slot_.end(), size() - 1) == anchor_slot_.end();
}

double Window::DropLast(const LandmarkTable& table) {
  const double dt = frames_.back().dt;
  frames_.pop_back();
  BuildTracks(table);
  return dt;
}

void Window::AddAnchor(int anchor, const LandmarkTable& table) {
  anchor_slot_.resize(table.anchor_count());
  anchor_slot_[anchor] = size() - 1;
  BuildTracks(table);
}

void Window::Keep(const std::vector<int>& index, const LandmarkTable& table) {
  for (Frame& frame : frames_) {
    std::erase_if(frame.matches, [&](const Match& match) { return index[match.landmark] < 0; });
    for (Match& match : frame.matches) match.landmark = index[match.landmark];
  }
  BuildTracks(table);
}

void Window::PlaceAnchors(const PathGaussian& path, std::vector<Pose>& anchors) const {
  for (std::size_t a = 0; a < anchors.size(); ++a)
    if (anchor_slot_[a] >= 0) anchors[a] = path.mean[anchor_slot_[a]];
}

void Window::BuildTracks(const LandmarkTable& table) {
  tracks_.clear();
  track_of_.assign(table.size(), -1);
  for (int slot = 0; slot < size(); ++slot) {
    for (const Match& match : frames_[slot].matches) {
      int& index = track_of_[match.landmark];
      if (index < 0) {
        index = static_cast<int>(tracks_.size());
        const int anchor = table.anchor_of(match.landmark);
        tracks_.push_back({match.landmark, anchor, anchor_slot_[anchor], {}});
      }
      tracks_[index].views.push_back(
          {slot, match.z, match.R.inverse(), std::log(match.R.determinant()), match.centre_offset_W});
    }
  }
}

void UpdateLandmarks(std::span<const Match> matches, const LandmarkTable& table, const Pose& pose,
                     std::span<const Pose> anchors, std::span<const Eigen::Vector3d> modes,
                     std::vector<Landmark>& landmarks) {
  const std::vector<AnchorView> views = ViewsOf(anchors, pose);
  for (const Match& match : matches) {
    const AnchorView view = views[table.anchor_of(match.landmark)].ShiftedBy(match.centre_offset_W);
    Landmark& landmark = landmarks[match.landmark];
    landmark = UpdateLandmark(landmark, modes[match.landmark], view, match, 1).landmark;
  }
}

PathSolution PerturbTranslation(const Window& window, const LandmarkTable& table, const WindowInput& in,
                                const PathSolution& solution, std::uint32_t guess) {
  PathSolution other = solution;
  double rho = 0;
  for (const Track& track : window.tracks())
    rho += solution.modes[track.landmark].z() / static_cast<double>(window.tracks().size());
  const Eigen::Vector3d translation = in.start.q_WC.conjugate() * (solution.path.mean.back().p_WC - in.start.p_WC);
  const double length = translation.norm();
  const Eigen::Vector2d targets[kGuesses] = {{0, 0},      -translation.head<2>(), {length, 0},
                                             {0, length}, {-length, 0},           {0, -length}};
  const Eigen::Vector2d change = targets[guess] - translation.head<2>();
  double duration = 0, time = 0;
  for (const Window::Frame& frame : window.frames()) duration += frame.dt;
  for (int k = 0; k < window.size(); ++k) {
    time += window.frames()[k].dt;
    const Eigen::Vector2d c = time / duration * change;
    Pose& pose = other.path.mean[k];
    pose.p_WC += in.start.q_WC * Eigen::Vector3d(c.x(), c.y(), 0);
    pose.q_WC = (pose.q_WC * Exp({rho * c.y(), -rho * c.x(), 0})).normalized();
  }
  for (const Track& track : window.tracks()) other.modes[track.landmark] = in.landmarks[track.landmark].mean;
  other.modes = Triangulate(window, table, in, other);
  return other;
}

std::vector<Eigen::Vector3d> Triangulate(const Window& window, const LandmarkTable& table, const WindowInput& in,
                                         const PathSolution& solution) {
  std::vector<Pose> anchors(in.anchors.begin(), in.anchors.end());
  window.PlaceAnchors(solution.path, anchors);
  std::vector<Eigen::Vector3d> modes = solution.modes;
  for (int round = 0; round < kTriangulations; ++round) {
    std::vector<Landmark> landmarks(in.landmarks.begin(), in.landmarks.end());
    for (int k = 0; k < window.size(); ++k)
      UpdateLandmarks(window.frames()[k].matches, table, solution.path.mean[k], anchors, modes, landmarks);
    for (const Track& track : window.tracks()) modes[track.landmark] = landmarks[track.landmark].mean;
  }
  return modes;
}

}  // namespace vo
