#include <fmt/format.h>

#include "tools/bench/errors.h"
#include "tools/bench/run/commands.h"
#include "tools/bench/systems/experiment.h"

namespace vobench {

void Settings(const SettingsOptions& options) {
  if (options.markdown) return fmt::print("{}", SettingsMarkdown());
  bool any = false;
  for (const auto& [key, value, range, help] : SettingsTable()) {
    if (!key.starts_with(options.prefix)) continue;
    any = true;
    fmt::print("{} = {}{}\n    {}\n", key, value, range.empty() ? "" : "   (" + range + ")", help);
  }
  if (!any) throw BadInput("no setting begins with '" + options.prefix + "'; `vobench settings` lists them all");
}

}  // namespace vobench
