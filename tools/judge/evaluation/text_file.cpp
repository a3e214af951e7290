#include "tools/judge/evaluation/text_file.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "tools/base/text.h"

namespace evaluation {
namespace {

// Splits into existing tokens, whose memory is reused for the next line. Blanks about a field are removed.
void Split(std::string_view line, char separator, std::vector<Token>& tokens) {
  std::size_t count = 0;
  const auto add = [&](std::string_view text, int column) {
    if (count == tokens.size()) tokens.emplace_back();
    tokens[count].text.assign(text);
    tokens[count++].column = column;
  };
  if (separator == ' ') {
    for (const base::Word& word : base::SplitWords(line)) add(word.text, word.column);
  } else {
    for (std::size_t begin = 0; begin <= line.size();) {
      const std::size_t end = std::min(line.find(separator, begin), line.size());
      const std::size_t first = std::min(line.find_first_not_of(" \t", begin), end);
      const std::size_t last = line.find_last_not_of(" \t", end == 0 ? 0 : end - 1);
      add(first == end ? std::string_view() : line.substr(first, last - first + 1), static_cast<int>(first) + 1);
      begin = end + 1;
    }
  }
  tokens.resize(count);
}

}  // namespace

InputError::InputError(const std::vector<std::string>& problems)
    : std::invalid_argument(base::JoinProblems(problems)) {}

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
    if (line_.number == 1) {
      if (const std::string problem = base::TextProblem(text_); !problem.empty())
        throw InputError({file_.string() + ": " + problem});
      text_ = base::WithoutMark(text_);
    }
    const std::size_t first = text_.find_first_not_of(" \t");
    if (first == std::string::npos) continue;
    if (separator_ != '\n' && base::IsComment(std::string_view(text_).substr(first))) continue;
    Split(text_, separator_, line_.tokens);
    if (!line_.tokens.empty()) return;
  }
  if (stream_.bad()) throw InputError({file_.string() + ": cannot be read"});
  at_end_ = true;
}

std::optional<double> ParseNumber(const std::string& text) {
  const std::optional<double> value = base::ParseNumber(base::WithoutPlus(text));
  return value && std::isfinite(*value) ? value : std::nullopt;
}

double NumberIn(const std::filesystem::path& file, int line, const Token& token, Problems& problems) {
  const auto value = ParseNumber(token.text);
  if (!value) problems.Add(file, line, token.column, "'" + token.text + "' is not a finite number");
  return value.value_or(0);
}

bool HasColumns(const std::filesystem::path& file, const Line& line, std::size_t count, Problems& problems) {
  if (line.tokens.size() == count) return true;
  problems.Add(file, line.number, 1,
               std::to_string(line.tokens.size()) + " columns where " + std::to_string(count) + " are expected");
  return false;
}

std::optional<std::int64_t> ParseRow(const std::filesystem::path& file, const Line& line, const char* columns,
                                     std::span<double> numbers, Problems& problems) {
  const auto bad = [&](const Token& token, const std::string& what) {
    problems.Add(file, line.number, token.column, what);
  };
  if (line.tokens.size() != numbers.size() + 1) {
    bad(line.tokens.front(), std::to_string(line.tokens.size()) + " columns where " +
                                 std::to_string(numbers.size() + 1) + " are expected (" + columns + ")");
    return std::nullopt;
  }
  bool good = true;
  const auto stamp = base::ParseSeconds(line.tokens[0].text);
  if (!stamp) {
    const std::string unit = base::UnitOfStamp(line.tokens[0].text);
    bad(line.tokens[0],
        "'" + line.tokens[0].text + "' is not a time in seconds" + (unit.empty() ? ", 4e9 at most" : unit));
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const Token& token = line.tokens[i + 1];
    const auto number = ParseNumber(token.text);
    if (!number) bad(token, "'" + token.text + "' is not a finite number");
    good = good && number;
    numbers[i] = number.value_or(0);
  }
  return good ? stamp : std::nullopt;
}

std::string FormatNumbers(std::span<const double> numbers, int digits) {
  std::string text;
  for (const double number : numbers) text += ' ' + base::Significant(number, digits);
  return text;
}

std::optional<std::int64_t> Nanoseconds(double seconds) {
  if (!(std::abs(seconds) <= kLongest_s)) return std::nullopt;
  return std::llround(seconds * 1e9);
}

double SecondsAsRead(std::int64_t stamp_ns) {
  constexpr std::int64_t kHasADouble = std::int64_t{1} << 53;  // and all below: the quotient is rounded once
  return std::abs(stamp_ns) <= kHasADouble ? static_cast<double>(stamp_ns) / 1e9
                                           : *ParseNumber(base::FormatSeconds(stamp_ns));
}

}  // namespace evaluation
