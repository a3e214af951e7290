#include "tools/bench/report/report.h"

#include <algorithm>

#include "tools/base/files.h"
#include "tools/bench/report/figures.h"
#include "tools/bench/report/html.h"
#include "tools/bench/report/summary.h"
#include "tools/bench/text.h"

namespace vobench::report {
namespace {

namespace ev = evaluation;

constexpr std::size_t kPictureBytes = 800'000;  // a third more in base64

bool OwnWorld(const std::vector<RunMetrics>& judged) {
  return std::any_of(judged.begin(), judged.end(),
                     [](const RunMetrics& run) { return run.metrics.options.gauge == ev::Gauge::first_pose; });
}

std::string Record(const RunDescription& d) {
  std::string html = "<p>Command</p><pre>" + Escape(d.command) + "</pre><p>Versions</p><pre>";
  for (const auto& [name, version] : d.versions) html += Escape(name + " " + version) + "\n";
  html += "</pre>";
  if (!d.settings.empty()) {
    html += "<details><summary>All settings, resolved</summary><pre>" + Escape(d.settings) + "</pre></details>";
  }
  return html;
}

std::string TypicalRuns(const ResultData& data) {
  const std::vector<std::string> systems = data.Systems();
  if (data.runs.size() == systems.size()) return "";
  std::size_t most = 0;
  for (const std::string& system : systems) most = std::max(most, data.RunsOf(system).size());
  return " Bold: each system's typical run (of median ATE); faint: " +
         (most > kFaintRuns + 1 ? std::to_string(kFaintRuns) + " of its other seeds, from the best to the worst."
                                : std::string("its other seeds."));
}

std::string ShownSeeds(const ResultData& data) {
  std::string text;
  for (const std::string& system : data.Systems()) {
    text += (text.empty() ? "" : ", ") + Escape(DisplayName(system)) + " with seed " +
            std::to_string(data.Typical(system).entry.seed);
  }
  return text;
}

Page PageOf(const std::filesystem::path& out, const ResultData& data) {
  const std::vector<RunMetrics> judged = data.Metrics();
  Page page;
  page.title = data.description.title.empty() ? "vobench report" : data.description.title;
  page.summary = RunSummary(data, judged);
  for (const std::string& system : data.Systems()) page.systems.push_back(DisplayName(system));
  const std::string typical = TypicalRuns(data);
  const std::string own_paths = " Every seed flies a path of its own; shown is that of seed " +
                                std::to_string(data.Typical(data.Systems().front()).entry.seed) + ", where " +
                                Escape(DisplayName(data.Systems().front())) + " has its median ATE.";
  const std::vector<Figure> errors = AlignedErrorFigures(data);
  page.sections = {
      {"Path",
       (judged.empty() ? "In the odometry's own world and scale." : "Estimates aligned to the truth by Sim(3).") +
           (data.SharedTruth() ? typical : own_paths),
       PathFigures(data)},
      {"Errors",
       "Distance from the truth, after the same alignment." +
           std::string(errors.size() == 1 ? " The orientation's is not determined: the positions lie on one line."
                                          : "") +
           typical,
       errors},
      {"Runs", "", {}, RunTable(judged)},
      {"Consistency with the truth",
       "NEES compares errors, not aligned, with the filter's covariance: 1 is ideal, above the band it is "
       "over-confident, below it under-confident (conservative). Frames of one run depend on each other, so the band "
       "holds for each frame by "
       "itself. Scale: monocular odometry cannot see it; the second diagram does not count it." +
           std::string(OwnWorld(judged) ? " These runs began in a world of their own: the truth was moved there by its "
                                          "first pose, whose own error counts as theirs."
                                        : ""),
       NeesFigures(data)},
      {"Consistency with its own model", "", {}, VerdictTable(data.verdict)},
      {"Ranks",
       "Where the truth falls among 99 draws from the filter's belief at the last ranked frame, over runs (ranks.csv "
       "has "
       "all frames). A consistent filter's bars are all alike: of a single bar, 95 of 100 are in the band.",
       RankFigures(data)},
      {"Innovations",
       "NIS compares what the filter expected to see with what it saw; it needs no truth. Gating drops the largest "
       "innovations, so a consistent filter sits slightly below 1.",
       NisFigures(data)},
      {"Errors and what they should be",
       "Truth minus estimate, not aligned; orientation about the camera's axes. The bands are what the filters claim, "
       "±3σ. " +
           ShownSeeds(data) + ".",
       PoseErrorFigures(data)},
      {"Velocity and what it should be", "The same of linear and angular velocity.", VelocityErrorFigures(data), "",
       "Velocity"},
      {"Features and time", "", FrameFigures(data), EventTable(judged)},
      {"How this was made", "", {}, Record(data.description)},
  };
  page.frames = MakeFrameViewer(out, data, kPictureBytes);
  return page;
}

}  // namespace

void WriteReport(const std::filesystem::path& out, const ResultData& data) {
  base::WriteFile(out / "report.html", Html(PageOf(out, data)));
}

void WriteReport(const std::filesystem::path& out) { WriteReport(out, ReadResult(out)); }

}  // namespace vobench::report
