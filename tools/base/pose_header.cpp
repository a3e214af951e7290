#include "tools/base/pose_header.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <span>
#include <utility>

namespace base {
namespace {

constexpr const char* kNames[] = {"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"};
constexpr std::size_t kStamp = 0, kW = 7;

bool IsLetter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

bool HasAny(std::string_view text, std::initializer_list<std::string_view> parts) {
  return std::ranges::any_of(parts, [&](std::string_view part) { return text.find(part) != std::string_view::npos; });
}
bool EndsInAny(std::string_view text, std::initializer_list<std::string_view> parts) {
  return std::ranges::any_of(parts, [&](std::string_view part) { return text.ends_with(part); });
}

// In lower case, without units and signs; parts are separated by '_'.
std::string NameOf(std::string_view cell) {
  const std::size_t colon = cell.rfind(": ");
  if (colon != std::string_view::npos) cell.remove_prefix(colon + 2);
  std::string name;
  for (const char c : cell.substr(0, cell.find_first_of("[("))) {
    if (IsLetter(c) || IsDigit(c))
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  if (name.ends_with('_')) name.pop_back();
  return name.ends_with("_m") ? name.substr(0, name.size() - 2) : name;
}

// Of a name that ends in x, y, z or w: 1 ... 3 of the position, 4 ... 7 of the quaternion; nothing: neither.
std::optional<std::size_t> AxisOf(const std::string& name) {
  if (name == "i" || name == "j" || name == "k") return 4 + static_cast<std::size_t>(name[0] - 'i');
  const std::size_t axis = name.empty() ? std::string::npos : std::string_view("xyzw").find(name.back());
  if (axis == std::string::npos) return std::nullopt;
  std::string stem = name.substr(0, name.size() - 1);
  if (stem.ends_with('_')) stem.pop_back();
  const std::string last = stem.size() + 1 == name.size() ? stem.substr(stem.rfind('_') + 1) : "";  // qx, gt_qx
  static constexpr std::string_view kShort[] = {"", "t", "p", "q", "o", "pos", "rot", "quat", "trans", "loc"};
  if (std::ranges::find(kShort, last) == std::end(kShort)) return std::nullopt;
  if (HasAny(stem, {"twist", "vel", "speed", "acc", "gyr", "bias", "omega", "cov", "sigma", "std", "err"}))
    return std::nullopt;
  if (HasAny(stem, {"q", "orient", "rot"}) || last == "o" || (stem.empty() && axis == 3)) return 4 + axis;
  const bool is_position = axis < 3 && (stem.empty() || last == "t" || HasAny(stem, {"p", "trans", "loc"}));
  return is_position ? std::optional(1 + axis) : std::nullopt;
}

// The part below a second of a stamp in two columns.
bool IsNanoseconds(std::string_view name) { return EndsInAny(name, {"nsec", "nsecs", "nanosec"}); }

// Rank of a name as that of the stamps; 0: it is none. That of a message's header comes before the time of its arrival,
// and both before whole seconds.
int RankAsStamp(const std::string& name) {
  if (IsNanoseconds(name)) return 0;
  if (EndsInAny(name, {"sec", "secs", "seconds"})) return 1;
  return HasAny(name, {"stamp"}) ? 3 : name == "t" || HasAny(name, {"time"}) ? 2 : 0;
}

// Of the unit that a column's name states, in powers of ten; 0: none, or seconds.
int ExponentOf(std::string_view cell) {
  std::string text(cell);
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& [unit, exponent] : {std::pair{"n", -9}, {"u", -6}, {"m", -3}}) {
    const std::string s = std::string(unit) + "s";
    if (HasAny(text, {"[" + s + "]", "(" + s + ")"}) || EndsInAny(text, {"_" + s, "_" + s + "ec", "_" + s + "ecs"}))
      return exponent;
  }
  return 0;
}

struct Named {
  std::array<std::optional<std::size_t>, PoseHeader::kPose> columns;
  bool has_two_poses = false;
  bool is_complete() const {
    return std::ranges::all_of(columns, [](const auto& c) { return c.has_value(); });
  }
};

Named Assign(std::span<const std::string> names) {
  Named found;
  int rank = 0;
  const bool split_stamp = std::ranges::any_of(names, IsNanoseconds);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (const int r = RankAsStamp(names[i]); r > rank && !(r == 1 && split_stamp)) {
      found.columns[kStamp] = i;
      rank = r;
    } else if (const auto axis = AxisOf(names[i])) {
      found.has_two_poses = found.has_two_poses || found.columns[*axis];
      if (!found.columns[*axis]) found.columns[*axis] = i;
    }
  }
  return found;
}

}  // namespace

