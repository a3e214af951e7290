#include "tools/report/page.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "tools/evaluation/text_file.h"
#include "tools/report/figures.h"
#include "tools/report/style.h"
#include "tools/report/text.h"
#include "tools/report/text_summary.h"

namespace report {
namespace {

namespace ev = evaluation;

constexpr double kDegrees = 180 / M_PI;
constexpr std::size_t kPictureBytes = 1'400'000;

std::string Count(std::size_t n, const std::string& noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

std::string Section(const std::string& title, const std::string& words, const std::string& body) {
  if (body.empty()) return "";
  return "<section><h2>" + title + "</h2>\n" + (words.empty() ? "" : "<p>" + words + "</p>\n") + body + "</section>\n";
}

// Panels three abreast where there is room; "grid two": two.
std::string Grid(const std::string& figures, const char* style = "grid") {
  return figures.empty() ? "" : "<div class=\"" + std::string(style) + "\">" + figures + "</div>\n";
}

// What the mean NEES per degree of freedom says in words, with and without the error of scale.
std::string Honesty(const SystemSummary& s) {
  const double nees = s.nees_pose_per_dof;
  if (!std::isfinite(nees)) return "its uncertainty was not judged";
  std::string text;
  if (nees > 1.5) {
    text = "it is over-confident: errors are about " + Readable(std::sqrt(nees)) + " times what it claims";
  } else if (nees < 1 / 1.5) {
    text = "it is cautious: errors are about " + Readable(std::sqrt(nees)) + " times what it claims";
  } else {
    text = "it is about as uncertain as it is wrong";
  }
  text += " (NEES " + Readable(nees) + " per degree of freedom, 1 is ideal";
  if (std::isfinite(s.nees_pose_scale_free_per_dof)) {
    text += "; " + Readable(s.nees_pose_scale_free_per_dof) + " when the scale of the map is not counted";
  }
  return text + ")";
}

std::string SystemSentence(const SystemSummary& s, const std::vector<SystemSummary>& baselines) {
  std::string text = "<b>" + Escape(DisplayName(s.system)) + "</b>, " + Count(s.runs, "run") + ": ";
  text += s.runs > 1 ? "median ATE " : "ATE ";
  text += "<b>" + Fixed(100 * s.ate_m, 2) + " cm</b> (" + Percent(s.ate_share_of_path, 2) + " of the path";
  if (s.runs > 1) text += "; worst run " + Fixed(100 * s.ate_worst_m, 2) + " cm";
  text += "), drift " + Fixed(100 * s.rpe_m, 2) + " cm/s and " + Fixed(kDegrees * s.rpe_rad, 2) + " °/s, " +
          Percent(s.tracked_coverage) + " of the frames tracked; " + Honesty(s) + ". ";
  const double best = std::min(baselines[0].ate_m, baselines[1].ate_m);
  text += s.ate_m < best ? "The better of the two blind baselines is " + Readable(best / s.ate_m) + " times as far off."
                         : "<b>It does no better than a baseline that never looks at the images.</b>";
  return text;
}

std::string DuelSentence(const std::vector<JudgedRun>& runs, const SystemSummary& a, const SystemSummary& b) {
  const Duel duel = Compare(runs, a.system, b.system);
  if (duel.seeds == 0) return "";
  const std::string first = Escape(DisplayName(a.system)), second = Escape(DisplayName(b.system));
  std::string text = first + " has the smaller ATE in <b>" + std::to_string(duel.wins) + " of " +
                     Count(duel.seeds, "seed") + "</b> against " + second + "; medians " + Fixed(100 * a.ate_m, 2) +
                     " and " + Fixed(100 * b.ate_m, 2) + " cm.";
  if (a.ate_m >= b.ate_m || 2 * duel.wins <= duel.seeds)
    text += " <b>" + first + " does not beat " + second + " here.</b>";
  return text;
}

std::string Tile(const std::string& value, const std::string& what, const std::string& note) {
  return "<div class=\"tile\"><div class=\"value\">" + value + "</div><div>" + what + "</div><div class=\"note\">" +
         note + "</div></div>";
}

std::string Tiles(const std::vector<SystemSummary>& systems, const std::vector<SystemSummary>& baselines) {
  std::string html;
  for (std::size_t i = 0; i < systems.size(); ++i) {
    const SystemSummary& s = systems[i];
    html += "<h3><span class=\"key " + StyleOf(i) + "\"></span>" + Escape(DisplayName(s.system)) +
            "</h3><div class=\"tiles\">" +
            Tile(Fixed(100 * s.ate_m, 2) + " cm", "ATE, " + Percent(s.ate_share_of_path, 2) + " of the path",
                 "position RMSE after Sim(3) alignment; constant pose " + Fixed(100 * baselines[0].ate_m, 1) +
                     " cm, constant velocity " + Fixed(100 * baselines[1].ate_m, 1) + " cm") +
            Tile(Fixed(100 * s.rpe_m, 2) + " cm/s, " + Fixed(kDegrees * s.rpe_rad, 2) + " °/s", "RPE",
                 "over one second; constant pose " + Fixed(100 * baselines[0].rpe_m, 1) + " cm/s, " +
                     Fixed(kDegrees * baselines[0].rpe_rad, 1) + " °/s") +
            Tile(Percent(s.tracked_coverage), "tracked",
                 "frames with at least 10 matched features; frames with a pose: " + Percent(s.pose_coverage)) +
            "</div>\n";
  }
  return html;
}

std::string Summary(const ResultData& data, const std::vector<JudgedRun>& judged) {
  const RunDescription& d = data.description;
  std::string systems;
  for (const std::string& system : data.Systems())
    systems += (systems.empty() ? "" : ", ") + Escape(DisplayName(system));
  const ev::Trajectory& first = data.runs.front().run.trajectory;
  const std::size_t frames = data.runs.front().run.frames.empty() ? first.size() : data.runs.front().run.frames.size();
  std::string html = "<p>" + systems + " on <b>" + Escape(d.input) + "</b>: " + Count(data.runs.size(), "run") +
                     " of " + Count(frames, "frame");
  if (!judged.empty()) {
    html += ", " + Fixed(judged[0].metrics.duration_s, 1) + " s and " + Fixed(judged[0].metrics.path_length_m, 2) +
            " m of path (the truth's, at the frames)";
  }
  html += ". Started " + Escape(d.started_utc) + ", took " + Fixed(d.seconds, 1) + " s.</p>\n";
  for (const std::string& warning : data.warnings) html += "<p class=\"warning\">" + Escape(warning) + "</p>\n";
  for (const std::string& note : d.notes) html += "<p class=\"warning\">" + Escape(note) + "</p>\n";
  if (judged.empty()) return html + "<p>There is no truth to judge by: paths, features and innovations only.</p>\n";

  const auto summaries = SummariseSystems(judged);
  const auto baselines = SummariseBaselines(judged);
  html += "<ul>";
  for (const SystemSummary& s : summaries) html += "<li>" + SystemSentence(s, baselines) + "</li>";
  for (std::size_t i = 1; i < summaries.size(); ++i) {
    const std::string duel = DuelSentence(judged, summaries[0], summaries[i]);
    if (!duel.empty()) html += "<li>" + duel + "</li>";
  }
  return html + "</ul>\n" + Tiles(summaries, baselines);
}

std::string Row(const std::vector<std::string>& cells, const char* cell) {
  std::string html = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string kind = i == 0 ? "th scope=\"row\"" : cell;
    html += "<" + (std::string(cell) == "th" ? std::string("th scope=\"col\"") : kind) + ">" + cells[i] +
            (std::string(cell) == "th" || i == 0 ? "</th>" : "</td>");
  }
  return html + "</tr>\n";
}

std::vector<std::string> ErrorCells(const ev::TrajectoryErrors& errors, double path_length_m) {
  const bool rpe = !errors.rpe.pairs.empty();
  return {Fixed(100 * errors.sim3.position.rmse, 2),
          Fixed(100 * errors.sim3.position.rmse / path_length_m, 2),
          Fixed(100 * errors.se3.position.rmse, 2),
          errors.sim3.similarity.scale_determined ? Fixed(errors.sim3.similarity.scale, 3) : "–",
          rpe ? Fixed(100 * errors.rpe.position_statistics.rmse, 2) : "–",
          rpe ? Fixed(kDegrees * errors.rpe.orientation_statistics.rmse, 2) : "–"};
}

std::string Table(const std::vector<JudgedRun>& judged) {
  if (judged.empty()) return "";
  std::string html =
      "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"Table of runs\"><table><caption>Every run, and "
      "the baselines. Aligned by Sim(3) unless the column says "
      "otherwise."
      "</caption><thead>";
  html += Row({"system", "seed", "ATE [cm]", "of path [%]", "ATE SE(3) [cm]", "scale", "RPE [cm/s]", "RPE [°/s]",
               "poses [%]", "tracked [%]", "NEES / dof", "… scale-free", "… of velocity", "NIS / dof", "ms / frame"},
              "th") +
          "</thead><tbody>";
  const double nan = std::nan("");
  for (const JudgedRun& run : judged) {
    const ev::Metrics& m = run.metrics;
    std::vector<std::string> cells = {Escape(DisplayName(run.run.system)), std::to_string(run.run.seed)};
    for (std::string& cell : ErrorCells(m.errors, m.path_length_m)) cells.push_back(std::move(cell));
    const auto nees = [&](const std::optional<ev::NeesSummary>& n) {
      return Readable(n && n->frames > 0 ? n->mean / n->dof : nan);
    };
    const bool consistency = m.consistency.has_value();
    cells.push_back(Fixed(m.coverage ? 100 * m.coverage->pose_coverage() : nan, 1));
    cells.push_back(Fixed(m.coverage ? 100 * m.coverage->tracked_coverage().value_or(nan) : nan, 1));
    cells.push_back(consistency ? nees(m.consistency->pose) : "–");
    cells.push_back(consistency ? nees(m.consistency->pose_scale_free) : "–");
    cells.push_back(consistency ? nees(m.consistency->velocity) : "–");
    cells.push_back(Fixed(m.nis && m.nis->frames > 0 ? m.nis->mean_per_dof : nan, 2));
    cells.push_back(m.timing ? Fixed(m.timing->ms_features + m.timing->ms_matching + m.timing->ms_filter, 1) : "–");
    html += Row(cells, "td");
  }
  const auto baseline = [&](const char* name, const ev::TrajectoryErrors& errors) {
    std::vector<std::string> cells = {name, ""};
    for (std::string& cell : ErrorCells(errors, judged[0].metrics.path_length_m)) cells.push_back(std::move(cell));
    cells.resize(15);
    html += Row(cells, "td");
  };
  baseline("constant pose", judged[0].metrics.constant_pose);
  baseline("constant velocity", judged[0].metrics.constant_velocity);
  return html + "</tbody></table></div>\n";
}

std::string ReadBytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw ev::InputError({file.string() + ": cannot be read"});
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Every n-th picture, n as small as the room allows.
std::string Strip(const RunData& run, std::size_t room) {
  std::vector<std::string> pictures;
  std::size_t total = 0;
  for (const auto& file : run.pictures) {
    pictures.push_back(ReadBytes(file));
    total += pictures.back().size();
  }
  std::size_t every = 1;
  for (; total > room && every < pictures.size();) {
    ++every;
    total = 0;
    for (std::size_t i = every / 2; i < pictures.size(); i += every) total += pictures[i].size();
  }
  if (total > room) return "";
  std::string html;
  for (std::size_t i = every / 2; i < pictures.size(); i += every) {
    const auto stamp = ev::ParseSeconds(run.pictures[i].stem().string()).value_or(0);
    const double seconds = static_cast<double>(stamp - run.run.trajectory.front().stamp_ns) * 1e-9;
    const std::string when = "Frame at " + Fixed(seconds, 2) + " s";
    html += "<figure><img alt=\"" + when + " with the tracked features\" src=\"data:image/jpeg;base64," +
            Base64(pictures[i]) + "\"><figcaption>" + when + "</figcaption></figure>\n";
  }
  return html;
}

std::string Strips(const ResultData& data) {
  std::string html;
  const auto systems = data.Systems();
  std::vector<const RunData*> shown;
  for (const std::string& system : systems) {
    const RunData& run = data.Typical(system);
    if (!run.pictures.empty()) shown.push_back(&run);
  }
  for (const RunData* run : shown) {
    const std::string strip = Strip(*run, kPictureBytes / shown.size());
    if (strip.empty()) continue;
    html += "<h3>" + Escape(DisplayName(run->entry.system)) + ", seed " + std::to_string(run->entry.seed) +
            "</h3><div class=\"strip\" tabindex=\"0\" role=\"group\" aria-label=\"Frames of " +
            Escape(DisplayName(run->entry.system)) + "\">" + strip + "</div>\n";
  }
  return html;
}

bool OwnWorld(const std::vector<JudgedRun>& judged) {
  return std::any_of(judged.begin(), judged.end(),
                     [](const JudgedRun& run) { return run.metrics.options.gauge == ev::Gauge::first_pose; });
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

}  // namespace

std::string Page(const ResultData& data) {
  const std::vector<JudgedRun> judged = data.JudgedRuns();
  const std::string title = Escape(data.description.title.empty() ? "vobench report" : data.description.title);
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>" +
      title + " – vobench</title><style>" + kStyle + "</style></head><body><main>\n<h1>" + title + "</h1>\n" +
      Summary(data, judged);
  const bool many = data.runs.size() > data.Systems().size();
  const std::string typical =
      many ? " Bold: each system's typical run (of median ATE); faint: its other seeds." : std::string();
  const std::string own_paths = " Every seed flies a path of its own; shown is that of seed " +
                                std::to_string(data.Typical(data.Systems().front()).entry.seed) + ", where " +
                                Escape(DisplayName(data.Systems().front())) + " has its median ATE.";
  html += Section(
      "Path",
      (judged.empty() ? "In the odometry's own world and scale." : "Estimates aligned to the truth by Sim(3).") +
          (data.SharedTruth() ? typical : own_paths),
      Grid(PathFigures(data)));
  html += Section("Errors", "Distance from the truth, after the same alignment." + typical,
                  Grid(AlignedErrorFigures(data), "grid two"));
  html += Section("Runs", "", Table(judged));
  html += Section(
      "Is it as uncertain as it is wrong?",
      "NEES compares errors, not aligned, with the covariance the filter claims: 1 is ideal, above the band it is "
      "over-confident, below it cautious. Frames of one run depend on each other, so the band holds for each frame by "
      "itself. Scale: monocular odometry cannot see it; the second diagram does not count it." +
          std::string(OwnWorld(judged) ? " These runs began in a world of their own: the truth was moved there by its "
                                         "first pose, whose own error counts as theirs."
                                       : ""),
      Grid(NeesFigures(data)));
  html += Section(
      "Innovations",
      "NIS compares what the filter expected to see with what it saw; it needs no truth. Gating drops the largest "
      "innovations, so an honest filter sits slightly below 1.",
      Grid(NisFigures(data), "grid two"));
  const auto systems = data.Systems();
  for (std::size_t s = 0; s < systems.size(); ++s) {
    const RunData& run = data.Typical(systems[s]);
    const std::string name = Escape(DisplayName(systems[s])) + ", seed " + std::to_string(run.entry.seed);
    std::string body = Grid(PoseErrorFigures(run, s));
    const std::string velocity = Grid(VelocityErrorFigures(run, s));
    if (!velocity.empty()) body += "<details><summary>Velocity</summary>" + velocity + "</details>";
    html += Section(
        "Errors and what they should be: " + name,
        "Truth minus estimate, not aligned; orientation about the camera's axes. The band is what the filter claims.",
        body);
  }
  html += Section("Pose in time", judged.empty() ? "" : "Aligned by Sim(3).", Grid(PoseFigures(data)));
  html += Section("Features", "", Grid(FeatureFigures(data), "grid two"));
  html += Section(
      "Frames",
      "Green ring: matched, with a line from where it was expected. Orange cross: looked for and not found. Red ring: "
      "rejected as an outlier. Blue square: new.",
      Strips(data));
  html += Section("How this was made", "", Record(data.description));
  return html + "</main></body></html>\n";
}

}  // namespace report
