#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <sstream>

#include "tools/bench/errors.h"
#include "tools/judge/evaluation/compat/evo.h"
#include "tools/judge/evaluation/compat/openvins.h"
#include "tools/judge/evaluation/compat/rpg.h"
#include "tools/judge/evaluation/compat/tum.h"
#include "tools/judge/evaluation/text_file.h"
#include "tools/vobench/arguments.h"

namespace vobench {
namespace {

using namespace evaluation::compat;  // the file's subject
using evaluation::Trajectory;

constexpr const char* kTools =
    "--compat is one of: tum [ate|rpe], evo ape|rpe, rpg, ov MODE, and that tool's own options (docs/metrics.md)";

std::int64_t Nanoseconds(const char* option, double seconds) {
  const auto ns = evaluation::Nanoseconds(seconds);
  if (!ns)
    throw BadInput(
        fmt::format("--compat '... {} {}': not a time of {} s at most", option, seconds, evaluation::kLongest_s));
  return *ns;
}

// The options of one program, parsed from the words after its name.
void Parse(CLI::App& app, std::vector<std::string> words) {
  app.set_help_flag();
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    throw BadInput(fmt::format("--compat '{} ...': {}\n{}", app.get_name(), error.what(), kTools));
  }
}

Reproduction TumAte(const std::vector<std::string>& arguments, bool verbose) {
  TumAteOptions options;
  options.verbose = verbose;
  double gap = 0.02, offset = 0;
  CLI::App app("", "tum ate");
  app.add_option("--offset", offset);
  app.add_option("--scale", options.scale);
  app.add_option("--max_difference", gap)->check(CLI::PositiveNumber);
  app.add_flag("--verbose", options.verbose);
  Parse(app, arguments);
  options.max_difference_ns = Nanoseconds("--max_difference", gap);
  options.offset_ns = Nanoseconds("--offset", offset);
  return {evaluation::Reading::strict, [options](const Trajectory& estimate, const Trajectory& truth) {
            return Print(ComputeTumAte(estimate, truth, options), options);
          }};
}

Reproduction TumRpe(const std::vector<std::string>& arguments, bool verbose) {
  TumRpeOptions options;
  options.verbose = verbose;
  double offset = 0;
  const std::map<std::string, TumDeltaUnit> units = {{"s", TumDeltaUnit::seconds},
                                                     {"f", TumDeltaUnit::frames},
                                                     {"m", TumDeltaUnit::metres},
                                                     {"rad", TumDeltaUnit::radians},
                                                     {"deg", TumDeltaUnit::degrees}};
  CLI::App app("", "tum rpe");
  app.add_flag("--fixed_delta", options.fixed_delta);
  app.add_option("--delta", options.delta)->check(CLI::PositiveNumber);
  app.add_option("--delta_unit", options.unit)->transform(CLI::CheckedTransformer(units));
  app.add_option("--max_pairs", options.max_pairs);
  app.add_option("--offset", offset);
  app.add_option("--scale", options.scale);
  app.add_option("--seed", options.seed);
  app.add_flag("--verbose", options.verbose);
  Parse(app, arguments);
  options.offset_ns = Nanoseconds("--offset", offset);
  if (options.unit == TumDeltaUnit::seconds) Nanoseconds("--delta", options.delta);
  return {evaluation::Reading::strict, [options](const Trajectory& estimate, const Trajectory& truth) {
            return Print(ComputeTumRpe(estimate, truth, options), options);
          }};
}

// Both scripts, as they are with --verbose.
Reproduction TumBoth() {
  const Reproduction ate = TumAte({}, true), rpe = TumRpe({}, true);
  return {ate.reading, [ate, rpe](const Trajectory& estimate, const Trajectory& truth) {
            return ate.Run(estimate, truth) + rpe.Run(estimate, truth);
          }};
}

Reproduction Evo(const std::string& program, const std::vector<std::string>& arguments) {
  EvoRpeOptions options;
  EvoOptions& common = options.common;
  double gap = 0.01, offset = 0;
  int n_to_align = -1;
  const std::map<std::string, EvoRelation> relations = {{"trans_part", EvoRelation::translation},
                                                        {"rot_part", EvoRelation::rotation},
                                                        {"full", EvoRelation::full},
                                                        {"angle_deg", EvoRelation::angle_deg},
                                                        {"angle_rad", EvoRelation::angle_rad}};
  const std::map<std::string, EvoDeltaUnit> units = {{"f", EvoDeltaUnit::frames}, {"m", EvoDeltaUnit::metres}};
  CLI::App app("", "evo " + program);
  app.add_option("-r,--pose_relation", common.relation)->transform(CLI::CheckedTransformer(relations));
  CLI::Option* align = app.add_flag("-a,--align", common.align);
  CLI::Option* scale = app.add_flag("-s,--correct_scale", common.correct_scale);
  app.add_flag("--align_origin", common.align_origin)->excludes(align)->excludes(scale);
  app.add_option("--n_to_align", n_to_align)->check(CLI::Range(-1, 1000000000));
  app.add_option("--t_max_diff", gap)->check(CLI::PositiveNumber);
  app.add_option("--t_offset", offset);
  if (program == "rpe") {
    app.add_option("-d,--delta", options.delta)->check(CLI::PositiveNumber);
    app.add_option("-u,--delta_unit", options.unit)->transform(CLI::CheckedTransformer(units));
    app.add_option("-t,--delta_tol", options.delta_tolerance)->check(CLI::PositiveNumber);
    app.add_flag("--all_pairs", options.all_pairs);
    app.add_flag("--pairs_from_reference", options.pairs_from_reference);
  }
  Parse(app, arguments);
  if (options.unit == EvoDeltaUnit::frames && options.delta != std::floor(options.delta)) {
    throw BadInput(fmt::format("--compat 'evo rpe --delta {}': frames are counted whole", options.delta));
  }
  common.t_max_diff_ns = Nanoseconds("--t_max_diff", gap);
  common.t_offset_ns = Nanoseconds("--t_offset", offset);
  common.n_to_align = n_to_align < 0 ? 0 : static_cast<std::size_t>(n_to_align);
  const bool absolute = program == "ape";
  return {evaluation::Reading::strict, [options, absolute](const Trajectory& estimate, const Trajectory& truth) {
            return Print(absolute ? ComputeEvoApe(estimate, truth, options.common)
                                  : ComputeEvoRpe(estimate, truth, options));
          }};
}

Reproduction Rpg(const std::vector<std::string>& arguments) {
  using A = evaluation::Alignment;
  A alignment = A::sim3;
  std::vector<double> lengths;
  const std::map<std::string, A> names = {{"sim3", A::sim3}, {"se3", A::se3}, {"posyaw", A::yaw}, {"none", A::none}};
  CLI::App app("", "rpg");
  app.add_option("--align_type", alignment)->transform(CLI::CheckedTransformer(names));
  app.add_option("--lengths", lengths)->delimiter(',')->check(CLI::PositiveNumber);
  Parse(app, arguments);
  return {evaluation::Reading::strict, [alignment, lengths](const Trajectory& estimate, const Trajectory& truth) {
            return Print(ComputeRpg(estimate, truth, alignment, lengths).errors);
          }};
}

Reproduction Ov(const std::vector<std::string>& arguments) {
  OvAlignment alignment = OvAlignment::none;
  std::vector<double> segments = {8, 16, 24, 32, 40};
  const std::map<std::string, OvAlignment> alignments = {
      {"posyaw", OvAlignment::posyaw}, {"posyawsingle", OvAlignment::posyawsingle},
      {"se3", OvAlignment::se3},       {"se3single", OvAlignment::se3single},
      {"sim3", OvAlignment::sim3},     {"none", OvAlignment::none}};
  CLI::App app("", "ov");
  app.add_option("MODE", alignment)->required()->transform(CLI::CheckedTransformer(alignments));
  app.add_option("--segments", segments)->delimiter(',')->check(CLI::PositiveNumber);
  Parse(app, arguments);
  return {evaluation::Reading::as_written, [alignment, segments](const Trajectory& estimate, const Trajectory& truth) {
            return Print(ComputeOv(estimate, truth, alignment, segments));
          }};
}

}  // namespace

Reproduction ParseCompat(const std::string& request) {
  std::istringstream stream(request);
  std::vector<std::string> words(std::istream_iterator<std::string>(stream), {});
  const auto take = [&] {
    const std::string first = words.empty() ? "" : words.front();
    if (!words.empty()) words.erase(words.begin());
    return first;
  };
  const std::string tool = take();
  if (tool == "tum" && words.empty()) return TumBoth();
  if (tool == "rpg") return Rpg(words);
  if (tool == "ov") return Ov(words);
  const std::string program = take();
  if (tool == "tum" && program == "ate") return TumAte(words, false);
  if (tool == "tum" && program == "rpe") return TumRpe(words, false);
  if (tool == "evo" && (program == "ape" || program == "rpe")) return Evo(program, words);
  throw BadInput(fmt::format("--compat '{}' is not known\n{}", request, kTools));
}

}  // namespace vobench
