// Strict reader of text tables, and number formatting. All problems of a file are reported at once, with file, line,
// column and the text found there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace evaluation {

// Invalid input. what() has one problem per line; beyond the first 50 they are counted.
class InputError : public std::invalid_argument {
 public:
  explicit InputError(const std::vector<std::string>& problems);
};

// Collects problems; ThrowIfAny throws InputError with all of them.
class Problems {
 public:
  void Add(const std::filesystem::path& file, const std::string& message);
  void Add(const std::filesystem::path& file, int line, int column, const std::string& message);
  void ThrowIfAny() const;

 private:
  std::vector<std::string> problems_;
};

struct Token {
  std::string text;
  int column = 1;
};

struct Line {
  int number = 1;
  std::vector<Token> tokens;
};

// The lines of a file that carry data: no empty ones, none of separators alone, none that starts with '#'. Read one at
// a time, once:
//   for (const Line& line : Lines(file)) ...
// A line is valid until the next one is read.
class Lines {
 public:
  class Iterator {
   public:
    explicit Iterator(Lines* lines) : lines_(lines) {}
    const Line& operator*() const { return lines_->line_; }
    Iterator& operator++() {
      lines_->Advance();
      return *this;
    }
    bool operator==(std::default_sentinel_t) const { return lines_->at_end_; }

   private:
    Lines* lines_;
  };

  // separator ' ' stands for any run of spaces, tabs, commas and semicolons; with any other, fields may be empty, and
  // blanks about them are left out. '\n': each line is one token, comments too. Throws InputError when the file cannot
  // be read, as begin and ++ do.
  explicit Lines(const std::filesystem::path& file, char separator = ' ');

  Iterator begin() {
    Advance();
    return Iterator(this);
  }
  static std::default_sentinel_t end() { return std::default_sentinel; }

 private:
  void Advance();

  std::filesystem::path file_;
  char separator_;
  std::ifstream stream_;
  std::string text_;
  Line line_{0, {}};
  bool at_end_ = false;
};

// The whole text as a finite number; none for any other text ("nan", "1.2x", "").
std::optional<double> ParseNumber(const std::string& text);
// The number of a token; 0, with a problem noted, for any other text.
double NumberIn(const std::filesystem::path& file, int line, const Token& token, Problems& problems);
// Whether a line has `count` columns; a problem is noted when not.
bool HasColumns(const std::filesystem::path& file, const Line& line, std::size_t count, Problems& problems);

// The stamp of a line `timestamp numbers`, and its numbers; none, with the problems noted, when any is invalid.
// columns: their names.
std::optional<std::int64_t> ParseRow(const std::filesystem::path& file, const Line& line, const char* columns,
                                     std::span<double> numbers, Problems& problems);

// Each number after a space, to `digits` significant digits.
std::string FormatNumbers(std::span<const double> numbers, int digits = 12);

// Bound on a time added to a stamp (a gap, an offset, a delta) [s].
constexpr double kLongest_s = 1e9;

// A time added to a stamp, in nanoseconds. None beyond kLongest_s, and for NaN.
std::optional<std::int64_t> Nanoseconds(double seconds);

// The double that the reference tools read a stamp as. At 1.3e9 s a double resolves 0.24 us, which decides between two
// equally near stamps; used to decide as those tools do.
double SecondsAsRead(std::int64_t stamp_ns);

}  // namespace evaluation
