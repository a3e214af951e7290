// Purpose: a campaign whose every scenario, variant and system has been read and checked: what there is to do, and the
//          name of what it depends on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tools/bench/campaign/plan.h"
#include "tools/bench/campaign/process_pool.h"
#include "tools/bench/campaign/results.h"
#include "tools/bench/campaign/sequence_cache.h"
#include "tools/bench/systems/experiment.h"

namespace vobench {

// A scenario with one value of everything that is varied.
struct CampaignPoint {
  bool images = false;
  std::string sequence;               // of images: its name in the cache
  campaign::LevelValues levels;       // for results.csv
  std::vector<std::string> settings;  // digest of all settings, by system
};

class CampaignWork {
 public:
  // Throws BadInput with every problem of the campaign's file and of all that it names; nothing is run.
  CampaignWork(const std::filesystem::path& file, std::filesystem::path cache);

  const campaign::Campaign& campaign() const { return campaign_; }
  const std::vector<CampaignPoint>& points() const { return points_; }
  const campaign::SequenceCache& cache() const { return cache_; }

  // Reads worlds that have not been read, in processes of their own, and names the sequences of these points. Throws
  // BadInput where one cannot be read.
  void NameSequences(const std::vector<std::size_t>& points, const campaign::ProcessLimits& limits);

  // The settings of one task, read anew. Throws BadInput, also when they are no longer what they were.
  Experiment ExperimentOf(const campaign::TaskChoice& choice) const;

  // Of all that a task's result depends on; the sequence of its point must have its name.
  std::string KeyOf(const campaign::TaskChoice& choice) const;
  // All but what it found out.
  campaign::TaskRecord BlankRecord(std::int64_t task) const;

 private:
  void Resolve(const std::filesystem::path& file);

  campaign::Campaign campaign_;
  std::vector<CampaignPoint> points_;
  campaign::SequenceCache cache_;
  std::string program_;
};

// A task that does `point` with `system`, for asking what is the same with every seed.
campaign::TaskChoice AtPoint(const campaign::Campaign& campaign, std::size_t point, std::size_t system);

}  // namespace vobench
