#include "tools/judge/evaluation/estimate_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/judge/evaluation/text_file.h"

namespace evaluation {
namespace {

constexpr std::size_t kUpperTriangle = 78;
// Columns of frames.csv between the stamp and the status: counts, or numbers of `digits` digits.
struct Column {
  const char* name;
  int FrameRecord::*count;
  double FrameRecord::*number = nullptr;
  int digits = 6;
};
constexpr std::array<Column, 10> kColumns = {{{"searched", &FrameRecord::searched},
                                              {"matched", &FrameRecord::matched},
                                              {"landmarks", &FrameRecord::landmarks},
                                              {"permanent", &FrameRecord::permanent},
                                              {"nis", nullptr, &FrameRecord::nis, 9},
                                              {"nis_dof", &FrameRecord::nis_dof},
                                              {"effective_particles", nullptr, &FrameRecord::effective_particles},
                                              {"ms_features", nullptr, &FrameRecord::ms_features},
                                              {"ms_matching", nullptr, &FrameRecord::ms_matching},
                                              {"ms_filter", nullptr, &FrameRecord::ms_filter}}};
constexpr std::size_t kStatus = kColumns.size() + 1;  // behind it kNumericalEvents and `repeated`, where present
constexpr std::size_t kRepeated = kStatus + kNumericalEvents.size() + 1;
constexpr std::array kFormerEvents = {"unsettled", "behind", "indefinite", "impossible"};

std::string ColumnName(std::size_t i) {
  if (i == 0) return "timestamp";
  if (i == kRepeated) return "repeated";
  return i < kStatus ? kColumns[i - 1].name : i == kStatus ? "status" : kNumericalEvents[i - kStatus - 1].name;
}

std::vector<StampedBelief> ReadBeliefs(const std::filesystem::path& file, Problems& problems) {
  std::vector<StampedBelief> beliefs;
  for (const Line& line : Lines(file)) {
    std::array<double, 6 + kUpperTriangle> n{};
    const auto stamp = ParseRow(file, line, "timestamp, 6 velocities, 78 of the covariance", n, problems);
    if (!stamp) continue;
    if (!beliefs.empty() && *stamp <= beliefs.back().velocity.stamp_ns) {
      problems.Add(file, line.number, line.tokens[0].column,
                   "time " + line.tokens[0].text + " is not later than the one above");
    }
    StampedBelief belief{{*stamp, {n[0], n[1], n[2]}, {n[3], n[4], n[5]}}, Matrix12d::Zero()};
    std::size_t next = 6;
    for (int row = 0; row < 12; ++row) {
      const Token& variance = line.tokens[1 + next];
      if (n[next] < 0) {
        problems.Add(file, line.number, variance.column,
                     "variance " + std::to_string(row + 1) + " is negative: " + variance.text);
      }
      for (int column = row; column < 12; ++column, ++next) {
        belief.covariance(row, column) = belief.covariance(column, row) = n[next];
      }
    }
    beliefs.push_back(belief);
  }
  return beliefs;
}

// A whole number >= 0.
std::optional<int> ParseCount(const std::string& text) {
  const auto value = base::ParseWhole(text);
  if (!value || *value < 0 || *value > std::numeric_limits<int>::max()) return std::nullopt;
  return static_cast<int>(*value);
}

std::vector<FrameRecord> ReadFrames(const std::filesystem::path& file, Problems& problems) {
  std::vector<FrameRecord> frames;
  bool header = true;
  std::size_t columns = kRepeated + 1;
  for (const Line& line : Lines(file, ',')) {
    for (const std::size_t fewer : {kStatus + 1, kRepeated})
      if (header && line.tokens.size() == fewer) columns = fewer;
    if (!HasColumns(file, line, columns, problems)) {
      header = false;
      continue;
    }
    if (header) {
      for (std::size_t i = 0; i < columns; ++i) {
        const std::string& name = line.tokens[i].text;
        if (name == ColumnName(i)) continue;
        const bool former = i > kStatus && i < kRepeated && name == kFormerEvents[i - kStatus - 1];
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
    const auto take = [&](std::size_t i, const auto& value, auto& into, const char* what) {
      if (value && *value >= 0)
        into = *value;
      else
        bad(i, what);
    };
    for (std::size_t i = 1; i < kStatus; ++i) {
      const Column& column = kColumns[i - 1];
      const std::string& text = line.tokens[i].text;
      if (column.count != nullptr)
        take(i, ParseCount(text), record.*column.count, "a count");
      else
        take(i, ParseNumber(text), record.*column.number, "a number of zero or more");
    }
    const std::string& status = line.tokens[kStatus].text;
    record.tracked = status == "tracked";
    if (!record.tracked && status != "weak" && status != "coasted") bad(kStatus, "'tracked', 'weak' or 'coasted'");
    if (columns > kStatus + 1) record.events.emplace();
    if (columns > kRepeated) record.repeated.emplace();
    for (std::size_t i = kStatus + 1; i < columns; ++i) {
      int& into = i == kRepeated ? *record.repeated : (*record.events).*kNumericalEvents[i - kStatus - 1].count;
      take(i, ParseCount(line.tokens[i].text), into, "a count");
    }
    frames.push_back(record);
  }
  return frames;
}

// Checked before anything is written, so that an invalid number leaves no file behind.
void RequireFinite(bool finite, const char* what, std::int64_t stamp_ns) {
  if (finite) return;
  throw std::invalid_argument(std::string(what) + " at " + base::FormatSeconds(stamp_ns) +
                              " holds a number that is not finite; nothing was written");
}

std::string LineOf(const StampedBelief& belief) {
  std::vector<double> triangle;
  for (int row = 0; row < 12; ++row) {
    for (int column = row; column < 12; ++column) triangle.push_back(belief.covariance(row, column));
  }
  // Fifteen digits: with fewer, a covariance may lose positive definiteness.
  return base::FormatSeconds(belief.velocity.stamp_ns) + FormatNumbers(NumbersOf(belief.velocity)) +
         FormatNumbers(triangle, 15) + '\n';
}

std::string LineOf(const FrameRecord& f, std::size_t columns) {
  std::string text = base::FormatSeconds(f.stamp_ns);
  for (const auto& [name, count, number, digits] : kColumns) {
    text += ',' + (count != nullptr ? std::to_string(f.*count) : base::Significant(f.*number, digits));
  }
  text += f.tracked ? ",tracked" : f.matched > 0 ? ",weak" : ",coasted";
  if (columns > kStatus + 1)
    for (const NumericalEvent& event : kNumericalEvents) text += ',' + std::to_string((*f.events).*event.count);
  if (columns > kRepeated) text += ',' + std::to_string(*f.repeated);
  return text + '\n';
}

void WriteBeliefs(const std::filesystem::path& file, const std::vector<StampedBelief>& beliefs) {
  base::AtomicFile out(file);
  out.Append("# timestamp vx vy vz wx wy wz, then the upper triangle of the 12 x 12 covariance, row by row\n");
  for (const StampedBelief& belief : beliefs) out.Append(LineOf(belief));
  out.Commit();
}

void WriteFrames(const std::filesystem::path& file, const std::vector<FrameRecord>& frames) {
  const auto all = [&](const auto& has) { return std::all_of(frames.begin(), frames.end(), has); };
  std::size_t columns = kStatus + 1;
  if (all([](const FrameRecord& f) { return f.events.has_value(); })) {
    columns = kRepeated;
    if (all([](const FrameRecord& f) { return f.repeated.has_value(); })) ++columns;
  }
  base::AtomicFile out(file);
  for (std::size_t i = 0; i < columns; ++i) out.Append((i == 0 ? "" : ",") + ColumnName(i));
  out.Append("\n");
  for (const FrameRecord& frame : frames) out.Append(LineOf(frame, columns));
  out.Commit();
}

}  // namespace

EstimateRun Outside(EstimateRun run, std::int64_t from_ns, std::int64_t until_ns) {
  const auto inside = [&](std::int64_t stamp_ns) { return stamp_ns >= from_ns && stamp_ns < until_ns; };
  for (Trajectory* poses : {&run.trajectory, &run.live})
    std::erase_if(*poses, [&](const StampedPose& pose) { return inside(pose.stamp_ns); });
  std::erase_if(run.beliefs, [&](const StampedBelief& belief) { return inside(belief.velocity.stamp_ns); });
  std::erase_if(run.frames, [&](const FrameRecord& frame) { return inside(frame.stamp_ns); });
  return run;
}

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
  if (std::filesystem::exists(folder / "live.txt")) {
    attempt([&] { run.live = ReadTrajectory(folder / "live.txt"); });
  }
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
  for (const auto& [velocity, covariance] : run.beliefs) {
    RequireFinite(covariance.allFinite() && velocity.v_WC.allFinite() && velocity.w_WC_C.allFinite(),
                  "covariance.txt: the belief", velocity.stamp_ns);
  }
  for (const FrameRecord& frame : run.frames) {
    RequireFinite(std::ranges::all_of(kColumns,
                                      [&](const Column& column) {
                                        return column.number == nullptr || std::isfinite(frame.*column.number);
                                      }),
                  "frames.csv: the frame", frame.stamp_ns);
  }
  WriteTrajectory(folder / "estimate.txt", run.trajectory);
  const auto write = [&](const char* name, const auto& rows, const auto& write_rows) {
    if (rows.empty()) {
      std::filesystem::remove(folder / name);
    } else {
      write_rows(folder / name, rows);
    }
  };
  write("live.txt", run.live, WriteTrajectory);
  write("covariance.txt", run.beliefs, WriteBeliefs);
  write("frames.csv", run.frames, WriteFrames);
}

}  // namespace evaluation
