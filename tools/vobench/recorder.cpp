#include "tools/vobench/recorder.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/evaluation/text_file.h"
#include "tools/vobench/picture.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kPictures = 10;

evaluation::StampedPose PoseOf(const vo::Estimate& estimate) {
  return {estimate.stamp_ns, estimate.pose.p_WC, estimate.pose.q_WC};
}

evaluation::StampedBelief BeliefOf(const vo::Estimate& estimate) {
  return {{estimate.stamp_ns, estimate.v_WC, estimate.w_WC_C}, estimate.covariance};
}

evaluation::FrameRecord RecordOf(const vo::Estimate& estimate) {
  const vo::FrameDiagnostics& d = estimate.diagnostics;
  evaluation::FrameRecord record;
  record.stamp_ns = estimate.stamp_ns;
  record.searched = d.searched;
  record.matched = d.matched;
  record.landmarks = d.landmarks;
  record.permanent = d.permanent;
  record.nis = d.nis;
  record.nis_dof = d.nis_dof;
  record.effective_particles = d.effective_particles;
  record.ms_features = d.ms_features;
  record.ms_matching = d.ms_matching;
  record.ms_filter = d.ms_filter;
  record.tracked = d.tracked();
  return record;
}

std::string LandmarkTable(const std::vector<vo::MapPoint>& map) {
  std::string table = "id,x,y,z,inverse_depth,inverse_depth_sigma,permanent\n";
  for (const vo::MapPoint& point : map) {
    table += fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{}\n", point.id, point.X_W.x(), point.X_W.y(),
                         point.X_W.z(), point.inverse_depth, point.inverse_depth_sigma, point.permanent ? 1 : 0);
  }
  return table;
}

}  // namespace

Recorder::Recorder(std::int64_t frames, std::optional<fs::path> folder)
    : folder_(std::move(folder)), picture_every_(std::max<std::int64_t>(1, (frames + kPictures - 1) / kPictures)) {
  if (folder_) fs::create_directories(*folder_ / "frames");
}

Recorder::Recorder(std::optional<fs::path> folder) : folder_(std::move(folder)) {
  if (folder_) fs::create_directories(*folder_);
}

void Recorder::Add(const vo::Estimate& estimate) {
  run_.trajectory.push_back(PoseOf(estimate));
  run_.beliefs.push_back(BeliefOf(estimate));
  run_.frames.push_back(RecordOf(estimate));
}

void Recorder::Add(const vo::Frame& frame, const vo::Estimate& estimate, const std::vector<vo::FeatureView>& features) {
  Add(estimate);
  // The middle frame of each tenth: the very first has nothing tracked to show.
  if (folder_ && added_ % picture_every_ == picture_every_ / 2) {
    WritePicture(*folder_ / "frames" / (evaluation::FormatSeconds(frame.stamp_ns) + ".jpg"), frame.image, features);
  }
  ++added_;
}

void Recorder::Write(const std::vector<vo::MapPoint>& map) const {
  evaluation::WriteEstimateRun(*folder_, run_);
  evaluation::WriteWhole(*folder_ / "landmarks.csv", LandmarkTable(map));
}

}  // namespace vobench
