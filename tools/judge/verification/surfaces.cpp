#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/judge/verification/comparisons.h"

namespace verification {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Fraction of a check's pixels that may exceed their bound: where several surfaces meet within a pixel, the surface
// between neighbours is unknown.
constexpr double kEdges = 1e-3;
constexpr double kRayError = 2e-6;  // of the pixel through which a point is seen [px], and of a float's flow
constexpr double kFloat = 1.2e-7;   // twice a float's rounding
constexpr float kUnknown = 1e9f;
constexpr double kNone = std::numeric_limits<double>::infinity();

enum Row {
  kDepth,
  kDistance,
  kFacing,
  kNormals,
  kIds,
  kNeighbours,
  kFlow,
  kBackward,
  kThereAndBack,
  kOcclusion,
  kOcclusionBackward,
  kLandmarks,
  kTracks,
  kObjects,  // those two only where there are objects
  kMask
};

// The share of pixels beyond their bound.
struct Share {
  std::size_t bad = 0, count = 0;
  void Add(bool good) { bad += !good, ++count; }
  void Into(Check& check, const std::string& where, double edges = kEdges) const {
    // A few pixels may be at edges in any picture.
    if (count >= 100)
      check.Add(static_cast<double>(bad) / static_cast<double>(count), edges + 3.0 / static_cast<double>(count), where);
  }
};

double At(const cv::Mat& picture, std::size_t i) {
  return static_cast<double>(reinterpret_cast<const float*>(picture.data)[i]);
}

// The smallest and largest depth of the pixels (x - grow ... x + 1 + grow) around a place; min 0: nothing is there.
struct DepthRange {
  double min = kNone, max = 0;
};
DepthRange RangeAround(const cv::Mat& depth, double x, double y, int grow) {
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  DepthRange range;
  for (int j = std::max(y0 - grow, 0); j <= std::min(y0 + 1 + grow, depth.rows - 1); ++j) {
    for (int i = std::max(x0 - grow, 0); i <= std::min(x0 + 1 + grow, depth.cols - 1); ++i) {
      const double Z = static_cast<double>(depth.at<float>(j, i));
      range.min = std::min(range.min, Z);
      range.max = std::max(range.max, Z);
    }
  }
  return range;
}

// Whether a point at depth Z agrees with the pixels around it: a surface between them curves no more than it rises.
bool IsSeen(const DepthRange& range, double Z, double error) {
  const double rise = range.max - range.min + error;
  return Z >= range.min - rise && Z <= range.max + rise;
}

// Where a ray lies between those of four pixels, as CornersAt has it between the pixels: a lens bends what is between.
Vector2d Between(const Frames& frames, const Corners& c, const cv::Mat& picture, const Vector3d& X) {
  const std::size_t width = static_cast<std::size_t>(picture.cols),
                    i = static_cast<std::size_t>(c.y) * width + static_cast<std::size_t>(c.x);
  const Vector2d r[4] = {frames.rays()[i].head<2>(), frames.rays()[i + 1].head<2>(), frames.rays()[i + width].head<2>(),
                         frames.rays()[i + width + 1].head<2>()};
  Vector2d at(static_cast<double>(c.a), static_cast<double>(c.b));
  for (int step = 0; step < 3; ++step) {
    const double a = at.x(), b = at.y();
    Eigen::Matrix2d J;
    J << (1 - b) * (r[1] - r[0]) + b * (r[3] - r[2]), (1 - a) * (r[2] - r[0]) + a * (r[3] - r[1]);
    at += J.inverse() * (X.hnormalized() - (1 - b) * ((1 - a) * r[0] + a * r[1]) - b * ((1 - a) * r[2] + a * r[3]));
  }
  return at;
}

// Depth at a place of a picture, compared with a point X = Z ray + t there. All in inverse depth, which is linear in
// (X / Z, Y / Z) on a plane [1/m].
struct DepthMatch {
  double difference, bound, bend;  // bound: from rounding; bend: of the four pixels, from a plane
};
std::optional<DepthMatch> MatchAt(const Frames& frames, const cv::Mat& there, const Corners& c, double Z,
                                  const Vector3d& ray, const Vector3d& X) {
  const float z[4] = {there.at<float>(c.y, c.x), there.at<float>(c.y, c.x + 1), there.at<float>(c.y + 1, c.x),
                      there.at<float>(c.y + 1, c.x + 1)};
  if (!(std::min({z[0], z[1], z[2], z[3]}) > 0)) return std::nullopt;
  double w[4];
  for (int i = 0; i < 4; ++i) w[i] = 1 / static_cast<double>(z[i]);
  const Vector2d at = Between(frames, c, there, X);
  const double a = at.x(), b = at.y();
  const double seen = (1 - b) * ((1 - a) * w[0] + a * w[1]) + b * ((1 - a) * w[2] + a * w[3]);
  const vo::Camera& camera = frames.sequence().camera;
  // Displacement of the pixel by the error of Z, times the slope there.
  const Vector2d moved = camera.Project(X + frames.DepthError(Z) * ray) - camera.Project(X);
  const double slope = std::max(std::abs(w[1] - w[0]), std::abs(w[2] - w[0]));
  const double rounding = frames.DepthError(X.z()) / (X.z() * X.z());
  return DepthMatch{std::abs(seen - 1 / X.z()),
                    rounding * (2 + std::abs(ray.z())) + slope * (moved.norm() + kRayError) + 4 * kFloat * seen,
                    std::abs(w[0] - w[1] - w[2] + w[3])};
}

void DepthPictures(Frames& frames, std::size_t frame, Check& check) {
  const cv::Mat coded = frames.Picture("depth", frame), exact = frames.Picture("depth_exr", frame);
  if (coded.empty() || exact.empty()) return;
  LargestRatio worst;
  for (std::size_t i = 0; i < exact.total(); ++i) {
    const double Z = At(exact, i), step = static_cast<double>(coded.at<std::uint16_t>(static_cast<int>(i))) / 5000;
    const bool fits = Z * 5000 < 65535.5;
    worst.Add(std::abs(step - (fits ? Z : 0)), 1.0001e-4 + kFloat * Z);
  }
  check.Add(worst, "depth " + frames.Stamp(frame));
}

void Distance(Frames& frames, std::size_t frame, Check& check) {
  const cv::Mat distance = frames.Picture("distance", frame), depth = frames.Depth(frame);
  if (distance.empty() || depth.empty()) return;
  LargestRatio worst;
  for (std::size_t i = 0; i < depth.total(); ++i) {
    const double Z = At(depth, i), length = frames.rays()[i].norm(), D = At(distance, i);
    if (Z == 0 && D * 5000 > 65535 * length) continue;  // beyond what 16 bits hold
    worst.Add(std::abs(D - Z * length), length * frames.DepthError(Z) + 2 * kFloat * D + 1e-12);
  }
  check.Add(worst, "distance " + frames.Stamp(frame));
}

// Normal of the plane through four neighbours, where they and the middle are coplanar within their depth errors.
void Normals(Frames& frames, std::size_t frame, std::vector<Check>& checks) {
  const cv::Mat normals = frames.Picture("normals", frame), depth = frames.Depth(frame);
  if (normals.empty() || depth.empty()) return;
  const auto width = static_cast<std::size_t>(depth.cols);
  const std::vector<Vector3d>& rays = frames.rays();
  LargestRatio facing;
  Share share;
  for (std::size_t i = 0; i < depth.total(); ++i) {
    const float* file = reinterpret_cast<const float*>(normals.data) + 3 * i;
    const Vector3d n(static_cast<double>(file[0]), static_cast<double>(file[1]), static_cast<double>(file[2]));
    const double Z = At(depth, i);
    if (Z == 0) continue;
    facing.Add(std::max(std::abs(n.norm() - 1), std::max(0.0, n.dot(rays[i].normalized()))), 5e-7);
    const std::size_t x = i % width, y = i / width;
    if (x == 0 || y == 0 || x + 1 == width || y + 1 == static_cast<std::size_t>(depth.rows)) continue;
    const std::size_t cross[4] = {i - 1, i + 1, i - width, i + width};
    Vector3d X[4];
    bool whole = true;
    for (int k = 0; k < 4; ++k) {
      const double Zk = At(depth, cross[k]);
      whole = whole && Zk > 0;
      X[k] = Zk * rays[cross[k]];
    }
    const Vector3d across = X[1] - X[0], down = X[3] - X[2], fit = down.cross(across).normalized();
    if (!whole || !fit.allFinite()) continue;
    double error = std::abs(fit.dot(rays[i])) * frames.DepthError(Z);  // of a point, off the plane
    for (int k = 0; k < 4; ++k)
      error = std::max(error, std::abs(fit.dot(rays[cross[k]])) * frames.DepthError(X[k].z()));
    bool plane = true;
    for (const Vector3d& there : X) plane = plane && std::abs(fit.dot(there - Z * rays[i])) <= 2 * error;
    if (!plane) continue;
    const double sine = across.normalized().cross(down.normalized()).norm();
    const double bound = 4 * error * (1 / across.norm() + 1 / down.norm()) / sine + 1e-6;
    if (bound > 0.3) continue;  // too coarse for a comparison
    share.Add((n - (fit.dot(rays[i]) > 0 ? Vector3d(-fit) : fit)).norm() <= bound);
  }
  checks[kFacing].Add(facing, "normals " + frames.Stamp(frame));
  share.Into(checks[kNormals], "normals " + frames.Stamp(frame));
}

void SurfaceIds(Frames& frames, std::size_t frame, Check& check) {
  const cv::Mat ids = frames.Picture("surface_id", frame), depth = frames.Depth(frame);
  if (ids.empty() || depth.empty()) return;
  const bool exact = !frames.Picture("depth_exr", frame).empty();
  std::size_t bad = 0;
  for (std::size_t i = 0; i < ids.total(); ++i) {
    const std::uint16_t id = ids.at<std::uint16_t>(static_cast<int>(i));
    if (At(depth, i) > 0 && id == 0) ++bad;
    if (At(depth, i) == 0 && id != 0 && exact) ++bad;
    if (id > frames.sequence().surfaces) ++bad;
  }
  check.Add(static_cast<double>(bad), 0.5, "surface_id " + frames.Stamp(frame));
}

// A visible point lies, in a neighbouring frame, on the surface seen there: the inverse depth of a plane is linear in
// the picture. Half of the samples must be within the rounding; the others may be hidden there.
void DepthInNeighbours(Frames& frames, std::size_t frame, Check& check) {
  double best[2] = {kNone, kNone};  // of the world, of objects
  for (const std::size_t partner : Partners(frame, frames.count())) {
    const PixelMotions motions(frames, frame, partner);
    if (!motions.known()) continue;
    std::vector<double> ratios[2];
    MatchDepths(
        frames, frame, frames, partner, [&](std::size_t i) { return motions.Of(i); },
        [&](std::size_t i, double ratio) { ratios[motions.IsMoving(i)].push_back(ratio); });
    for (std::size_t kind = 0; kind < 2; ++kind) {
      // An object is small: more of it than half may be hidden in a neighbour, but not three quarters in both.
      const std::size_t middle = ratios[kind].size() / (kind == 0 ? 2 : 4);
      if (ratios[kind].size() < 100) continue;
      std::nth_element(ratios[kind].begin(), ratios[kind].begin() + static_cast<std::ptrdiff_t>(middle),
                       ratios[kind].end());
      best[kind] = std::min(best[kind], ratios[kind][middle]);
    }
  }
  if (best[0] < kNone) check.Add(best[0], 1, "depth " + frames.Stamp(frame));
  if (best[1] < kNone) check.Add(best[1], 1, "depth " + frames.Stamp(frame) + ", objects");
}

// A pixel is consistent where one of its possible motions explains its flow. One that is consistent with the excluded
// motions only shows that the mask is wrong.
void Flow(Frames& frames, std::size_t frame, const std::string& stream, std::size_t to, Check& check,
          std::vector<Check>& checks) {
  const cv::Mat flow = frames.Picture(stream, frame), depth = frames.Depth(frame);
  const PixelMotions motions(frames, frame, to);
  if (flow.empty() || depth.empty() || !motions.known()) return;
  const vo::Camera& camera = frames.sequence().camera;
  const auto width = static_cast<std::size_t>(depth.cols);
  LargestRatio worst[2];
  std::size_t masked_wrong = 0, masked = 0;
  for (std::size_t i = 0; i < depth.total(); ++i) {
    const double Z = At(depth, i), error = frames.DepthError(Z);
    if (Z == 0) continue;
    const float* uv = reinterpret_cast<const float*>(flow.data) + 2 * i;
    const std::size_t x = i % width, y = i / width;
    const Vector2d at(static_cast<double>(x), static_cast<double>(y));
    const bool known = uv[0] < kUnknown && uv[1] < kUnknown;
    const auto best_of = [&](std::span<const Relative> moves) {
      LargestRatio best;
      best.ratio = kNone, best.value = kNone;
      for (const Relative& move : moves) {
        const Vector3d ray = move.R * frames.rays()[i], X = Z * ray + move.t;
        LargestRatio here;
        if (std::abs(X.z()) <= 2 * error) return LargestRatio{};  // on the other camera's edge
        if (!known || X.z() < 0) {
          here.Add(known == (X.z() > 0) ? 0 : kNone, 1);
        } else {
          const Vector2d pixel = camera.Project(X);
          const Vector2d moved = camera.Project(X + error * ray) - pixel, expected = pixel - at;
          const double miss = (Vector2d(static_cast<double>(uv[0]), static_cast<double>(uv[1])) - expected).norm();
          here.Add(miss, 1.1 * moved.norm() + kRayError * std::max(1.0, Z / X.z()) + 1e-6 * expected.norm());
        }
        if (here.ratio < best.ratio) best = here;
      }
      return best;
    };
    const LargestRatio best = best_of(motions.Of(i));
    if (best.ratio < 0) continue;
    ++masked;
    if (best.ratio > 1 && best_of(motions.Others(i)).ratio <= 1) {
      ++masked_wrong;
    } else {
      worst[motions.IsMoving(i)].Add(best.value, best.bound);
    }
  }
  const std::string where = stream + " " + frames.Stamp(frame);
  check.Add(worst[0], where);
  if (frames.sequence().objects.empty()) {
    check.Add(worst[1], where + ": pixels of objects, of which there are none");
    return;
  }
  checks[kObjects].Add(worst[1], where);
  if (masked > 0 && !frames.Picture("moving", frame).empty()) {
    checks[kMask].Add(static_cast<double>(masked_wrong), 0.5, "moving " + frames.Stamp(frame) + " (" + stream + ")");
  }
}

// The flow f to the next frame is inverted by the flow there, bilinear between four pixels; with an error of at most
// the deviation of the pixels around from a plane, on one surface (by far) and between two.
void FlowThereAndBack(Frames& frames, std::size_t frame, Check& check) {
  const cv::Mat forward = frames.Picture("flow", frame), hidden = frames.Picture("occlusion", frame),
                backward = frames.Picture("flow_backward", frame + 1);
  if (forward.empty() || hidden.empty() || backward.empty()) return;
  Share share;
  for (int y = 0; y < forward.rows; ++y) {
    for (int x = 0; x < forward.cols; ++x) {
      if (hidden.at<std::uint8_t>(y, x) != 0) continue;
      const cv::Vec2f& f = forward.at<cv::Vec2f>(y, x);
      const double px = x + static_cast<double>(f[0]), py = y + static_cast<double>(f[1]);
      const auto c = CornersAt(backward, px, py);
      if (!c || c->x < 1 || c->y < 1 || c->x + 2 >= backward.cols || c->y + 2 >= backward.rows) continue;
      const auto b = [&](int i, int j) { return backward.at<cv::Vec2f>(c->y + j, c->x + i); };
      double error = 0, bound = 2 * kRayError + 1e-6 * std::hypot(static_cast<double>(f[0]), static_cast<double>(f[1]));
      for (int axis = 0; axis < 2; ++axis) {
        const float back = Mix(*c, b(0, 0)[axis], b(1, 0)[axis], b(0, 1)[axis], b(1, 1)[axis]);
        const float corner = b(0, 0)[axis], across = b(1, 0)[axis] - corner, down = b(0, 1)[axis] - corner;
        float bend = 0;  // of the sixteen pixels around, from the plane through three of the four
        for (int i = -1; i < 3; ++i) {
          for (int j = -1; j < 3; ++j) {
            const float plane = corner + static_cast<float>(i) * across + static_cast<float>(j) * down;
            bend = std::max(bend, std::abs(b(i, j)[axis] - plane));
          }
        }
        error = std::max(error, static_cast<double>(std::abs(back + f[axis])));
        bound += 1.001 * static_cast<double>(bend) + 1e-6 * static_cast<double>(std::abs(back));
      }
      share.Add(error <= bound);
    }
  }
  // Strips of surfaces narrower than a pixel lie along edges: as long, together, as half of two sides of the picture.
  share.Into(check, "flow " + frames.Stamp(frame) + ", flow_backward " + frames.Stamp(frame + 1),
             0.5 * (forward.cols + forward.rows) / static_cast<double>(forward.total()));
}

void Occlusion(Frames& frames, std::size_t frame, const std::string& stream, std::size_t to, Check& check) {
  const PixelMotions motions(frames, frame, to);
  if (motions.known())
    CompareHidden(
        frames, frame, stream, frames, to, [&](std::size_t i) { return motions.Of(i); }, check);
}

void Landmarks(Frames& frames, std::size_t frame, std::vector<Check>& checks) {
  const Sequence& s = frames.sequence();
  const auto first = std::ranges::lower_bound(s.tracks, s.stamps[frame], {}, &Entry::stamp_ns),
             last = std::ranges::upper_bound(s.tracks, s.stamps[frame], {}, &Entry::stamp_ns);
  if (first == last || !s.has_pose[frame]) return;
  const cv::Mat depth = frames.Depth(frame);
  LargestRatio worst;
  std::size_t odd = 0;
  for (auto track = first; track != last; ++track) {
    const std::vector<double>& t = track->numbers;
    const auto id = static_cast<std::size_t>(std::max(t[0], 0.0));
    if (id >= s.landmarks.size() || s.landmarks[id].numbers[0] != t[0]) {
      worst.Add(kNone, 1);
      continue;
    }
    const std::vector<double>& place = s.landmarks[id].numbers;
    const Vector3d X = s.poses[frame].q_WC.conjugate() * (Vector3d(place[1], place[2], place[3]) - s.poses[frame].p_WC);
    worst.Add((s.camera.Project(X) - Vector2d(t[1], t[2])).norm(), 2e-9 + 4e-12 * s.camera.fx / X.z());
    if (depth.empty()) continue;
    const DepthRange near = RangeAround(depth, t[1], t[2], 1);
    const double error = 2 * frames.DepthError(X.z()) + 1e-5 * X.z();
    odd += t[3] != 0 ? !IsSeen(near, X.z(), error) : !(near.min < X.z());
  }
  checks[kLandmarks].Add(worst, "landmark_tracks.txt " + frames.Stamp(frame));
  const auto count = static_cast<double>(last - first);
  if (!depth.empty())
    checks[kTracks].Add(static_cast<double>(odd) / count, kEdges + 3 / count,
                        "landmark_tracks.txt " + frames.Stamp(frame));
}

}  // namespace

