#include "tools/vobench/compat.h"
#include "tools/vobench/option_table.h"

namespace vobench {

void OptionTable::AddEvaluate() {
  CLI::App& command = AddCommand("evaluate", "Hold an estimated trajectory against the truth",
                                 "vobench evaluate out/xyz/estimate.txt --truth room --align sim3");
  command.add_option("ESTIMATE", evaluate.estimate, "Trajectory in TUM format, or a run folder")->required();
  command.add_option("--truth", evaluate.truth, "Trajectory in TUM format, or a sequence folder")
      ->required()
      ->type_name("SEQ|FILE");
  CLI::Option* align =
      command
          .add_option("--align", evaluate.align, "What the estimate may be moved by before: none, se3, sim3 or first")
          ->check(CLI::IsMember({"none", "se3", "sim3", "first"}))
          ->type_name("NAME")
          ->capture_default_str();
  command
      .add_option("--compat", compat,
                  "Print what another tool prints: tum, evo, rpg or ov, and its own options in the same quotes, such "
                  "as 'evo ape -as': docs/metrics.md")
      ->type_name("TOOL")
      ->excludes(align);
  command.callback([this] {
    if (!compat.empty()) evaluate.compat = ParseCompat(compat);
    asked = evaluate;
  });
}

}  // namespace vobench
