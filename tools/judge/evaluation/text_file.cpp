#include "tools/judge/evaluation/text_file.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>

namespace evaluation {
namespace {

constexpr std::size_t kMostProblems = 50;

std::string Join(const std::vector<std::string>& problems) {
  std::string text;
  for (std::size_t i = 0; i < std::min(problems.size(), kMostProblems); ++i) {
    if (i > 0) text += '\n';
    text += problems[i];
  }
  if (problems.size() > kMostProblems) {
    text += "\n... and " + std::to_string(problems.size() - kMostProblems) + " more problems";
  }
  return text;
}

// Into tokens that are there already, so that their memory serves the next line.
void Split(const std::string& line, char separator, std::vector<Token>& tokens) {
  const bool blanks = separator == ' ';
  std::size_t count = 0;
  for (std::size_t begin = 0;;) {
    if (blanks) begin = line.find_first_not_of(" \t", begin);
    if (begin == std::string::npos) break;
    std::size_t end = blanks ? line.find_first_of(" \t", begin) : line.find(separator, begin);
    if (end == std::string::npos) end = line.size();
    if (count == tokens.size()) tokens.emplace_back();
    tokens[count].text.assign(line, begin, end - begin);
    tokens[count].column = static_cast<int>(begin) + 1;
    ++count;
    if (end == line.size()) break;
    begin = end + 1;
  }
  tokens.resize(count);
}

}  // namespace

InputError::InputError(const std::vector<std::string>& problems) : std::invalid_argument(Join(problems)) {}

void Problems::Add(const std::filesystem::path& file, const std::string& message) {
  problems_.push_back(file.string() + ": " + message);
}

void Problems::Add(const std::filesystem::path& file, int line, int column, const std::string& message) {
  problems_.push_back(file.string() + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " + message);
}

void Problems::ThrowIfAny() const {
  if (!problems_.empty()) throw InputError(problems_);
}

Lines::Lines(const std::filesystem::path& file, char separator) : file_(file), separator_(separator) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) throw InputError({file.string() + ": is a folder, not a file"});
  stream_.open(file, std::ios::binary);
  if (!stream_) throw InputError({file.string() + ": cannot be opened"});
}

void Lines::Advance() {
  while (std::getline(stream_, text_)) {
    ++line_.number;
    if (!text_.empty() && text_.back() == '\r') text_.pop_back();
    const std::size_t first = text_.find_first_not_of(" \t");
    if (first == std::string::npos || text_[first] == '#') continue;
    Split(text_, separator_, line_.tokens);
    return;
  }
  if (stream_.bad()) throw InputError({file_.string() + ": cannot be read"});
  at_end_ = true;
}

Lines ReadLines(const std::filesystem::path& file, char separator) { return Lines(file, separator); }

std::optional<double> ParseNumber(const std::string& text) {
  double value{};
  const char *begin = text.c_str(), *const all = std::to_address(text.end());
  if (*begin == '+' && !text.starts_with("+-")) ++begin;  // from_chars knows no plus
  const auto [end, error] = std::from_chars(begin, all, value);
  if (error != std::errc() || end != all || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> ParseSeconds(const std::string& text) {
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
    const char *begin = text.c_str() + i + 1, *const all = std::to_address(text.end());
    if (*begin == '+') ++begin;
    int written{};
    const auto [end, error] = std::from_chars(begin, all, written);
    if (error != std::errc() || end != all || written > 100 || written < -100) return std::nullopt;
    exponent += written;
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

std::optional<std::int64_t> Nanoseconds(double seconds) {
  if (!(std::abs(seconds) <= kLongest_s)) return std::nullopt;
  return std::llround(seconds * 1e9);
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

double SecondsAsRead(std::int64_t stamp_ns) {
  constexpr std::int64_t kHasADouble = std::int64_t{1} << 53;  // and all below: the quotient is rounded once
  return std::abs(stamp_ns) <= kHasADouble ? static_cast<double>(stamp_ns) / 1e9
                                           : *ParseNumber(FormatSeconds(stamp_ns));
}

std::string FormatNumber(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

}  // namespace evaluation
