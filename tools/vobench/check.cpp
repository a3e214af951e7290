#include "tools/vobench/option_table.h"

namespace vobench {

void OptionTable::AddCheck() {
  CLI::App& command = AddCommand("check", "Read a scenario and all it names, and say what is wrong with it",
                                 "vobench check scenes/room.yaml");
  command.add_option("SCENARIO", check.scenario, "Scenario file (scenes/*.yaml)")->required();
  AddSet(command, "camera.width=320");
  command.callback([this] {
    check.overrides = ParsedOverrides();
    asked = check;
  });
}

}  // namespace vobench
