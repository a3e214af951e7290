#include "tools/bench/result/anees.h"

#include <fmt/format.h>

#include "tools/bench/text.h"
#include "tools/judge/evaluation/anees_test.h"

namespace vobench {
namespace {

using evaluation::kStateBlocks;

// nees[run][frame] of one block, without the first frame.
std::vector<std::vector<double>> OfBlock(const SystemRuns& runs, std::size_t block) {
  std::vector<std::vector<double>> all;
  for (const std::vector<evaluation::BlockNees>& run : runs.nees) {
    std::vector<double>& nees = all.emplace_back();
    for (std::size_t k = 1; k < run.size(); ++k) nees.push_back(run[k][block]);
  }
  return all;
}

template <class Value>
double MedianOver(const SystemRuns& runs, const Value& value) {
  std::vector<double> values;
  for (const evaluation::Metrics& metrics : runs.metrics) values.push_back(value(metrics.errors));
  return evaluation::Median(values);
}

}  // namespace

std::string AneesTable(const std::vector<SystemRuns>& systems) {
  std::string text;
  for (const SystemRuns& runs : systems) {
    using Errors = evaluation::TrajectoryErrors;
    text += fmt::format(
        "\n{}, {} runs. Median ATE [cm]: {:.2f} as it is, {:.2f} after SE(3), {:.2f} after Sim(3) alignment\n",
        DisplayName(runs.system), runs.nees.size(),
        100 * MedianOver(runs, [](const Errors& e) { return e.none.position.rmse; }),
        100 * MedianOver(runs, [](const Errors& e) { return e.se3.position.rmse; }),
        100 * MedianOver(runs, [](const Errors& e) { return e.sim3.position.rmse; }));
    text += fmt::format("{:<18}{:>4}{:>12}{:>12}  {:<16}{:>10}{:>9}{:>9}\n", "ANEES / dof", "dof", "mean", "last frame",
                        "band", "in band", "above", "below");
    for (std::size_t b = 0; b < kStateBlocks.size(); ++b) {
      const int dof = kStateBlocks[b].size;
      const auto nees = OfBlock(runs, b);
      const evaluation::AneesShare share = evaluation::ShareInBand(nees, dof);
      const evaluation::Band band = evaluation::Chi2MeanBand(dof, static_cast<int>(runs.nees.size()));
      if (share.frames == 0) {
        text += fmt::format("{:<18}{:>4}  no frame has a covariance that is positive definite\n", kStateBlocks[b].name,
                            dof);
        continue;
      }
      const evaluation::AneesPoint last = evaluation::AneesByFrame(nees, dof, 1).back();
      text += fmt::format("{:<18}{:>4}{:>12}{:>12}  {:<16}{:>8.1f} %{:>7.1f} %{:>7.1f} %\n", kStateBlocks[b].name, dof,
                          Readable(share.mean), Readable(last.anees / dof),
                          fmt::format("{:.2f} ... {:.2f}", band.low / dof, band.high / dof), 100 * share.share,
                          100 * share.above, 100 * share.below);
    }
    if (runs.bound) {
      text += "RMSE / Cramer-Rao bound:";
      for (std::size_t b = 0; b < runs.bound->overall.size(); ++b) {
        text += fmt::format("{} {} {}", b == 0 ? "" : ",", kStateBlocks[b].name, Readable(runs.bound->overall[b]));
      }
      text += '\n';
    }
  }
  text +=
      "Nothing is aligned for ANEES; 1 is ideal, more is over-confident. The band is that of one frame: of a "
      "consistent "
      "filter\nabout 95 % of the frames are in it, but frames depend on each other (docs/point_world.md).\n";
  return text;
}

std::string AneesCsv(const std::vector<SystemRuns>& systems) {
  std::string text = "system,block,dof,frame,runs,anees_per_dof,low,high\n";
  for (const SystemRuns& runs : systems) {
    for (std::size_t b = 0; b < kStateBlocks.size(); ++b) {
      const int dof = kStateBlocks[b].size;
      for (const evaluation::AneesPoint& point : evaluation::AneesByFrame(OfBlock(runs, b), dof, 1)) {
        text += fmt::format("{},{},{},{},{},{:.6g},{:.6g},{:.6g}\n", runs.system, kStateBlocks[b].name, dof,
                            point.stamp_ns, point.runs, point.anees / dof, point.band.low / dof, point.band.high / dof);
      }
    }
  }
  return text;
}

}  // namespace vobench
