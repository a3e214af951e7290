// Man page or bash completion on stdout: vobench_manual man|bash. Part of the build.
#include <cstdio>
#include <string>

#include "tools/vobench/help_text.h"
#include "tools/vobench/option_table.h"

int main(int argc, char** argv) {
  const vobench::OptionTable table;
  const std::string kind = argc == 2 ? argv[1] : "";
  std::string text;
  if (kind == "man") text = vobench::ManPage(table.app, VOBENCH_VERSION);
  if (kind == "bash") text = vobench::BashCompletion(table.app);
  if (text.empty()) {
    std::fputs("usage: vobench_manual man|bash\n", stderr);
    return 2;
  }
  return std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0 ? 0 : 1;
}
