#include "tools/vobench/option_table.h"

namespace vobench {

void OptionTable::AddReport() {
  CLI::App& command = AddCommand("report", "Make report.html anew from a result folder", "vobench report out/room");
  command.add_option("OUT", report.output, "Result folder")->required();
  command.callback([this] { asked = report; });
}

}  // namespace vobench