void MatchDepths(Frames& from, std::size_t frame, Frames& to, std::size_t to_frame, const Motions& motions,
                 const std::function<void(std::size_t, double)>& add) {
  const cv::Mat here = from.Depth(frame), there = to.Depth(to_frame);
  if (here.empty() || there.empty()) return;
  for (int y = 1; y < here.rows; y += 3) {
    for (int x = 1; x < here.cols; x += 3) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(here.cols) + static_cast<std::size_t>(x);
      const double Z = At(here, i);
      if (Z == 0) continue;
      double ratio = kNone;
      for (const Relative& move : motions(i)) {
        const Vector3d ray = move.R * from.rays()[i], X = Z * ray + move.t;
        if (X.z() <= 0) continue;
        const Vector2d pixel = to.sequence().camera.Project(X);
        const auto c = CornersAt(there, pixel.x(), pixel.y());
        if (!c) continue;
        if (const auto match = MatchAt(to, there, *c, Z, ray, X))
          ratio = std::min(ratio, match->difference / (match->bound + match->bend / 4));
      }
      if (ratio < kNone) add(i, ratio);
    }
  }
}

void CompareHidden(Frames& from, std::size_t frame, const std::string& stream, Frames& to, std::size_t to_frame,
                   const Motions& motions, Check& check) {
  const cv::Mat hidden = from.Picture(stream, frame), here = from.Depth(frame), there = to.Depth(to_frame);
  if (hidden.empty() || here.empty() || there.empty()) return;
  const vo::Camera& camera = to.sequence().camera;
  Share share;
  for (std::size_t i = 0; i < here.total(); ++i) {
    const double Z = At(here, i);
    const bool is_hidden = hidden.at<std::uint8_t>(static_cast<int>(i)) != 0;
    if (Z == 0) continue;
    // Whether the occlusion mask is right, if the pixel moves so; none: at the picture's border.
    const auto is_right = [&](const Relative& move) -> std::optional<bool> {
      const Vector3d ray = move.R * from.rays()[i], X = Z * ray + move.t;
      const Vector2d pixel = X.z() > 0 ? camera.Project(X) : Vector2d(-9, -9);
      if (!camera.IsUsable(pixel, -0.001)) return is_hidden;
      if (!camera.IsUsable(pixel, 0.001)) return std::nullopt;
      const double error = 2 * to.DepthError(X.z()) + 1e-5 * X.z();
      if (!is_hidden) return IsSeen(RangeAround(there, pixel.x(), pixel.y(), 1), X.z(), error);
      // It is visible where this very point is seen, on a smooth surface.
      const auto c = CornersAt(there, pixel.x(), pixel.y());
      const auto match = c ? MatchAt(to, there, *c, Z, ray, X) : std::nullopt;
      return !match || match->bend > 2 * match->bound || match->difference > match->bound;
    };
    std::optional<bool> right;
    for (const Relative& move : motions(i)) {
      const std::optional<bool> answer = is_right(move);
      if (answer) right = right.value_or(false) || *answer;
    }
    if (right) share.Add(*right);
  }
  share.Into(check, stream + " " + from.Stamp(frame));
}

