#include "tools/bench/result/metrics_json.h"

#include <algorithm>
#include <iterator>

#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/result/json_file.h"
#include "tools/bench/result/system_summary.h"

namespace vobench {
namespace {

using Json = nlohmann::ordered_json;
namespace ev = evaluation;

constexpr const char* kFormat = "vobench metrics 1";
constexpr const char* kRules[] = {"one_to_one", "tum", "nearest"};

double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

// A number with its unit and how it was obtained. NaN becomes null.
Json Number(double value, const char* unit, const std::string& how) {
  return {{"value", value}, {"unit", unit}, {"how", how}};
}

Json Of(const ev::Statistics& s, const char* unit, const std::string& how) {
  return {{"unit", unit},       {"how", how},   {"count", s.count}, {"rmse", s.rmse}, {"mean", s.mean},
          {"median", s.median}, {"std", s.std}, {"min", s.min},     {"max", s.max}};
}

std::string RuleName(ev::AssociationRule rule) { return kRules[static_cast<std::size_t>(rule)]; }

ev::AssociationRule RuleOf(const Json& name) {
  const auto found = std::find(std::begin(kRules), std::end(kRules), name);
  return found == std::end(kRules) ? ev::AssociationRule::one_to_one
                                   : static_cast<ev::AssociationRule>(found - std::begin(kRules));
}

std::string HowAssociated(const ev::JudgeOptions& options) {
  return RuleName(options.association.rule) + " association, gap " +
         base::Significant(Seconds(options.association.gap_ns), 6) + " s";
}

Json Of(const ev::Ate& ate, const ev::JudgeOptions& options) {
  const std::string how = "after alignment '" + ev::Name(ate.alignment) + "' over " +
                          std::to_string(ate.position.count) + " pairs; " + HowAssociated(options);
  Json json = {{"position", Of(ate.position, "m", "distance of estimated and true position " + how)},
               {"scale", ate.similarity.scale},
               {"scale_determined", ate.similarity.scale_determined},
               {"rotation_determined", ate.similarity.rotation_determined}};
  if (ate.similarity.rotation_determined) {
    json["orientation"] = Of(ate.orientation, "rad", "angle between estimated and true orientation " + how);
  }
  return json;
}

Json Of(const ev::Rpe& rpe, const ev::JudgeOptions& options, const char* scale) {
  const std::string how = "E = B^-1 A over " + base::Significant(Seconds(options.rpe_delta_ns), 6) +
                          " s, pairs by the truth's stamps within " +
                          base::Significant(Seconds(options.rpe_tolerance_ns), 6) +
                          " s, estimated translations times " + scale + "; " + HowAssociated(options);
  return {{"position", Of(rpe.position_statistics, "m", how)},
          {"orientation", Of(rpe.orientation_statistics, "rad", how)},
          {"scale", rpe.scale},
          {"pairs", rpe.pairs.size()}};
}

// Without the errors where the poses do not determine the alignment.
ev::Ate Determined(const ev::TrajectoryErrors& errors, ev::Alignment alignment) {
  ev::Ate ate = errors.Aligned(alignment);
  const bool fitted = alignment != ev::Alignment::none && alignment != ev::Alignment::first;
  if (fitted && !errors.determines_alignment()) ate.position = {ate.position.count, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};
  return ate;
}

Json Of(const ev::TrajectoryErrors& errors, const ev::JudgeOptions& options) {
  Json json;
  for (const ev::Alignment alignment : ev::kAlignments) {
    json["ate"][ev::Name(alignment)] = Of(Determined(errors, alignment), options);
  }
  json["rpe"]["sim3_scale"] = Of(errors.rpe, options, "the scale of the sim3 alignment");
  json["rpe"]["unscaled"] = Of(errors.rpe_unscaled, options, "1");
  json["rpe"]["pairs_offered"] = errors.rpe_pairs_offered;
  json["pairs"] = errors.pairs;
  return json;
}

Json Of(const ev::NeesSummary& nees, const std::string& what, ev::Gauge gauge) {
  return {
      {"unit", "1"},
      {"how", what + "; errors not aligned" +
                  (gauge == ev::Gauge::first_pose ? ", truth moved into the estimate's world by the first pair of poses"
                                                  : "") +
                  "; ideal mean: dof. Frames of one run are dependent: no interval follows from their number"},
      {"dof", nees.dof},
      {"frames", nees.frames},
      {"frames_without_value", nees.unusable},
      {"mean", nees.mean},
      {"mean_per_dof", nees.mean / nees.dof},
      {"median", nees.median},
      {"last", nees.last},
      {"share_inside_95_percent_band", nees.share_inside}};
}

Json Of(const ev::Metrics& metrics) {
  const ev::JudgeOptions& options = metrics.options;
  const double ate_m = Determined(metrics.errors, ev::Alignment::sim3).position.rmse;
  Json json = {{"options",
                {{"association", RuleName(options.association.rule)},
                 {"gap_s", Seconds(options.association.gap_ns)},
                 {"rpe_delta_s", Seconds(options.rpe_delta_ns)},
                 {"rpe_tolerance_s", Seconds(options.rpe_tolerance_ns)},
                 {"nees_gauge", options.gauge == ev::Gauge::first_pose ? "first_pose" : "as_is"}}},
               {"path_length", Number(metrics.path_length_m, "m", "along the truth at the frames of the sequence")},
               {"duration", Number(metrics.duration_s, "s", "between the first and the last frame that has truth")},
               {"errors", Of(metrics.errors, options)},
               {"ate_share_of_path",
                Number(ate_m / metrics.path_length_m, "1", "position RMSE after sim3 alignment / path length")},
               {"ate_share_of_spread",
                Number(ate_m / metrics.spread_m, "1",
                       "position RMSE after sim3 alignment / RMS distance of the true positions from their mean")}};
  if (metrics.live) json["live_errors"] = Of(*metrics.live, options);
  if (metrics.coverage) {
    json["coverage"] = {
        {"frames", metrics.coverage->frames},
        {"frames_with_pose", metrics.coverage->with_pose},
        {"pose_coverage", Number(metrics.coverage->pose_coverage(), "1", "frames with a pose / frames")}};
    if (metrics.coverage->tracked) {
      json["coverage"]["frames_tracked"] = *metrics.coverage->tracked;
      json["coverage"]["tracked_coverage"] = Number(
          *metrics.coverage->tracked_coverage(), "1",
          "frames in which at least 10, and 40 % of the searched, features match at the first prediction / frames");
    }
  }
  if (metrics.consistency) {
    const ev::ConsistencySummary& c = *metrics.consistency;
    const auto add = [&](const char* name, const std::optional<ev::NeesSummary>& nees, const std::string& what) {
      if (nees) json["nees"][name] = Of(*nees, what, options.gauge);
    };
    const std::string smallest = ", smallest over the scale of the map about the start";
    add("pose", c.pose, "position and orientation");
    add("pose_scale_free", c.pose_scale_free, "position and orientation" + smallest);
    add("velocity", c.velocity, "linear and angular velocity");
    add("joint", c.joint, "pose and velocity");
    add("joint_scale_free", c.joint_scale_free, "pose and velocity" + smallest);
  }
  if (metrics.nis) {
    json["nis"] = {
        {"unit", "1"},
        {"how", "innovations of matched features; dof 2 per feature; gating makes a consistent filter slightly low"},
        {"frames", metrics.nis->frames},
        {"mean_per_dof", metrics.nis->mean_per_dof},
        {"share_inside_95_percent_band", metrics.nis->share_inside},
        {"autocorrelation_lag_1_to_5", metrics.nis->autocorrelation},
        {"whiteness_bound", metrics.nis->whiteness_bound}};
  }
  if (metrics.timing) {
    json["time_per_frame"] = {{"unit", "ms"},
                              {"how", "medians over frames"},
                              {"features", metrics.timing->ms_features},
                              {"matching", metrics.timing->ms_matching},
                              {"filter", metrics.timing->ms_filter}};
  }
  if (metrics.events) {
    Json& events = json["numerical_events"];
    events["how"] = "what the filter's equations do not say, and happened: docs/odometry.md";
    for (std::size_t i = 0; i < ev::kNumericalEvents.size(); ++i) {
      const ev::EventCount& count = (*metrics.events)[i];
      events[ev::kNumericalEvents[i].name] = {{"times", count.times}, {"frames", count.frames}};
    }
  }
  json["baselines"]["constant_pose"] = Of(metrics.constant_pose, options);
  json["baselines"]["constant_velocity"] = Of(metrics.constant_velocity, options);
  return json;
}

Json Of(const SystemSummary& s) {
  const auto median = [](double value, const char* unit, const std::string& of) {
    return Number(value, unit, "median over runs of: " + of);
  };
  return {{"system", s.system},
          {"runs", s.runs},
          {"ate", median(s.ate_m, "m", "position RMSE after sim3 alignment")},
          {"ate_live", median(s.ate_live_m, "m", "position RMSE of the answers as given, after sim3 alignment")},
          {"ate_worst", Number(s.ate_worst_m, "m", "largest over runs of: position RMSE after sim3 alignment")},
          {"ate_share_of_path", median(s.ate_share_of_path, "1", "position RMSE after sim3 alignment / path length")},
          {"rpe_position", median(s.rpe_m, "m", "RPE position RMSE, scaled by sim3")},
          {"rpe_orientation", median(s.rpe_rad, "rad", "RPE orientation RMSE")},
          {"pose_coverage", median(s.pose_coverage, "1", "pose coverage")},
          {"tracked_coverage", median(s.tracked_coverage, "1", "tracked coverage")},
          {"nees_pose_per_dof", median(s.nees_pose_per_dof, "1", "time-mean NEES of the pose / 6")},
          {"nees_pose_scale_free_per_dof",
           median(s.nees_pose_scale_free_per_dof, "1", "time-mean scale-free NEES of the pose / 5")},
          {"nees_velocity_per_dof", median(s.nees_velocity_per_dof, "1", "time-mean NEES of the velocity / 6")},
          {"nis_per_dof", median(s.nis_per_dof, "1", "sum of NIS / sum of degrees of freedom")}};
}

}  // namespace

void WriteMetricsJson(const std::filesystem::path& out, const std::vector<RunMetrics>& runs) {
  Json json = {{"format", kFormat}, {"systems", Json::array()}, {"baselines", Json::array()}, {"runs", Json::array()}};
  for (const SystemSummary& summary : SummariseSystems(runs)) json["systems"].push_back(Of(summary));
  for (const SystemSummary& summary : SummariseBaselines(runs)) json["baselines"].push_back(Of(summary));
  for (const RunMetrics& judged : runs) {
    Json run = {{"system", judged.run.system}, {"seed", judged.run.seed}, {"path", judged.run.path}};
    run.update(Of(judged.metrics));
    if (judged.run.calibration) run["calibration"] = ToJson(*judged.run.calibration);
    json["runs"].push_back(run);
  }
  base::WriteFile(out / "metrics.json", json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::vector<RecordedMetrics> ReadMetricsJson(const std::filesystem::path& out) {
  return ReadJson(out / "metrics.json", kFormat, [](const Json& json) {
    const auto nanoseconds = [](const Json& value) {
      const auto ns = ev::Nanoseconds(value.get<double>());
      if (!ns) throw ev::InputError({value.dump() + " s is no time of 1e9 s at most"});
      return *ns;
    };
    std::vector<RecordedMetrics> recorded;
    for (const Json& run : json.at("runs")) {
      RecordedMetrics& metrics = recorded.emplace_back();
      metrics.path = run.at("path").get<std::string>();
      const Json& options = run.at("options");
      metrics.options.association.rule = RuleOf(options.at("association"));
      metrics.options.association.gap_ns = nanoseconds(options.at("gap_s"));
      metrics.options.rpe_delta_ns = nanoseconds(options.at("rpe_delta_s"));
      metrics.options.rpe_tolerance_ns = nanoseconds(options.at("rpe_tolerance_s"));
      metrics.options.gauge = options.at("nees_gauge") == "first_pose" ? ev::Gauge::first_pose : ev::Gauge::as_is;
      const Json& ate = run.at("errors").at("ate").at("sim3").at("position").at("rmse");
      metrics.ate_sim3_rmse_m = ate.is_null() ? kNaN : ate.get<double>();
    }
    return recorded;
  });
}

}  // namespace vobench
