#include "tools/bench/systems/experiment.h"

#include <nlohmann/json.hpp>
#include <set>

#include "tools/base/settings/settings.h"
#include "tools/bench/errors.h"
#include "tools/bench/systems/bridge.h"

namespace vobench {
namespace {

// One reader's problems that the other has not told already: both see the same file.
class Collector {
 public:
  template <class Reader>
  void Read(const Reader& reader) {
    try {
      reader();
    } catch (const settings::Error& error) {
      for (const settings::Problem& problem : error.problems()) {
        if (told_.insert(settings::ToString(problem)).second) problems_.push_back(problem);
      }
    }
  }
  void ThrowIfBad() const {
    if (!problems_.empty()) throw settings::Error(problems_);
  }

 private:
  std::set<std::string> told_;
  std::vector<settings::Problem> problems_;
};

void ReadOthers(const std::filesystem::path& file, const Overrides& overrides, Experiment& experiment) {
  settings::Document document = settings::Document::FromFile(file);
  for (const auto& [key, value] : overrides) document.Override(key, value);
  settings::Section root = document.root();
  ReadOdometry(root.Child("odometry"), experiment.odometry);
  ReadPrior(root.Child("prior"), experiment.prior);
  root.IgnoreRest();
  document.ThrowIfBad();
  experiment.resolved = document.Resolved();
}

}  // namespace

vo::Camera CameraForOdometry(const Experiment& experiment) {
  vo::Camera camera = CameraOf(experiment.scenario);
  camera.fx *= 1 + experiment.prior.focal_error;
  camera.fy *= 1 + experiment.prior.focal_error;
  return camera;
}

Experiment LoadExperiment(const std::filesystem::path& scenario, const Overrides& overrides) {
  Experiment experiment;
  Collector collector;
  collector.Read([&] { experiment.scenario = sim::LoadScenario(scenario, overrides); });
  collector.Read([&] { ReadOthers(scenario, overrides, experiment); });
  collector.ThrowIfBad();
  nlohmann::ordered_json all = nlohmann::ordered_json::parse(experiment.scenario.resolved);
  all.update(nlohmann::ordered_json::parse(experiment.resolved));
  experiment.resolved = all.dump(2);
  return experiment;
}

Experiment ReadExperiment(const std::filesystem::path& scenario, const Overrides& overrides) {
  return Input([&] { return LoadExperiment(scenario, overrides); });
}

}  // namespace vobench
