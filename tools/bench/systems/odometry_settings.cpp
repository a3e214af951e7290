#include "tools/bench/systems/odometry_settings.h"

#include "tools/base/settings/field_reader.h"

namespace vobench {

void ReadOdometry(settings::Section section, vo::Params& params) {
  settings::ReadFields(section, params);
  section.Reject(vo::Problems(params));
}

void ReadPrior(settings::Section section, PriorSettings& prior) { settings::ReadFields(section, prior); }

}  // namespace vobench
