// Text conversions: lists, numbers, time stamps.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace base {

std::string Join(const std::vector<std::string>& parts, std::string_view separator);

// The first 50 problems of a file, one a line, and the number of the others.
std::string JoinProblems(std::vector<std::string> problems);

// A part of a line, and where it begins (1: the first character).
struct Word {
  std::string_view text;
  int column = 1;
};
// Of a line of numbers or names, as programs write tables: separated by blanks, tabs, commas or semicolons.
std::vector<Word> SplitWords(std::string_view line);

// Text without UTF-8's byte-order mark at its beginning, which editors on Windows write.
inline std::string_view WithoutMark(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

// Why the beginning of a file is not text in readable lines (UTF-16, other bytes than text's, lines that end in CR
// alone); empty: it is text.
std::string TextProblem(std::string_view head);
// A line that holds no data: '#', '%' or '//' begin it.
inline bool IsComment(std::string_view first_word) {
  return first_word.starts_with('#') || first_word.starts_with('%') || first_word.starts_with("//");
}

// "%.*f": a fixed number of decimals.
std::string Fixed(double value, int decimals);
// "%.*g": a number of significant digits, without trailing zeros.
std::string Significant(double value, int digits);

// Without its plus sign, which the parsers do not take.
inline std::string_view WithoutPlus(std::string_view number) {
  return number.starts_with('+') && !number.starts_with("+-") ? number.substr(1) : number;
}
// A decimal integer, or number ("inf" and "nan" are some, "1e999" is none), that is all of the text. No plus sign.
std::optional<std::int64_t> ParseWhole(std::string_view text);
std::optional<double> ParseNumber(std::string_view text);

// Bound on a stamp's distance from zero: sums and differences of two stamps fit into 64 bits.
constexpr std::int64_t kLatest_ns = 4'000'000'000'000'000'000;

// Decimal seconds to nanoseconds, exact: not by way of a double, a tenth decimal is rounded. Signs and exponents are
// accepted. None for other text and beyond kLatest_ns.
std::optional<std::int64_t> ParseSeconds(std::string_view text);
// Whether a number beyond kLatest_ns counts milli-, micro- or nanoseconds, in words that follow "is not a time in
// seconds"; empty for other text.
std::string UnitOfStamp(std::string_view text);

// Nanoseconds as seconds with nine decimals.
std::string FormatSeconds(std::int64_t stamp_ns);

}  // namespace base
