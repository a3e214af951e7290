#include "tools/bench/tracking/match_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/text.h"
#include "tools/judge/evaluation/so3.h"
#include "tools/judge/evaluation/statistics.h"
#include "tools/judge/evaluation/text_file.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Status = vo::FeatureView::Status;

constexpr double kNearest_m = 0.1;  // no landmark is nearer
constexpr double kEdge = 0.05;      // relative range of depth within a patch that is an edge
constexpr int kPatchRadius = 4;     // of a landmark's patch [px]
constexpr int kRounds = 10;         // of fixed-point iterations that contract by the motion within a frame
constexpr std::int64_t kAway_ns = 1'000'000'000;

struct Column {
  const char* name;
  const char* what;
};
constexpr std::array<Column, MatchErrors::kQuantities> kColumns = {
    {{"match", "match to true pixel [px]"},
     {"epipolar", "match to epipolar line [px]"},
     {"prediction", "prediction to match [px]"},
     {"true_prediction", "prediction to true pixel [px]"},
     {"innovation", "innovation' S^-1 innovation / 2"}}};

std::map<std::int64_t, fs::path> DepthsOf(const fs::path& sequence) {
  std::map<std::int64_t, fs::path> depths;
  const fs::path list = sequence / "depth.txt";
  if (!fs::exists(list)) return depths;
  evaluation::Problems problems;
  for (const evaluation::Line& line : evaluation::Lines(list)) {
    const auto stamp_ns = base::ParseSeconds(line.tokens[0].text);
    if (stamp_ns && line.tokens.size() == 2) {
      depths[*stamp_ns] = sequence / line.tokens[1].text;
    } else {
      problems.Add(list, line.number, 1, "is not `timestamp filename`");
    }
  }
  problems.ThrowIfAny();
  return depths;
}

// Z in metres; 0: unknown.
cv::Mat ReadDepth(const fs::path& file, const vo::Camera& camera) {
  const cv::Mat coded = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
  if (coded.type() != CV_16UC1 || coded.cols != camera.width || coded.rows != camera.height)
    throw std::runtime_error(file.string() + ": is not a depth picture of 16 bits and of the camera's size");
  cv::Mat depth;
  coded.convertTo(depth, CV_32F, 1.0 / 5000);
  return depth;
}

// Bilinear in inverse depth, which is linear on a plane; 0 where one of the four pixels has none.
double DepthAt(const cv::Mat& depth, const Vector2d& pixel) {
  const double x = std::floor(pixel.x()), y = std::floor(pixel.y()), a = pixel.x() - x, b = pixel.y() - y;
  if (!(x >= 0 && y >= 0 && x < depth.cols - 1 && y < depth.rows - 1)) return 0;
  double inverse = 0;
  for (const int j : {0, 1}) {
    for (const int i : {0, 1}) {
      const float Z = depth.at<float>(static_cast<int>(y) + j, static_cast<int>(x) + i);
      if (!(Z > 0)) return 0;
      inverse += (i ? a : 1 - a) * (j ? b : 1 - b) / static_cast<double>(Z);
    }
  }
  return 1 / inverse;
}

bool IsSmooth(const cv::Mat& depth, const Vector2d& pixel) {
  const int x = static_cast<int>(std::lround(pixel.x())), y = static_cast<int>(std::lround(pixel.y()));
  const cv::Rect patch(x - kPatchRadius, y - kPatchRadius, 2 * kPatchRadius + 1, 2 * kPatchRadius + 1);
  if ((patch & cv::Rect(0, 0, depth.cols, depth.rows)) != patch) return false;
  double nearest = 0, farthest = 0;
  cv::minMaxLoc(depth(patch), &nearest, &farthest);
  return nearest > 0 && farthest - nearest <= kEdge * nearest;
}

Vector3d IntoCamera(const vo::Pose& T_WC, const Vector3d& X_W) { return T_WC.q_WC.conjugate() * (X_W - T_WC.p_WC); }

