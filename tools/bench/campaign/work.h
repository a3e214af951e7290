// Resolved campaign: every scenario, variant and system read and checked, and the key of all inputs of a task.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/bench/campaign/plan.h"
#include "tools/bench/campaign/process_pool.h"
#include "tools/bench/campaign/results.h"
#include "tools/bench/campaign/sequence_cache.h"
#include "tools/bench/campaign/task_runner.h"

namespace vobench::campaign {

// A scenario with one value of each varied setting.
struct CampaignPoint {
  bool images = false;
  std::string sequence;               // of images: its name in the cache
  LevelValues levels;                 // for results.csv
  std::vector<std::string> settings;  // digest of all settings, by system
};

class CampaignWork {
 public:
  // Throws BadInput with every problem of the campaign's file and of the files that it names; nothing is run. `runner`
  // must outlive it.
  CampaignWork(const std::filesystem::path& file, std::filesystem::path cache, const TaskRunner& runner);

  const Campaign& campaign() const { return campaign_; }
  const std::vector<CampaignPoint>& points() const { return points_; }
  const SequenceCache& cache() const { return cache_; }

  // Reads worlds that have not been read, in separate processes, and names the sequences of these points. Throws
  // BadInput where one cannot be read.
  void NameSequences(const std::vector<std::size_t>& points, const ProcessLimits& limits);

  // Key of all inputs of a task's result; the sequence of its point must have its name.
  std::string KeyOf(const TaskChoice& choice) const;

  // Renders the sequence of a point. Throws BadInput also where settings have changed, std::runtime_error.
  void Render(std::size_t point, int threads) const;
  // Runs a task into OUT/tasks/..., replacing an older result. The sequence that it needs must be in the cache. Throws
  // as Render: then nothing is written.
  void Run(const std::filesystem::path& out, std::int64_t task) const;
  // Records a task without a result, and the reason.
  void RecordFailure(const std::filesystem::path& out, std::int64_t task, const std::string& reason) const;

 private:
  void Resolve(const std::filesystem::path& file);
  void RequireUnchanged(const TaskChoice& choice) const;
  // Record of a task without its results.
  TaskRecord BlankRecord(std::int64_t task) const;

  const TaskRunner& runner_;
  Campaign campaign_;
  std::vector<CampaignPoint> points_;
  SequenceCache cache_;
  std::string program_;
};

// Local engine: sequences are rendered first, then tasks run, each in a separate process. Afterwards each of these
// tasks has a result, possibly `failed`. Rendering has no time-out. Sequences have their names. Throws Interrupted;
// finished results are kept. No thread may have been started before.
void RunLocally(const CampaignWork& work, const std::filesystem::path& out, const std::vector<std::int64_t>& tasks,
                const Share& share);

}  // namespace vobench::campaign