std::vector<Word> Cells(std::string_view line) {
  for (const char separator : {';', ','}) {
    if (std::ranges::count(line, separator) < static_cast<std::ptrdiff_t>(PoseHeader::kPose) - 1) continue;
    std::vector<Word> cells;
    bool has_words = false;  // numbers with decimal commas
    for (std::size_t begin = 0; begin <= line.size();) {
      const std::size_t end = std::min(line.find(separator, begin), line.size());
      std::string_view cell = line.substr(begin, end - begin);
      const std::size_t first = std::min(cell.find_first_not_of(" \t\r\"'"), cell.size());
      cell.remove_prefix(first);
      cell = cell.substr(0, cell.find_last_not_of(" \t\r\"'") + 1);
      cells.push_back({cell, static_cast<int>(begin + first) + 1});
      const std::size_t blank = cell.find_first_of(" \t");
      has_words = has_words || (blank != std::string_view::npos && IsDigit(cell[0]) && IsDigit(cell.back()));
      begin = end + 1;
    }
    if (has_words) continue;
    while (!cells.empty() && cells.back().text.empty()) cells.pop_back();
    return cells;
  }
  return SplitWords(line);
}

std::optional<PoseHeader> ReadPoseHeader(std::string_view line, std::string& problem) {
  const std::vector<Word> cells = Cells(line);
  const auto count = [&](char separator) { return std::ranges::count(line, separator) + 1; };
  const bool is_prose = std::max(count(','), count(';')) < static_cast<std::ptrdiff_t>(PoseHeader::kPose);
  std::vector<std::string> names;
  std::vector<int> exponents;
  for (const Word& cell : cells) {
    const std::string name = NameOf(cell.text);
    const int exponent = ExponentOf(cell.text);
    if (is_prose && name.empty()) {  // "#"; "[ns]" of the name before it
      if (!exponents.empty() && exponent != 0) exponents.back() = exponent;
      continue;
    }
    names.push_back(name);
    exponents.push_back(exponent);
  }
  Named found = Assign(names);
  PoseHeader header{{}, names.size(), false, 0};
  for (std::size_t first = 0; is_prose && first + PoseHeader::kPose <= names.size(); ++first) {
    const Named run = Assign(std::span(names).subspan(first, PoseHeader::kPose));
    if (!run.is_complete()) continue;
    header.is_prose = true;
    found = run;
    for (auto& column : found.columns) *column += first;
    break;
  }
  if (!found.is_complete() || found.has_two_poses) {
    const auto has = [&](std::size_t i) { return found.columns[i].has_value(); };
    const bool has_w = has(kW) || std::ranges::find(names, "q0") != names.end();
    std::string missing;
    for (std::size_t i = 0; i < PoseHeader::kPose; ++i)
      if (!has(i)) missing += (missing.empty() ? "" : ", ") + std::string(kNames[i]);
    const std::string all = ": name the columns timestamp tx ty tz qx qy qz qw, in their order";
    if (found.is_complete())
      problem = "the header names two poses a line: keep one";
    else if (has_w && has(1) && has(2) && has(3))
      problem = "the header names no column for " + missing + all;
    return std::nullopt;
  }
  std::ranges::transform(found.columns, header.columns.begin(), [](const auto& column) { return *column; });
  header.exponent = exponents[header.columns[kStamp]];
  if (HasAny(line, {"field.", "q_RS_w"})) header.exponent = -9;  // `rostopic echo -p`, EuRoC
  return header;
}

}  // namespace base