// Intersection of the ray of a row, at its own time, with the surface given by the depth at the stamp.
std::optional<Vector3d> OnSurface(const cv::Mat& depth, const vo::Camera& camera, const vo::Pose& row,
                                  const vo::Pose& stamp, const Vector3d& ray, const Vector2d& pixel) {
  double Z = DepthAt(depth, pixel);
  Vector3d X_W = Vector3d::Zero();
  for (int round = 0; round < kRounds; ++round) {
    if (!(Z > 0)) return std::nullopt;
    X_W = row.p_WC + row.q_WC * (Z * ray);
    const Vector3d X_C = IntoCamera(stamp, X_W);
    if (!(X_C.z() > 0)) return std::nullopt;
    const double seen = DepthAt(depth, camera.Project(X_C));
    if (!(seen > 0)) return std::nullopt;
    Z += seen - X_C.z();
  }
  return X_W;
}

std::vector<double> Sorted(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values;
}

constexpr std::int64_t kLongestGap_ns = 250'000'000;

// Value at s in [0, 1] of the cubic from 0 to `end` whose derivatives with respect to s are d0 and d1.
Eigen::Vector3d Hermite(double s, const Eigen::Vector3d& end, const Eigen::Vector3d& d0, const Eigen::Vector3d& d1) {
  const double r = 1 - s;
  return s * s * (3 - 2 * s) * end + s * r * r * d0 - s * s * r * d1;
}

}  // namespace

std::optional<vo::Pose> TrueMotion::At(std::int64_t stamp_ns) const {
  const evaluation::Trajectory& poses = truth_.poses;
  if (poses.size() < 2) return std::nullopt;
  const auto after = std::ranges::upper_bound(poses, stamp_ns, {}, &evaluation::StampedPose::stamp_ns);
  const auto next = std::clamp(after, poses.begin() + 1, poses.end() - 1);
  const evaluation::StampedPose &a = *(next - 1), &b = *next;
  const std::int64_t gap_ns = b.stamp_ns - a.stamp_ns;
  if (gap_ns > kLongestGap_ns || stamp_ns - b.stamp_ns > kLongestGap_ns / 2 ||
      a.stamp_ns - stamp_ns > kLongestGap_ns / 2) {
    return std::nullopt;
  }
  const double s = static_cast<double>(stamp_ns - a.stamp_ns) / static_cast<double>(gap_ns);
  const Eigen::Vector3d move = b.p_WC - a.p_WC, turn = evaluation::Log(a.q_WC.conjugate() * b.q_WC);
  const auto velocity = [&](std::int64_t at_ns) {
    return truth_.velocities ? evaluation::VelocityAt(*truth_.velocities, at_ns) : std::nullopt;
  };
  const auto v0 = velocity(a.stamp_ns), v1 = velocity(b.stamp_ns);
  if (!v0 || !v1) return vo::Pose{a.p_WC + s * move, a.q_WC * evaluation::Exp(s * turn)};
  if (s < 0 || s > 1) {
    const evaluation::StampedPose& end = s < 0 ? a : b;
    const evaluation::StampedVelocity& rate = s < 0 ? *v0 : *v1;
    const double since_s = 1e-9 * static_cast<double>(stamp_ns - end.stamp_ns);
    return vo::Pose{end.p_WC + since_s * rate.v_WC, end.q_WC * evaluation::Exp(since_s * rate.w_WC_C)};
  }
  // d(phi)/dt of Exp(phi) = q_a^-1 q is J_r(phi)^-1 w; w up to the second order in the turn.
  const double dt = 1e-9 * static_cast<double>(gap_ns);
  const Eigen::Vector3d &w0 = v0->w_WC_C, &w1 = v1->w_WC_C;
  const Eigen::Vector3d end_rate = w1 + 0.5 * turn.cross(w1) + turn.cross(turn.cross(w1)) / 12;
  return vo::Pose{a.p_WC + Hermite(s, move, dt * v0->v_WC, dt * v1->v_WC),
                  a.q_WC * evaluation::Exp(Hermite(s, turn, dt * w0, dt * end_rate))};
}

MatchErrors::MatchErrors(const fs::path& sequence, const vo::Camera& camera, Truth truth)
    : camera_(camera), motion_(std::move(truth)), depths_(DepthsOf(sequence)) {}

