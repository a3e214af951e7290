// Interface by which a campaign runs its tasks, which keeps plan, output and processes independent of odometry and
// simulator: tools/bench/run/campaign_tasks.cpp implements it.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/campaign/plan.h"
#include "tools/bench/campaign/results.h"
#include "tools/bench/campaign/sequence_cache.h"

namespace vobench::campaign {

// All settings of a task but its seed.
struct TaskSettings {
  bool images = false;   // rendered sequence, else a world of points
  std::string resolved;  // as JSON
  std::string digest;    // of these, and of the files that a world of points is read from
};

class TaskRunner {
 public:
  virtual ~TaskRunner() = default;

  // Our systems, by name.
  virtual std::vector<std::string> Systems() const = 0;
  // Settings that restrict such a system to images and calibration.
  virtual Changes ImagesAlone() const = 0;
  // Read anew. `refuse` is called with a key and its problem in a campaign. Throws settings::Error.
  using Refuse = std::function<void(const std::string& key, const std::string& message)>;
  virtual TaskSettings Settings(const Campaign& campaign, const TaskChoice& choice, const Refuse& refuse) const = 0;

  // Name of the sequence of a task with images, by all inputs of its pictures. None where the files of its world are
  // not known or have changed: ReadWorld finds them, and throws std::invalid_argument where one cannot be read.
  virtual std::optional<std::string> SequenceName(const Campaign& campaign, const TaskChoice& choice,
                                                  SequenceCache& cache) const = 0;
  virtual void ReadWorld(const Campaign& campaign, const TaskChoice& choice, SequenceCache& cache) const = 0;
  // Renders the sequence of that name into the cache unless it is there. Throws std::runtime_error.
  virtual void Render(const Campaign& campaign, const TaskChoice& choice, const SequenceCache& cache,
                      const std::string& sequence, int threads) const = 0;

  // Simulates or tracks, evaluates, and writes the files of campaign.keep into `folder`, with times.json. Sets status,
  // reason and metrics of `record`. The sequence must be in the cache. One thread. Throws std::runtime_error: no
  // result.
  virtual void Run(const Campaign& campaign, const TaskChoice& choice, const SequenceCache& cache,
                   const std::string& sequence, const std::filesystem::path& folder, TaskRecord& record) const = 0;
};

}  // namespace vobench::campaign
