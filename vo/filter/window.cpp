#include "vo/filter/window.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "vo/geometry/covariance.h"

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
  std::vector<double> inflation(static_cast<std::size_t>(table.size()), 0);
  for (const Match& match : matches) inflation[match.landmark] = match.inflation;
  for (Frame& frame : frames_) {
    for (Match& match : frame.matches) {
      if (inflation[match.landmark] == 0) continue;
      const double change = inflation[match.landmark] / std::exchange(match.inflation, inflation[match.landmark]);
      match.R *= change;
      match.wander *= change;
    }
  }
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

void Window::KeepMatchesOf(const std::vector<bool>& anchors, const LandmarkTable& table) {
  for (Frame& frame : frames_)
    std::erase_if(frame.matches, [&](const Match& match) { return !anchors[table.anchor_of(match.landmark)]; });
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
      Track& track = tracks_[index];
      track.provisional = match.provisional;
      track.wander = match.wander;
      const Eigen::Matrix2d R = match.R + static_cast<double>(track.views.size()) * match.wander;
      track.views.push_back(
          {slot, match.z, R.inverse(), std::log(R.determinant()), match.centre_offset_W, match.row.time});
    }
  }
  std::stable_partition(tracks_.begin(), tracks_.end(), [](const Track& track) { return !track.provisional; });
  for (std::size_t i = 0; i < tracks_.size(); ++i) track_of_[tracks_[i].landmark] = static_cast<int>(i);
}

std::vector<LandmarkGain> GainsOf(std::span<const Match> matches, const LandmarkTable& table, const Pose& pose,
                                  std::span<const Pose> anchors, std::span<const Eigen::Vector3d> modes,
                                  std::span<const Landmark> landmarks) {
  std::vector<LandmarkGain> gains;
  for (const Match& match : matches) {
    LandmarkGain& gain = gains.emplace_back();
    const Pose& anchor = anchors[table.anchor_of(match.landmark)];
    const Projection h = Project(AnchorView(pose, anchor).ShiftedBy(match.centre_offset_W), modes[match.landmark]);
    gain.in_front = h.in_front;
    if (!h.in_front) continue;
    const Eigen::Matrix3d& P = landmarks[match.landmark].covariance;
    const Eigen::Matrix<double, 3, 2> PJt = P * h.J_landmark.transpose();
    const Eigen::Matrix2d S = h.J_landmark * PJt + match.R;
    gain.J = h.J_landmark;
    gain.K = PJt * S.inverse();
    gain.P = Symmetrised(P - gain.K * PJt.transpose());
    gain.P.topLeftCorner<2, 2>() += match.wander;
  }
  return gains;
}

void UpdateLandmarks(std::span<const Match> matches, std::span<const LandmarkGain> gains, const LandmarkTable& table,
                     const Pose& pose, std::span<const Pose> anchors, std::span<const Eigen::Vector3d> modes,
                     std::vector<Landmark>& landmarks) {
  const Eigen::Matrix3d R_CW = pose.q_WC.conjugate().toRotationMatrix();
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (!gains[i].in_front) continue;
    const int n = matches[i].landmark;
    const Eigen::Vector3d X =
        ScaledPoint(R_CW, pose.p_WC + matches[i].centre_offset_W, anchors[table.anchor_of(n)], modes[n]);
    if (X.z() <= kMinDepth) continue;
    const Eigen::Vector2d e = matches[i].z - X.head<2>() / X.z() - gains[i].J * (landmarks[n].mean - modes[n]);
    landmarks[n].mean += gains[i].K * e;
    landmarks[n].covariance = gains[i].P;
  }
}

std::vector<Eigen::Vector3d> Triangulate(const Window& window, const LandmarkTable& table, const WindowInput& in,
                                         const PathSolution& solution) {
  std::vector<Pose> anchors(in.anchors.begin(), in.anchors.end());
  window.PlaceAnchors(solution.path, anchors);
  std::vector<Eigen::Vector3d> modes = solution.modes;
  for (int round = 0; round < kTriangulations; ++round) {
    std::vector<Landmark> landmarks(in.landmarks.begin(), in.landmarks.end());
    for (int k = 0; k < window.size(); ++k) {
      const std::vector<Match>& matches = window.frames()[k].matches;
      const Pose& pose = solution.path.mean[k];
      UpdateLandmarks(matches, GainsOf(matches, table, pose, anchors, modes, landmarks), table, pose, anchors, modes,
                      landmarks);
    }
    for (const Track& track : window.tracks()) modes[track.landmark] = landmarks[track.landmark].mean;
  }
  return modes;
}

}  // namespace vo
