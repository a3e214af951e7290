#include "tools/bench/tracking/recorder.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "tools/base/files.h"
#include "tools/bench/tracking/picture.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kPictures = 24;

evaluation::FrameRecord RecordOf(const vo::Estimate& estimate) {
  const vo::FrameDiagnostics& d = estimate.diagnostics;
  const auto& [not_converged, behind_camera, not_positive_definite, non_finite_weight] = d.events;
  return {estimate.stamp_ns,
          d.searched,
          d.matched,
          d.landmarks,
          d.permanent,
          d.nis,
          d.nis_dof,
          d.effective_particles,
          d.ms_features,
          d.ms_matching,
          d.ms_filter,
          d.tracked(),
          {{not_converged, behind_camera, not_positive_definite, non_finite_weight}},
          d.repeated};
}

std::vector<FeatureMark> MarksOf(const std::vector<vo::FeatureView>& features) {
  std::vector<FeatureMark> marks;
  for (const vo::FeatureView& f : features) {  // the statuses are the same, in the same order
    marks.push_back({static_cast<FeatureMark::Status>(f.status), f.predicted, f.pixel, f.S});
  }
  return marks;
}

}  // namespace

// The middle frame of each stretch: the first frame has no tracked features.
bool IsKept(std::int64_t index, std::int64_t frames) {
  const std::int64_t every = std::max<std::int64_t>(1, (frames + kPictures - 1) / kPictures);
  return index % every == every / 2;
}

Recorder::Recorder(std::int64_t frames, std::optional<fs::path> folder)
    : folder_(std::move(folder)), expected_frames_(frames), answers_(folder_) {
  if (folder_) fs::create_directories(*folder_ / "frames");
}

Recorder::Recorder(std::optional<fs::path> folder) : folder_(std::move(folder)), answers_(folder_) {
  if (folder_) fs::create_directories(*folder_);
}

void Recorder::Add(const vo::Estimate& estimate) {
  Answer answer{};
  answer.stamp_ns = estimate.stamp_ns;
  Eigen::Vector3d::Map(answer.p_WC.data()) = estimate.pose.p_WC;
  Eigen::Vector4d::Map(answer.q_WC.data()) = estimate.pose.q_WC.coeffs();
  Eigen::Vector3d::Map(answer.v_WC.data()) = estimate.v_WC;
  Eigen::Vector3d::Map(answer.w_WC_C.data()) = estimate.w_WC_C;
  evaluation::Matrix12d::Map(answer.covariance.data()) = estimate.covariance;
  answer.frame = RecordOf(estimate);
  answers_.Add(answer);
}

void Recorder::Reissue(const std::vector<vo::StampedPose>& poses) {
  if (!poses.empty()) reissued_ = poses;
}

evaluation::EstimateRun Recorder::Run() const {
  evaluation::EstimateRun run;
  run.live.reserve(frames());
  run.beliefs.reserve(frames());
  run.frames.reserve(frames());
  answers_.ForEach([&](const Answer& answer) {
    const Eigen::Quaterniond q_WC(Eigen::Vector4d::Map(answer.q_WC.data()));
    run.live.push_back({answer.stamp_ns, Eigen::Vector3d::Map(answer.p_WC.data()), q_WC});
    run.beliefs.push_back(
        {{answer.stamp_ns, Eigen::Vector3d::Map(answer.v_WC.data()), Eigen::Vector3d::Map(answer.w_WC_C.data())},
         evaluation::Matrix12d::Map(answer.covariance.data())});
    run.frames.push_back(answer.frame);
  });
  run.trajectory = run.live;
  if (reissued_.empty()) return run;
  const auto before = [&](const evaluation::StampedPose& pose) { return pose.stamp_ns < reissued_[0].stamp_ns; };
  auto at = std::ranges::find_if_not(run.trajectory, before);
  for (const auto& [stamp_ns, pose] : reissued_) *at++ = {stamp_ns, pose.p_WC, pose.q_WC};
  return run;
}

void Recorder::Add(const vo::Frame& frame, const vo::Estimate& estimate, const std::vector<vo::FeatureView>& features) {
  const auto index = static_cast<std::int64_t>(frames());
  Add(estimate);
  if (!folder_ || !IsKept(index, expected_frames_)) return;
  WritePicture(*folder_ / PicturePath(frame.stamp_ns), frame.image);
  pictures_.width = frame.image.cols;
  pictures_.height = frame.image.rows;
  pictures_.pictures.push_back({frame.stamp_ns, MarksOf(features)});
}

RunData Recorder::Result(const RunEntry& entry, const std::vector<vo::MapPoint>& map) const {
  RunData data{entry, Run(), {}, pictures_, {}};
  for (const vo::MapPoint& point : map) {
    data.landmarks.push_back({point.id, point.X_W, point.inverse_depth, point.inverse_depth_sigma, point.permanent});
  }
  return data;
}

}  // namespace vobench
