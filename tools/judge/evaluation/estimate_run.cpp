#include "tools/judge/evaluation/estimate_run.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>

#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/judge/evaluation/text_file.h"

namespace evaluation {
namespace {

constexpr std::size_t kUpperTriangle = 78;
// Columns of frames.csv, behind which kNumericalEvents stand where they are known.
constexpr std::array kColumns = {"timestamp",   "searched",    "matched",   "landmarks",
                                 "permanent",   "nis",         "nis_dof",   "effective_particles",
                                 "ms_features", "ms_matching", "ms_filter", "status"};
constexpr std::array kFormerEvents = {"unsettled", "behind", "indefinite", "impossible"};

std::string ColumnName(std::size_t i) {
  return i < kColumns.size() ? kColumns[i] : kNumericalEvents[i - kColumns.size()].name;
}

std::vector<StampedBelief> ReadBeliefs(const std::filesystem::path& file, Problems& problems) {
  std::vector<StampedBelief> beliefs;
  for (const Line& line : ReadLines(file)) {
    if (line.tokens.size() != 7 + kUpperTriangle) {
      problems.Add(file, line.number, line.tokens.front().column,
                   std::to_string(line.tokens.size()) +
                       " columns where 85 are expected (timestamp, 6 velocities, 78 of the covariance)");
      continue;
    }
    std::array<double, 6 + kUpperTriangle> n{};
    for (std::size_t i = 0; i < n.size(); ++i) {
      const Token& token = line.tokens[i + 1];
      if (const auto number = ParseNumber(token.text)) {
        n[i] = *number;
      } else {
        problems.Add(file, line.number, token.column, "'" + token.text + "' is not a finite number");
      }
    }
    const auto stamp = base::ParseSeconds(line.tokens[0].text);
    if (!stamp) {
      problems.Add(file, line.number, line.tokens[0].column,
                   "'" + line.tokens[0].text + "' is not a time in seconds, 4e9 at most");
      continue;
    }
    if (!beliefs.empty() && *stamp <= beliefs.back().velocity.stamp_ns) {
      problems.Add(file, line.number, line.tokens[0].column,
                   "time " + line.tokens[0].text + " is not later than the one above");
    }
    StampedBelief belief{{*stamp, {n[0], n[1], n[2]}, {n[3], n[4], n[5]}}, Matrix12d::Zero()};
    std::size_t next = 6;
    for (int row = 0; row < 12; ++row) {
      for (int column = row; column < 12; ++column, ++next) {
        belief.covariance(row, column) = belief.covariance(column, row) = n[next];
      }
      if (belief.covariance(row, row) < 0) {
        const std::size_t diagonal = next - static_cast<std::size_t>(12 - row);
        problems.Add(file, line.number, line.tokens[1 + diagonal].column,
                     "variance " + std::to_string(row + 1) + " is negative: " + line.tokens[1 + diagonal].text);
      }
    }
    beliefs.push_back(belief);
  }
  return beliefs;
}

// A whole number >= 0.
std::optional<int> ParseCount(const std::string& text) {
  int value{};
  const char* const all = std::to_address(text.end());
  const auto [end, error] = std::from_chars(text.data(), all, value);
  if (error != std::errc() || end != all || value < 0) return std::nullopt;
  return value;
}

std::vector<FrameRecord> ReadFrames(const std::filesystem::path& file, Problems& problems) {
  std::vector<FrameRecord> frames;
  bool header = true;
  std::size_t columns = kColumns.size() + kNumericalEvents.size();
  for (const Line& line : ReadLines(file, ',')) {
    if (header && line.tokens.size() == kColumns.size()) columns = kColumns.size();
    if (line.tokens.size() != columns) {
      problems.Add(file, line.number, 1,
                   std::to_string(line.tokens.size()) + " columns where " + std::to_string(columns) + " are expected");
      header = false;
      continue;
    }
    if (header) {
      for (std::size_t i = 0; i < columns; ++i) {
        const std::string& name = line.tokens[i].text;
        if (name == ColumnName(i)) continue;
        const bool former = i >= kColumns.size() && name == kFormerEvents[i - kColumns.size()];
        problems.Add(file, line.number, line.tokens[i].column,
                     "column '" + name + "' " + (former ? "is now" : "where") + " '" + ColumnName(i) + "'" +
                         (former ? "" : " is expected"));
      }
      header = false;
      continue;
    }
    FrameRecord record;
    const auto bad = [&](std::size_t i, const char* what) {
      problems.Add(file, line.number, line.tokens[i].column, "'" + line.tokens[i].text + "' is not " + what);
    };
    if (const auto stamp = base::ParseSeconds(line.tokens[0].text)) {
      record.stamp_ns = *stamp;
      if (!frames.empty() && *stamp <= frames.back().stamp_ns) bad(0, "later than the time above");
    } else {
      bad(0, "a time in seconds");
    }
    const auto count = [&](std::size_t i, int& into) {
      const auto value = ParseCount(line.tokens[i].text);
      if (value)
        into = *value;
      else
        bad(i, "a count");
    };
    const auto number = [&](std::size_t i, double& into) {
      const auto value = ParseNumber(line.tokens[i].text);
      if (value && *value >= 0)
        into = *value;
      else
        bad(i, "a number of zero or more");
    };
    count(1, record.searched);
    count(2, record.matched);
    count(3, record.landmarks);
    count(4, record.permanent);
    number(5, record.nis);
    count(6, record.nis_dof);
    number(7, record.effective_particles);
    number(8, record.ms_features);
    number(9, record.ms_matching);
    number(10, record.ms_filter);
    record.tracked = line.tokens[11].text == "tracked";
    if (!record.tracked && line.tokens[11].text != "coasted") bad(11, "'tracked' or 'coasted'");
    if (columns > kColumns.size()) {
      record.events.emplace();
      for (std::size_t i = 0; i < kNumericalEvents.size(); ++i) {
        count(kColumns.size() + i, (*record.events).*kNumericalEvents[i].count);
      }
    }
    frames.push_back(record);
  }
  return frames;
}

// Before anything is written, so that a bad number leaves nothing behind.
void RequireFinite(const std::vector<StampedBelief>& beliefs) {
  for (const StampedBelief& belief : beliefs) {
    if (belief.covariance.allFinite() && belief.velocity.v_WC.allFinite() && belief.velocity.w_WC_C.allFinite())
      continue;
    throw std::invalid_argument("covariance.txt: the belief at " + base::FormatSeconds(belief.velocity.stamp_ns) +
                                " holds a number that is not finite; nothing was written");
  }
}

void RequireFinite(const std::vector<FrameRecord>& frames) {
  for (const FrameRecord& f : frames) {
    const double numbers[] = {f.nis, f.effective_particles, f.ms_features, f.ms_matching, f.ms_filter};
    if (std::all_of(std::begin(numbers), std::end(numbers), [](double value) { return std::isfinite(value); }))
      continue;
    throw std::invalid_argument("frames.csv: the frame at " + base::FormatSeconds(f.stamp_ns) +
                                " holds a number that is not finite; nothing was written");
  }
}

std::string LineOf(const StampedBelief& belief) {
  std::string text = base::FormatSeconds(belief.velocity.stamp_ns);
  for (int k = 0; k < 3; ++k) text += ' ' + base::Significant(belief.velocity.v_WC[k], 12);
  for (int k = 0; k < 3; ++k) text += ' ' + base::Significant(belief.velocity.w_WC_C[k], 12);
  // Fifteen digits: a covariance rounded more coarsely may no longer be positive definite.
  for (int row = 0; row < 12; ++row) {
    for (int column = row; column < 12; ++column) text += ' ' + base::Significant(belief.covariance(row, column), 15);
  }
  return text + '\n';
}

std::string LineOf(const FrameRecord& f, bool with_events) {
  std::string text = base::FormatSeconds(f.stamp_ns);
  for (const int value : {f.searched, f.matched, f.landmarks, f.permanent}) text += ',' + std::to_string(value);
  text += ',' + base::Significant(f.nis, 9) + ',' + std::to_string(f.nis_dof);
  for (const double value : {f.effective_particles, f.ms_features, f.ms_matching, f.ms_filter}) {
    text += ',' + base::Significant(value, 6);
  }
  text += f.tracked ? ",tracked" : ",coasted";
  if (with_events) {
    for (const NumericalEvent& event : kNumericalEvents) text += ',' + std::to_string((*f.events).*event.count);
  }
  return text + '\n';
}

void WriteBeliefs(const std::filesystem::path& file, const std::vector<StampedBelief>& beliefs) {
  base::AtomicFile out(file);
  out.Append("# timestamp vx vy vz wx wy wz, then the upper triangle of the 12 x 12 covariance, row by row\n");
  for (const StampedBelief& belief : beliefs) out.Append(LineOf(belief));
  out.Commit();
}

void WriteFrames(const std::filesystem::path& file, const std::vector<FrameRecord>& frames) {
  const bool with_events =
      std::all_of(frames.begin(), frames.end(), [](const FrameRecord& f) { return f.events.has_value(); });
  base::AtomicFile out(file);
  for (std::size_t i = 0; i < kColumns.size() + (with_events ? kNumericalEvents.size() : 0); ++i)
    out.Append((i == 0 ? "" : ",") + ColumnName(i));
  out.Append("\n");
  for (const FrameRecord& frame : frames) out.Append(LineOf(frame, with_events));
  out.Commit();
}

}  // namespace

EstimateRun ReadEstimateRun(const std::filesystem::path& folder) {
  EstimateRun run;
  Problems problems;
  std::vector<std::string> all;
  // Each file's problems are gathered before any is reported.
  const auto attempt = [&all](const auto& read) {
    try {
      read();
    } catch (const InputError& error) {
      all.push_back(error.what());
    }
  };
  attempt([&] { run.trajectory = ReadTrajectory(folder / "estimate.txt"); });
  if (std::filesystem::exists(folder / "covariance.txt")) {
    attempt([&] { run.beliefs = ReadBeliefs(folder / "covariance.txt", problems); });
  }
  if (std::filesystem::exists(folder / "frames.csv")) {
    attempt([&] { run.frames = ReadFrames(folder / "frames.csv", problems); });
  }
  attempt([&] { problems.ThrowIfAny(); });
  if (!all.empty()) throw InputError(all);
  return run;
}

void WriteEstimateRun(const std::filesystem::path& folder, const EstimateRun& run) {
  RequireFinite(run.beliefs);
  RequireFinite(run.frames);
  WriteTrajectory(folder / "estimate.txt", run.trajectory);
  const auto write = [&](const char* name, const auto& rows, const auto& write_rows) {
    if (rows.empty()) {
      std::filesystem::remove(folder / name);
    } else {
      write_rows(folder / name, rows);
    }
  };
  write("covariance.txt", run.beliefs, WriteBeliefs);
  write("frames.csv", run.frames, WriteFrames);
}

}  // namespace evaluation
