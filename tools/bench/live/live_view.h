// Live report of a run in progress, in a browser on this machine (--view).
// Source: docs/report.md, "While it runs".
#pragma once

#include <span>

#include "tools/bench/live/live_server.h"
#include "tools/bench/points/truth.h"
#include "tools/bench/result/run_json.h"
#include "tools/bench/tracking/tracker.h"
#include "tools/judge/evaluation/summary.h"

namespace vobench {

class LiveView {
 public:
  // Says on stderr where it is. `description` as in run.json, as far as it is known. Throws std::runtime_error.
  explicit LiveView(RunDescription description);

  // After a frame, which is kept: whether there was a request since the last Show.
  bool Asked(const vo::Frame& newest);
  // Judges what there is, all of it, and shows it. No result depends on it. Throws std::runtime_error where what was
  // answered cannot be read.
  void Show(std::span<const Tracker> trackers, const Truth& truth, const evaluation::JudgeOptions& how);

 private:
  RunDescription description_;
  vo::Frame newest_;
  LiveServer server_;
};

}  // namespace vobench
