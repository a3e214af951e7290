#include "tools/base/text.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <system_error>

namespace base {
namespace {

std::string Printed(const char* format, int precision, double value) {
  char text[352];  // the longest double has 309 digits before the point
  std::snprintf(text, sizeof text, format, precision, value);
  return text;
}

template <class T>
std::optional<T> Parsed(std::string_view text) {
  T value{};
  const char* const all = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), all, value);
  return error == std::errc() && end == all ? std::optional(value) : std::nullopt;
}

}  // namespace

std::string Join(const std::vector<std::string>& parts, std::string_view separator) {
  std::string text;
  for (const std::string& part : parts) {
    if (&part != &parts.front()) text += separator;
    text += part;
  }
  return text;
}

std::string JoinProblems(std::vector<std::string> problems) {
  constexpr std::size_t kMost = 50;
  if (problems.size() > kMost) {
    problems[kMost] = "... and " + std::to_string(problems.size() - kMost) + " more problems";
    problems.resize(kMost + 1);
  }
  return Join(problems, "\n");
}

std::vector<Word> SplitWords(std::string_view line) {
  constexpr std::string_view kBetween = " \t\r,;";
  std::vector<Word> words;
  for (std::size_t at = line.find_first_not_of(kBetween); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBetween, at), line.size());
    words.push_back({line.substr(at, end - at), static_cast<int>(at) + 1});
    at = line.find_first_not_of(kBetween, end);
  }
  return words;
}

std::string TextProblem(std::string_view head) {
  if (head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff")) return "is a text in UTF-16: save it in UTF-8";
  const auto is_control = [](char c) {
    return static_cast<unsigned char>(c) < ' ' && c != '\x1a' && !(c >= '\t' && c <= '\r');
  };
  if (std::ranges::any_of(head, is_control)) return "is no text: it has bytes that no text has";
  const std::size_t end = head.find('\r');
  const bool is_mac = end < head.size() - 1 && head[end + 1] != '\n' && head.find('\n') == std::string_view::npos;
  return is_mac ? "has lines that end in CR alone: save it with LF" : "";
}

std::string Fixed(double value, int decimals) { return Printed("%.*f", decimals, value); }

std::string Significant(double value, int digits) { return Printed("%.*g", digits, value); }

std::optional<std::int64_t> ParseWhole(std::string_view text) { return Parsed<std::int64_t>(text); }

std::optional<double> ParseNumber(std::string_view text) { return Parsed<double>(text); }

std::optional<std::int64_t> ParseSeconds(std::string_view text) {
  std::size_t i = 0;
  const bool negative = !text.empty() && text[0] == '-';
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) ++i;
  std::string digits;
  int exponent = 0;  // of the number that the digits make, in powers of ten
  bool point = false, any = false;
  for (; i < text.size(); ++i) {
    if (text[i] == '.' && !point) {
      point = true;
    } else if (text[i] >= '0' && text[i] <= '9') {
      any = true;
      if (!digits.empty() || text[i] != '0') digits += text[i];
      if (point) --exponent;
    } else {
      break;
    }
  }
  if (!any) return std::nullopt;
  if (i < text.size()) {
    if (text[i] != 'e' && text[i] != 'E') return std::nullopt;
    text.remove_prefix(i + 1);
    if (text.starts_with('+')) text.remove_prefix(1);
    const std::optional<std::int64_t> written = ParseWhole(text);
    if (!written || *written > 100 || *written < -100) return std::nullopt;
    exponent += static_cast<int>(*written);
  }
  const int shift = exponent + 9;  // to nanoseconds
  const int whole = static_cast<int>(digits.size()) + shift;
  if (digits.empty() || whole < 0) return 0;
  if (whole > 19) return std::nullopt;
  std::uint64_t value = 0;  // 19 digits fit
  for (int k = 0; k < whole; ++k) {
    const std::size_t at = static_cast<std::size_t>(k);
    value = value * 10 + static_cast<std::uint64_t>(at < digits.size() ? digits[at] - '0' : 0);
  }
  if (whole < static_cast<int>(digits.size()) && digits[static_cast<std::size_t>(whole)] >= '5') ++value;
  if (value > static_cast<std::uint64_t>(kLatest_ns)) return std::nullopt;
  return negative ? -static_cast<std::int64_t>(value) : static_cast<std::int64_t>(value);
}

std::string UnitOfStamp(std::string_view text) {
  const double value = ParseNumber(text).value_or(0);
  if (!(value > 1e-9 * kLatest_ns)) return "";
  constexpr double kMilliseconds = 1e11, kMicroseconds = 1e14, kNanoseconds = 1e17;  // of the years from 1973 on
  if (value < kMilliseconds) return ", 4e9 at most";
  const bool nano = value >= kNanoseconds, micro = value >= kMicroseconds;
  return std::string(", but looks like one in ") +
         (nano    ? "nano"
          : micro ? "micro"
                  : "milli") +
         "seconds: divide the times by " +
         (nano    ? "1e9"
          : micro ? "1e6"
                  : "1e3");
}

std::string FormatSeconds(std::int64_t stamp_ns) {
  const bool negative = stamp_ns < 0;
  const auto bits = static_cast<std::uint64_t>(stamp_ns), magnitude = negative ? ~bits + 1 : bits;
  char text[40];
  std::snprintf(text, sizeof text, "%s%llu.%09llu", negative ? "-" : "",
                static_cast<unsigned long long>(magnitude / 1'000'000'000u),
                static_cast<unsigned long long>(magnitude % 1'000'000'000u));
  return text;
}

}  // namespace base
