#include "tools/base/pose_table.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>

namespace base {
namespace {

// Columns of a pose alone, and of the tables of other programs. VINS: a velocity follows.
constexpr std::size_t kPose = PoseHeader::kPose, kColmap = 10, kKitti = 12, kMatrix = 16, kEuroc = 17, kOpenVins = 20;

constexpr const char* kOfColmap =
    "is COLMAP's images.txt, whose poses have no times and map the world to the camera: convert it";

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool IsNumber(const Word& word) { return ParseNumber(WithoutPlus(word.text)).has_value(); }

bool HasDecimalComma(std::string_view text) {
  for (std::size_t i = 1; i + 1 < text.size(); ++i)
    if (text[i] == ',' && IsDigit(text[i - 1]) && IsDigit(text[i + 1])) return true;
  return false;
}

// Kind of a file that holds no table of poses, by the beginning of a line; empty: it may be one.
std::string KindOf(std::string_view line) {
  const std::pair<std::string_view, const char*> kinds[] = {
      {"#ROSBAG", "is a ROS bag: export its poses as a table"},
      {"version https://git-lfs", "is a pointer of Git LFS, not the file: fetch it with `git lfs pull`"},
      {"VERTEX_", "is a graph of g2o, whose poses have no times: add them"},
      {"Format Version,",
       "is Motive's export (OptiTrack), whose header is several lines: write one in their place, such as "
       "frame,timestamp,qx,qy,qz,qw,tx,ty,tz, and positions in metres"},
      {"{", "is JSON: write its poses as a table"},
      {"<", "is XML or HTML: write its poses as a table"}};
  for (const auto& [begin, kind] : kinds)
    if (line.starts_with(begin)) return kind;
  return line.starts_with('#') && line.find("IMAGE_ID") != std::string_view::npos ? kOfColmap : "";
}

// Problem of a file, by its first row; empty: none.
std::string OtherKind(std::string_view line, const std::vector<Word>& words, const std::string& stamp) {
  const std::string first(words[0].text);
  const bool has_blanks = line.find_first_of("; \t") != std::string_view::npos;
  const bool is_decimal = std::ranges::any_of(words, [](const Word& word) { return HasDecimalComma(word.text); }) ||
                          (words.size() > kPose && has_blanks && HasDecimalComma(line));
  if (is_decimal) return "has decimal commas: write points";
  if (const std::string kind = KindOf(line); !kind.empty()) return kind;
  const bool are_numbers = std::ranges::all_of(words, IsNumber);
  if (words.size() == kKitti && are_numbers)
    return "twelve numbers a line are KITTI's poses, which have no times: add them, and quaternions";
  if (words.size() == kMatrix && are_numbers)
    return "sixteen numbers a line are matrices: write a time and a quaternion (timestamp tx ty tz qx qy qz qw)";
  const std::string_view last = words.back().text;
  if (words.size() == kColmap && !IsDigit(last.back()) && last.find('.') != std::string_view::npos) return kOfColmap;
  if (const std::string unit = UnitOfStamp(stamp); !unit.empty() && words.size() >= kPose) {
    const bool may_be_csv = line.find(',') != std::string_view::npos;
    return "'" + first + "' is not a time in seconds" + unit +
           (may_be_csv ? "; where qw comes first (EuRoC, VINS) say so in a header, '#timestamp [ns],x,y,z,qw,qx,qy,qz'"
                       : "");
  }
  if (first.find(':') != std::string::npos) return "'" + first + "' is not a time in seconds";
  if (words.size() == kPose) return "";
  return std::to_string(words.size()) + (words.size() == 1 ? " column" : " columns") +
         " where 8 are expected (timestamp tx ty tz qx qy qz qw)";
}

}  // namespace

std::vector<Word> PoseTable::Row(std::string_view line, std::string& problem) {
  line = line.substr(0, line.find('\x1a'));  // which ends a text of DOS
  std::vector<Word> words = Cells(line);
  if (words.empty()) return {};
  const auto begins_a_number = [](const Word& word) {
    return IsNumber(word) || (!word.text.empty() && IsDigit(word.text[0]));
  };
  const bool is_comment = IsComment(words[0].text), is_prose = line.find_first_of(",;") == std::string_view::npos;
  const bool is_header =
      is_first_ && words.size() >= kPose && !(is_comment && is_prose) && std::ranges::none_of(words, begins_a_number);
  if (is_comment || is_header) {
    if (is_first_) problem = KindOf(line);
    if (is_first_ && problem.empty() && !header_) header_ = ReadPoseHeader(line, problem);
    if (is_header && !header_ && problem.empty())
      problem = "the header names no columns of a pose: name them timestamp tx ty tz qx qy qz qw, in their order";
    if (is_first_ && problem.empty() && StatesInverse(line))
      problem = "a comment says that poses map the world to the camera: invert them";
    w_is_first_ = w_is_first_ || StatesRealPartFirst(line);
    return {};
  }
  // EuRoC's table without its header: its stamps are whole numbers.
  if (is_first_ && !header_ && words.size() == kEuroc && ParseWhole(words[0].text)) is_euroc_ = true;
  if (is_first_ && !header_ && w_is_first_)
    problem = "a comment says that w comes first: name the columns (# timestamp tx ty tz qw qx qy qz)";
  const auto is_last_row = [](const auto& row) {
    constexpr std::array kLast = {0.0, 0.0, 0.0, 1.0};
    return std::ranges::equal(row, kLast, {}, [](const Word& word) { return ParseNumber(word.text); });
  };
  if (is_first_ && !header_ && words.size() == kMatrix + 1 && is_last_row(std::span(words).last(4)))
    problem = "seventeen numbers a line are times and matrices: write a quaternion (timestamp tx ty tz qx qy qz qw)";
  words = InOrder(std::move(words), problem);
  if (is_first_ && problem.empty()) problem = OtherKind(line, words, Stamp(words[0]));
  constexpr std::int64_t kLongest_ns = 1'000'000'000'000;
  const std::optional<std::int64_t> stamp_ns = ParseSeconds(Stamp(words[0]));
  if (first_ns_ && stamp_ns && problem.empty() && *stamp_ns - *first_ns_ > kLongest_ns && ParseWhole(Stamp(words[0])))
    problem = "time " + Stamp(words[0]) + " is more than 1000 s after the first: write seconds, or name the unit (" +
              "timestamp_ns)";
  first_ns_ = is_first_ ? stamp_ns : std::nullopt;
  is_first_ = false;
  return words;
}

std::vector<Word> PoseTable::InOrder(std::vector<Word> words, std::string& problem) {
  if (header_) {
    const std::array<std::size_t, kPose>& columns = header_->columns;
    const bool is_run = header_->is_prose && words.size() != header_->count;
    // In prose the pose's names end the line, or other words follow them.
    const std::size_t pose = std::ranges::min(columns),
                      others = header_->count - std::min(header_->count, words.size());
    const std::size_t first = !is_run ? 0 : others > 0 && others <= pose ? others : pose;
    const std::size_t last = std::max(std::ranges::max(columns), header_->fraction.value_or(0));
    const bool is_long = !is_run && header_->count > kPose && words.size() > header_->count;
    if (is_long || words.size() <= last - first) {
      if (is_long || is_first_ || words.size() == kPose)  // which would be taken for a pose
        problem = "the header names " + std::to_string(header_->count) + " columns, and this row has " +
                  std::to_string(words.size());
      return words;
    }
    std::vector<Word> row;
    for (const std::size_t column : columns) row.push_back(words[column - first]);
    if (header_->fraction) fraction_ = words[*header_->fraction].text;
    return row;
  }
  if (is_euroc_ && words.size() >= kPose) {
    words.resize(kPose);
    std::rotate(words.begin() + 4, words.begin() + 5, words.end());
  } else if (words.size() == kOpenVins) {
    words.resize(kPose);
  }
  return words;
}

std::string PoseTable::Stamp(const Word& word) const {
  const std::string text(word.text);
  if (header_ && header_->fraction) {
    const std::size_t digits = header_->fraction_digits;
    return text + "." + std::string(digits - std::min(digits, fraction_.size()), '0') + fraction_;
  }
  const int exponent = header_ && header_->exponent != 0 ? header_->exponent : is_euroc_ && ParseWhole(text) ? -9 : 0;
  if (exponent == 0) return text;
  const std::size_t e = std::min(text.find_first_of("eE"), text.size());
  // A header may keep EuRoC's unit where the stamps are seconds.
  if (exponent == -9 && e == text.size() && !ParseWhole(text) && UnitOfStamp(text).empty()) return text;
  const std::size_t digits = std::min(text.find_first_not_of("eE+", e), text.size());
  const std::int64_t own = ParseWhole(std::string_view(text).substr(digits)).value_or(0);
  return text.substr(0, e) + "e" + std::to_string(own + exponent);
}

}  // namespace base
