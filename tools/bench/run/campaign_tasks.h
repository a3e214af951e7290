// Tasks of a campaign on our odometries and on external programs: played or tracked, judged, written to their folders.
// A result is a function of the campaign's file and the task's number; times are kept apart.
#pragma once

#include "tools/bench/campaign/task_runner.h"

namespace vobench {

class CampaignTasks : public campaign::TaskRunner {
 public:
  std::vector<std::string> Systems() const override;
  campaign::TaskSettings Settings(const campaign::Campaign& campaign, const campaign::TaskChoice& choice,
                                  const Refuse& refuse) const override;
  std::optional<std::string> SequenceName(const campaign::Campaign& campaign, const campaign::TaskChoice& choice,
                                          campaign::SequenceCache& cache) const override;
  void ReadWorld(const campaign::Campaign& campaign, const campaign::TaskChoice& choice,
                 campaign::SequenceCache& cache) const override;
  void Render(const campaign::Campaign& campaign, const campaign::TaskChoice& choice,
              const campaign::SequenceCache& cache, const std::string& sequence, int threads) const override;
  void Run(const campaign::Campaign& campaign, const campaign::TaskChoice& choice, const campaign::SequenceCache& cache,
           const std::string& sequence, const std::filesystem::path& folder,
           campaign::TaskRecord& record) const override;
};

}  // namespace vobench
