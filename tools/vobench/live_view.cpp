#include "tools/vobench/live_view.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/evaluation/text_file.h"
#include "tools/report/html.h"
#include "tools/report/page.h"
#include "tools/report/result_data.h"

namespace vobench {
namespace {

constexpr std::size_t kLeastFrames = 3;  // fewer cannot be aligned

}  // namespace

LiveView::LiveView(report::RunDescription description) : description_(std::move(description)) {
  fmt::print(stderr, "View: {}\n", server_.address());
}

void LiveView::Update(std::span<const Tracker> trackers, const Truth& truth, const evaluation::JudgeOptions& how) {
  if (server_.Asked()) Show(trackers, truth, how);
}

void LiveView::Show(std::span<const Tracker> trackers, const Truth& truth, const evaluation::JudgeOptions& how) {
  report::ResultData data;
  data.description = description_;
  for (const Tracker& tracker : trackers) {
    if (tracker.estimates().trajectory.size() < kLeastFrames) return;
    report::RunData& run = data.runs.emplace_back();
    run.entry = tracker.entry();
    run.run = tracker.estimates();
    data.description.seconds = std::max(data.description.seconds, run.entry.seconds);
    if (truth.poses.size() < kLeastFrames) continue;
    try {
      run.judged = report::JudgeSeries(run.run, truth.poses, truth.velocities, how);
    } catch (const evaluation::InputError&) {  // the truth is of another time: not judged at the end, either
    }
  }
  const report::Page page = report::LivePage(data);
  server_.Publish(report::Html(page), report::DataJson(page));
}

}  // namespace vobench
