#include "tools/bench/live/live_view.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/bench/report/html.h"
#include "tools/bench/report/report.h"
#include "tools/bench/result/result.h"
#include "tools/bench/tracking/picture.h"
#include "tools/judge/evaluation/text_file.h"

namespace vobench {

LiveView::LiveView(RunDescription description) : description_(std::move(description)) {
  fmt::print(stderr, "View: {}\n", server_.address());
}

bool LiveView::Asked(const vo::Frame& newest) {
  newest_ = {newest.stamp_ns, newest.image.clone()};
  return server_.Asked();
}

void LiveView::Show(std::span<const Tracker> trackers, const Truth& truth, const evaluation::JudgeOptions& how) {
  constexpr std::size_t kLeastFrames = 3;  // fewer cannot be aligned
  ResultData data;
  data.description = description_;
  std::vector<std::vector<FeatureMark>> marks;
  for (const Tracker& tracker : trackers) {
    if (tracker.frames() < kLeastFrames) return;
    RunData& run = data.runs.emplace_back();
    marks.push_back(tracker.marks());
    run.entry = tracker.entry();
    run.run = tracker.Estimates();
    data.description.seconds = std::max(data.description.seconds, run.entry.seconds);
    if (truth.poses.size() < kLeastFrames) continue;
    try {
      run.judged = evaluation::JudgeSeries(run.run, truth.poses, truth.velocities, how);
    } catch (const evaluation::InputError&) {  // the truth is of another time: not judged at the end, either
    }
  }
  const cv::Mat& image = newest_.image;
  const report::Page page =
      report::LivePage(data, report::NewestFrame(data, newest_.stamp_ns, {image.cols, image.rows}, Jpeg(image), marks));
  server_.Publish(report::Html(page), report::DataJson(page));
}

}  // namespace vobench
