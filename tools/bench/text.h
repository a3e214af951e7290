// Numbers, names and tables as text, for reports and terminals.
#pragma once

#include <map>
#include <numbers>
#include <string>
#include <vector>

namespace vobench {

constexpr double kDegrees = 180 / std::numbers::pi;  // of a radian

// A fixed number of decimals; "–" for what is not a number.
std::string Fixed(double value, int decimals);

// Significant digits that suit a reader: "12.3", "0.0456", "1.2e+07"; "–" for what is not a number.
std::string Readable(double value);

// 0.987 as "98.7 %"; "–" for what is not a number.
std::string Percent(double share, int decimals = 1);

// Name of a system in text: "rb2pf" is RB²-PF. Unknown names are unchanged.
std::string DisplayName(const std::string& system);

// "1 run", "3 runs".
std::string Count(std::size_t n, const std::string& noun);

// As text inside HTML or an attribute.
std::string Escape(const std::string& text);

// Rows of as many cells each, for a terminal: the first column to the left, the others to the right. Each row ends with
// a line break.
std::string AlignedTable(const std::vector<std::vector<std::string>>& rows);

// With a text in the place of each of these characters.
std::string Replaced(const std::string& text, const std::map<char, const char*>& replacements);

// One word for sh.
std::string QuotedForShell(const std::string& text);

// A string of YAML: one of JSON.
std::string QuotedForYaml(const std::string& text);

std::string Base64(const std::string& bytes);

}  // namespace vobench