std::vector<Check> SurfaceChecks(const Sequence& sequence) {
  std::vector<Check> checks = {{"depth.png against depth_exr", "m"},
                               {"distance against depth", "m"},
                               {"normals: unit, towards the camera", ""},
                               {"normals against depth: share beyond", ""},
                               {"surface_id: where there is depth, in legend", ""},
                               {"depth in the neighbouring frames: median", "of bound"},
                               {"flow against depth and poses", "px"},
                               {"flow_backward against depth and poses", "px"},
                               {"flow there and back: share beyond", ""},
                               {"occlusion against depth: share beyond", ""},
                               {"occlusion_backward against depth: share", ""},
                               {"landmark_tracks against landmarks, poses", "px"},
                               {"landmark_tracks visible: share beyond", ""}};
  if (!sequence.objects.empty()) {
    checks.emplace_back("flow on objects against their poses", "px");
    checks.emplace_back("moving: pixels that move as the others", "");
  }
  return checks;
}

void CompareSurfaces(Frames& frames, std::size_t frame, std::vector<Check>& checks) {
  DepthPictures(frames, frame, checks[kDepth]);
  Distance(frames, frame, checks[kDistance]);
  Normals(frames, frame, checks);
  SurfaceIds(frames, frame, checks[kIds]);
  DepthInNeighbours(frames, frame, checks[kNeighbours]);
  if (frame + 1 < frames.count()) {
    Flow(frames, frame, "flow", frame + 1, checks[kFlow], checks);
    FlowThereAndBack(frames, frame, checks[kThereAndBack]);
    Occlusion(frames, frame, "occlusion", frame + 1, checks[kOcclusion]);
  }
  if (frame > 0) {
    Flow(frames, frame, "flow_backward", frame - 1, checks[kBackward], checks);
    Occlusion(frames, frame, "occlusion_backward", frame - 1, checks[kOcclusionBackward]);
  }
  Landmarks(frames, frame, checks);
}

}  // namespace verification
