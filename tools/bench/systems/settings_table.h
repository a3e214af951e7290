// Table of all settings, from the field tables of their structs: for help, documentation and Python.
#pragma once

#include <string>
#include <vector>

#include "tools/base/settings/fields.h"

namespace vobench {

// Keys as --set takes them; sections in the order of a scenario.
std::vector<settings::FieldRow> SettingsTable();

// docs/settings.md from its first heading of a section on.
std::string SettingsMarkdown();

}  // namespace vobench
