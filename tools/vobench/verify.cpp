#include "tools/vobench/option_table.h"

namespace vobench {

void OptionTable::AddVerify() {
  CLI::App& command =
      AddCommand("verify", "Hold the streams of a sequence against each other: poses, depth, flow, IMU, pictures",
                 "vobench verify room");
  command.add_option("SEQ", verify.sequence, "Sequence folder")->required();
  command.callback([this] { asked = verify; });
}

}  // namespace vobench
