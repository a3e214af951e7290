#include "tools/vobench/option_table.h"

namespace vobench {

void OptionTable::AddExport() {
  CLI::App& command = AddCommand("export", "Write a sequence in another form: a ROS 1 bag (docs/sequence_format.md)",
                                 "vobench export room --bag room.bag");
  command.add_option("SEQ", exported.sequence, "Sequence folder")->required();
  command.add_option("--bag", exported.bag, "ROS 1 bag to make")->required()->type_name("FILE.bag");
  command.callback([this] { asked = exported; });
}

}  // namespace vobench
