#include "tools/vobench/option_table.h"

namespace vobench {

void OptionTable::AddSettings() {
  CLI::App& command =
      AddCommand("settings", "List all settings: key, default, range, meaning", "vobench settings odometry.filter");
  command.add_option("PREFIX", settings.prefix, "Only keys that begin so")->type_name("KEY");
  command.add_flag("--markdown", settings.markdown, "As the tables of docs/settings.md");
  command.callback([this] { asked = settings; });
}

}  // namespace vobench
