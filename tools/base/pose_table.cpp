#include "tools/base/pose_table.h"

#include <algorithm>
#include <cctype>

namespace base {
namespace {

// Columns of a pose alone, and of the tables of other programs. VINS: a velocity follows.
constexpr std::size_t kPose = 8, kColmap = 10, kKitti = 12, kMatrix = 16, kEuroc = 17, kOpenVins = 20;

bool IsLetter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

// The names of a header's columns in lower case, without units and quotes.
std::vector<std::string> Names(std::string_view line) {
  std::vector<std::string> names;
  for (const Word& word : SplitWords(line)) {
    std::string name(word.text.substr(0, word.text.find_first_of("[(")));
    std::erase_if(name, [](char c) { return !IsLetter(c) && !IsDigit(c) && c != '_' && c != '.'; });
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (!name.empty()) names.push_back(name);
  }
  return names;
}

// 0: the stamp, 1 ... 3: of the position, 4 ... 7: of the quaternion, x y z w; nothing: neither.
std::optional<std::size_t> RoleOf(const std::string& name) {
  const auto has = [&](std::string_view part) { return name.find(part) != std::string::npos; };
  if ((has("stamp") || has("time") || name == "t") && !name.ends_with("sec") && !name.ends_with("secs")) return 0;
  const std::size_t axis = std::string_view("xyzw").find(name.back());
  if (axis == std::string_view::npos || has("twist") || has("vel")) return std::nullopt;
  if (has("q") || has("orient") || has("rot")) return 4 + axis;
  const bool is_position = axis < 3 && (name.size() == 1 || name[0] == 't' || has("p"));
  return is_position ? std::optional(1 + axis) : std::nullopt;
}

// Problem of a file, by its first row; empty: none.
std::string OtherKind(std::string_view line, const std::vector<Word>& words, const std::string& stamp) {
  const std::string first(words[0].text);
  const std::size_t comma = line.find(',', 1);
  if (words.size() > kPose && IsDigit(first.back()) && comma + 1 < line.size() && IsDigit(line[comma - 1]) &&
      IsDigit(line[comma + 1]) && line.find_first_of("; \t") != std::string_view::npos)
    return "has decimal commas: write points";
  if (first.starts_with("VERTEX_")) return "is a graph of g2o, whose poses have no times: add them";
  if (words.size() == kKitti)
    return "twelve numbers a line are KITTI's poses, which have no times: add them, and quaternions";
  if (words.size() == kMatrix)
    return "sixteen numbers a line are matrices, which have no times: add them, and quaternions";
  if (words.size() == kColmap && !IsDigit(words.back().text.back()))
    return "is COLMAP's images.txt, whose poses have no times and map the world to the camera: convert it";
  if (const std::string unit = UnitOfStamp(stamp); !unit.empty() && words.size() >= kPose) {
    const bool may_be_csv = line.find(',') != std::string_view::npos;
    return "'" + first + "' is not a time in seconds" + unit +
           (may_be_csv ? "; where qw comes first (EuRoC, VINS) say so in a header, '#timestamp [ns],x,y,z,qw,qx,qy,qz'"
                       : "");
  }
  if (first.find(':') != std::string::npos) return "'" + first + "' is not a time in seconds";
  if (words.size() == kPose) return "";
  return std::to_string(words.size()) + " columns where 8 are expected (timestamp tx ty tz qx qy qz qw)";
}

}  // namespace

std::vector<Word> PoseTable::Row(std::string_view line, std::string& problem) {
  std::vector<Word> words = SplitWords(line.substr(0, line.find('\x1a')));  // which ends a text of DOS
  if (words.empty()) return {};
  const std::string_view first = words[0].text;
  const auto is_name = [](const Word& word) {
    return IsLetter(word.text[0]) || std::string_view("\"[(").find(word.text[0]) != std::string_view::npos;
  };
  const bool is_header = is_first_ && words.size() >= kPose && std::ranges::all_of(words, is_name) &&
                         std::ranges::none_of(words, [](const Word& word) { return word.text == "nan"; });
  if (IsComment(first) || is_header) {
    ReadHeader(line);
    return {};
  }
  if (is_first_ && words.size() == kEuroc) is_euroc_ = true;
  if (columns_ && words.size() == column_count_) {
    std::vector<Word> row;
    for (const std::size_t column : *columns_) row.push_back(words[column]);
    words = row;
  } else if (is_euroc_ && words.size() >= kPose) {
    words.resize(kPose);
    std::rotate(words.begin() + 4, words.begin() + 5, words.end());
  } else if (words.size() == kOpenVins) {
    words.resize(kPose);
  }
  if (is_first_) problem = OtherKind(line, words, Stamp(words[0]));
  is_first_ = false;
  return words;
}

std::string PoseTable::Stamp(const Word& word) const {
  return std::string(word.text) + (is_euroc_ && ParseWhole(word.text) ? "e-9" : "");
}

void PoseTable::ReadHeader(std::string_view line) {
  const std::vector<std::string> names = Names(line);
  std::array<std::optional<std::size_t>, kPose> found;
  bool has_stamp = false;  // instead of the time of its arrival
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::optional<std::size_t> role = RoleOf(names[i]);
    if (!role) continue;
    const bool is_stamp = *role == 0 && names[i].find("stamp") != std::string::npos;
    if (!found[*role] || (is_stamp && !has_stamp)) found[*role] = i;
    has_stamp = has_stamp || is_stamp;
  }
  if (std::ranges::any_of(found, [](const auto& column) { return !column; })) return;
  columns_.emplace();
  std::ranges::transform(found, columns_->begin(), [](const auto& column) { return *column; });
  column_count_ = names.size();
  // EuRoC's, and those of `rostopic echo -p`, count nanoseconds.
  for (const char* mark : {"[ns]", "q_RS_w", "%time"})
    is_euroc_ = is_euroc_ || line.find(mark) != std::string_view::npos;
}

}  // namespace base