std::optional<vo::Pose> MatchErrors::RowPose(std::int64_t stamp_ns, double row) const {
  const double delay_s = camera_.height > 1 ? camera_.readout_s.value_or(0) * (row / (camera_.height - 1) - 0.5) : 0.0;
  return motion_.At(stamp_ns + std::llround(1e9 * delay_s));
}

std::optional<Vector2d> MatchErrors::TruePixel(const Vector3d& X_W, std::int64_t stamp_ns) const {
  Vector2d pixel(0, 0.5 * (camera_.height - 1));
  for (int round = 0; round < (camera_.readout_s.value_or(0) != 0 ? kRounds : 1); ++round) {
    const std::optional<vo::Pose> pose = RowPose(stamp_ns, pixel.y());
    if (!pose) return std::nullopt;
    const Vector3d X_C = IntoCamera(*pose, X_W);
    if (!(X_C.z() > 0) || !camera_.IsInjective(X_C.head<2>() / X_C.z())) return std::nullopt;
    pixel = camera_.Project(X_C);
    if (!camera_.IsUsable(pixel)) return std::nullopt;
  }
  return pixel;
}

std::optional<double> MatchErrors::EpipolarDistance(const Landmark& landmark, const Vector2d& pixel,
                                                    std::int64_t stamp_ns) const {
  const std::optional<vo::Pose> pose = RowPose(stamp_ns, pixel.y());
  if (!landmark.view || !pose) return std::nullopt;
  // The image of the ray: a + rho b, from rho = 0 to where it is nearest.
  const Vector3d a = pose->q_WC.conjugate() * (landmark.view->q_WC * landmark.ray);
  const Vector3d b = IntoCamera(*pose, landmark.view->p_WC);
  const Vector3d end = a + b / kNearest_m;
  constexpr double kGrazing = 0.05;  // of the length of the ray: nearer to the image plane it is excluded
  if (!(a.z() > kGrazing)) return std::nullopt;
  const double share = end.z() > kGrazing ? 1.0 : (a.z() - kGrazing) / (a.z() - end.z());
  const Vector3d last = a + share * (end - a);
  const Vector2d from = a.head<2>() / a.z(), along = last.head<2>() / last.z() - from;
  const double length_sq = along.squaredNorm();
  const double at =
      length_sq > 0 ? std::clamp((camera_.Undistort(pixel) - from).dot(along) / length_sq, 0.0, 1.0) : 0.0;
  return (camera_.Project((from + at * along).homogeneous()) - pixel).norm();
}

void MatchErrors::Begin(std::int64_t stamp_ns, const std::vector<vo::FeatureView>& features) {
  const auto file = depths_.find(stamp_ns);
  const std::optional<vo::Pose> at_stamp = motion_.At(stamp_ns);
  cv::Mat depth;
  for (const vo::FeatureView& feature : features) {
    if (feature.status != Status::fresh) continue;
    Landmark landmark;
    landmark.first_ns = landmark.last_ns = stamp_ns;
    landmark.view = RowPose(stamp_ns, feature.pixel.y());
    landmark.ray = camera_.Undistort(feature.pixel).homogeneous();
    if (file != depths_.end() && landmark.view && at_stamp) {
      if (depth.empty()) depth = ReadDepth(file->second, camera_);
      landmark.X_W = OnSurface(depth, camera_, *landmark.view, *at_stamp, landmark.ray, feature.pixel);
      landmark.smooth = landmark.X_W && IsSmooth(depth, camera_.Project(IntoCamera(*at_stamp, *landmark.X_W)));
    }
    landmarks_[feature.id] = landmark;
  }
}

void MatchErrors::Measure(const vo::FeatureView& feature, Landmark& landmark, Frame& frame) const {
  const bool is_known = landmark.X_W && landmark.smooth;
  const std::optional<Vector2d> pixel = is_known ? TruePixel(*landmark.X_W, frame.stamp_ns) : std::nullopt;
  if (pixel) frame.values[kTruePredict].push_back((*pixel - feature.predicted).norm());
  if (feature.status != Status::matched) return;
  if (pixel) frame.values[kMatch].push_back((*pixel - feature.pixel).norm());
  if (const auto distance = EpipolarDistance(landmark, feature.pixel, frame.stamp_ns))
    frame.values[kEpipolar].push_back(*distance);
  const Vector2d nu = feature.pixel - feature.predicted;
  frame.values[kPrediction].push_back(nu.norm());
  frame.values[kInnovation].push_back(nu.dot(Eigen::Matrix2d(feature.S.inverse()) * nu) / 2);
  frame.reobserved += frame.stamp_ns - landmark.last_ns >= kAway_ns;
  landmark.last_ns = frame.stamp_ns;
  ++landmark.matches;
}

