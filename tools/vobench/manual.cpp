#include "tools/vobench/manual.h"

#include "tools/vobench/help_text.h"

namespace vobench {
namespace {

// So that nothing in it is taken for a request of roff's.
std::string Roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return !out.empty() && (out.front() == '.' || out.front() == '\'') ? "\\&" + out : out;
}

}  // namespace

std::string ManPage(const CLI::App& app, const std::string& version) {
  std::string page = ".TH VOBENCH 1 \"\" \"vobench " + version + "\" \"User Commands\"\n.SH NAME\n";
  const std::string description = app.get_description();
  page += "vobench \\- " + Roff(description.substr(description.find(": ") + 2)) + "\n.SH SYNOPSIS\n.B " +
          Roff(Usage(app)) + "\n";
  page +=
      ".SH DESCRIPTION\nA scenario is rendered into a sequence with exact truth, an odometry runs on the sequence, and "
      "a judge that knows both says "
      "how accurate and how consistent the odometry is.\n.SH COMMANDS\n";
  for (const CLI::App* command : CommandsOf(app)) {
    page += ".SS " + Roff(Usage(*command)) + "\n" + Roff(command->get_description()) + ".\n";
    for (const OptionRow& row : RowsOf(*command)) {
      if (row.names.front() == "-h") continue;
      page += ".TP\n.B " + Roff(row.Synopsis()) + "\n" + Roff(row.text) + "\n";
    }
    const std::string example = command->get_footer();
    page += ".PP\nExample:\n.PP\n.RS\n.nf\n" + Roff(example.substr(example.find(": ") + 2)) + "\n.fi\n.RE\n";
  }
  page += ".SH OPTIONS\n";
  for (const OptionRow& row : RowsOf(app)) page += ".TP\n.B " + Roff(row.Synopsis()) + "\n" + Roff(row.text) + "\n";
  const std::string footer = app.get_footer();
  const std::string status = footer.substr(footer.find("Exit status: ") + 13);
  return page + ".SH EXIT STATUS\n" + Roff(status) +
         "\n.SH FILES\n.TP\n.B /usr/share/vobench/scenes\nScenarios, meshes and textures\n";
}

}  // namespace vobench