void MatchErrors::Add(std::int64_t stamp_ns, const std::vector<vo::FeatureView>& features) {
  Frame& frame = frames_.emplace_back();
  frame.stamp_ns = stamp_ns;
  for (const vo::FeatureView& feature : features) {
    ++frame.count[static_cast<std::size_t>(feature.status)];
    if (feature.status == Status::fresh) continue;
    const auto known = landmarks_.find(feature.id);
    if (known != landmarks_.end()) Measure(feature, known->second, frame);
  }
  Begin(stamp_ns, features);
}

void MatchErrors::Write(const fs::path& folder) const {
  std::string csv = "timestamp,searched,matched,missed,rejected,new,reobserved";
  for (const Column& column : kColumns) csv += fmt::format(",{0}_median,{0}_95", column.name);
  csv += '\n';
  for (const Frame& frame : frames_) {
    const auto [matched, missed, rejected, fresh] = frame.count;
    csv += fmt::format("{},{},{},{},{},{},{}", base::FormatSeconds(frame.stamp_ns), matched + missed + rejected,
                       matched, missed, rejected, fresh, frame.reobserved);
    for (const std::vector<double>& unsorted : frame.values) {
      const std::vector<double> values = Sorted(unsorted);
      csv += values.empty()
                 ? ",,"
                 : fmt::format(",{:.4g},{:.4g}", evaluation::Quantile(values, 0.5), evaluation::Quantile(values, 0.95));
    }
    csv += '\n';
  }
  base::WriteFile(folder / "matches.csv", csv);
  const std::map<int, Landmark> ordered(landmarks_.begin(), landmarks_.end());
  std::string lives = "id,first,last,matches\n";
  for (const auto& [id, landmark] : ordered)
    lives += fmt::format("{},{},{},{}\n", id, base::FormatSeconds(landmark.first_ns),
                         base::FormatSeconds(landmark.last_ns), landmark.matches);
  base::WriteFile(folder / "lives.csv", lives);
}

std::string MatchErrors::Table() const {
  std::vector<std::vector<std::string>> rows = {{"Against the truth", "median", "90 %", "99 %", "number"}};
  const auto add = [&](const std::string& name, std::vector<double> values, const auto& text) {
    values = Sorted(std::move(values));
    std::vector<std::string> row = {name};
    for (const double share : {0.5, 0.9, 0.99}) row.push_back(text(evaluation::Quantile(values, share)));
    row.push_back(std::to_string(values.size()));
    rows.push_back(row);
  };
  const auto fixed = [](double value) { return Fixed(value, 2); };
  for (std::size_t q = 0; q < kColumns.size(); ++q) {
    std::vector<double> all;
    for (const Frame& frame : frames_) all.insert(all.end(), frame.values[q].begin(), frame.values[q].end());
    add(kColumns[q].what, std::move(all), fixed);
  }
  std::vector<double> lives;
  for (const auto& [id, landmark] : landmarks_)
    if (landmark.matches >= 1) lives.push_back(landmark.matches);
  const std::size_t found = lives.size();
  const auto whole = [](double value) { return Fixed(value, 0); };
  add("life of a landmark, once found [matches]", std::move(lives), whole);
  std::vector<double> matched, searched, reobserved;
  for (const Frame& frame : frames_) {
    const auto [m, missed, rejected, fresh] = frame.count;
    matched.push_back(m);
    searched.push_back(m + missed + rejected);
    reobserved.push_back(frame.reobserved);
  }
  add("searched in a frame", std::move(searched), whole);
  add("matched in a frame", std::move(matched), whole);
  add("of these not seen for a second", std::move(reobserved), whole);
  return AlignedTable(rows) + fmt::format("{} landmarks were begun, {} found again.\n", landmarks_.size(), found);
}

}  // namespace vobench
