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
  const std::size_t index = cell.find('[') + 1;  // q[0] of PX4
  if (index > 0 && index < cell.size() && IsDigit(cell[index])) name += cell[index];
  if (name.ends_with("_m")) name.resize(name.size() - 2);
  for (const auto& [other, ours] : {std::pair{"qr", "qw"}, {"qs", "qw"}, {"qi", "qx"}, {"qj", "qy"}, {"qk", "qz"}})
    if (name == other) return ours;
  return name;
}

// "pose(x y z)" as "pose_x pose_y pose_z": axes in brackets are names of columns.
std::string WithNamedAxes(std::string_view line) {
  constexpr std::string_view kSeparators = " ,;";
  std::string out;
  for (std::size_t at = 0; at < line.size(); ++at) {
    const std::size_t end = line.find(')', at);
    const std::string_view inner =
        line[at] == '(' && end != std::string_view::npos ? line.substr(at + 1, end - at - 1) : "";
    std::size_t axes = 0;
    bool is_list = true;
    for (std::size_t i = 0; i < inner.size() && is_list; ++i) {
      const bool is_axis = inner[i] >= 'w' && inner[i] <= 'z';
      axes += is_axis;
      is_list = kSeparators.find(inner[i]) != std::string_view::npos ||
                (is_axis && (i == 0 || kSeparators.find(inner[i - 1]) != std::string_view::npos));
    }
    if (!is_list || axes < 3) {
      out += line[at];
      continue;
    }
    out.erase(out.find_last_not_of(' ') + 1);
    std::size_t begin = out.size();
    while (begin > 0 && (IsLetter(out[begin - 1]) || IsDigit(out[begin - 1]) || out[begin - 1] == '_')) --begin;
    const std::string name = out.substr(begin);
    out.erase(begin);
    for (const char c : inner) out += c >= 'w' && c <= 'z' ? name + '_' + c : std::string(1, c);
    at = end;
  }
  return out;
}

bool IsOfMotion(std::string_view stem) {
  return HasAny(stem, {"twist", "vel", "speed", "acc", "gyr", "bias", "omega", "cov", "sigma", "std", "err"});
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
  if (IsOfMotion(stem)) return std::nullopt;
  if (HasAny(stem, {"q", "orient", "rot"}) || last == "o" || (stem.empty() && axis == 3)) return 4 + axis;
  const bool is_position = axis < 3 && (stem.empty() || last == "t" || HasAny(stem, {"p", "trans", "loc"}));
  return is_position ? std::optional(1 + axis) : std::nullopt;
}

// Digits of a part below a second, as a stamp in two columns has it; 0: it is none.
std::size_t FractionDigits(std::string_view name) {
  return EndsInAny(name, {"nsec", "nsecs", "nanosec"})    ? 9
         : EndsInAny(name, {"usec", "usecs", "microsec"}) ? 6
         : EndsInAny(name, {"msec", "msecs", "millisec"}) ? 3
                                                          : 0;
}

bool IsSeconds(std::string_view name) { return EndsInAny(name, {"sec", "secs", "seconds"}); }

// Rank of a name as that of the stamps; 0: it is none. That of a message's header comes before the time of its arrival,
// and both before whole seconds. is_split: the part below a second has a column.
int RankAsStamp(const std::string& name, bool is_split) {
  if (FractionDigits(name) == 9 || (is_split && FractionDigits(name) > 0)) return 0;
  if (IsSeconds(name) && !(is_split && HasAny(name, {"stamp"}))) return 1;
  return HasAny(name, {"stamp"}) ? 3 : name == "t" || HasAny(name, {"time"}) ? 2 : 0;
}

// Of the unit that a column's name states last, in powers of ten; 0: none, or seconds.
int ExponentOf(std::string_view cell) {
  std::string word;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const bool is_mu = cell.substr(i).starts_with("\xc2\xb5") || cell.substr(i).starts_with("\xce\xbc");
    if (!is_mu && !IsLetter(cell[i])) continue;
    if (i == 0 || !(IsLetter(cell[i - 1]) || word == "u")) word.clear();
    word += is_mu ? 'u' : static_cast<char>(std::tolower(static_cast<unsigned char>(cell[i])));
    i += is_mu;
  }
  for (const auto& [prefix, exponent] :
       {std::pair{"nano", -9}, {"n", -9}, {"micro", -6}, {"u", -6}, {"milli", -3}, {"m", -3}})
    for (const char* second : {"s", "sec", "secs", "second", "seconds"})
      if (word == std::string(prefix) + second) return exponent;
  return 0;
}

struct Named {
  std::array<std::optional<std::size_t>, PoseHeader::kPose> columns;
  std::optional<std::size_t> fraction = {};
  bool has_two_poses = false;
  bool is_complete() const {
    return std::ranges::all_of(columns, [](const auto& c) { return c.has_value(); });
  }
};

// What precedes x, y, z and, `with_w` or not, w in four or three of the names.
std::vector<std::string> StemsOf(std::span<const std::string> names, bool with_w) {
  const auto has = [&](const std::string& name) { return std::ranges::find(names, name) != names.end(); };
  std::vector<std::string> stems;
  for (const std::string& name : names) {
    if (!name.ends_with('x')) continue;
    const std::string stem = name.substr(0, name.size() - 1);
    if (!stem.empty() && !IsOfMotion(stem) && has(stem + 'y') && has(stem + 'z') && has(stem + 'w') == with_w)
      stems.push_back(stem);
  }
  return stems;
}

Named Assign(std::span<const std::string> names) {
  Named found;
  int rank = 0;
  const std::vector<std::string> quaternions = StemsOf(names, true);
  const auto axis_of = [&](const std::string& name) {
    for (const std::string& stem : quaternions)
      if (name.size() == stem.size() + 1 && name.starts_with(stem) && name.back() >= 'w' && name.back() <= 'z')
        return std::optional(name.back() == 'w' ? kW : 4 + static_cast<std::size_t>(name.back() - 'x'));
    return AxisOf(name);
  };
  const bool has_seconds =
      std::ranges::any_of(names, [](const auto& name) { return IsSeconds(name) && FractionDigits(name) == 0; });
  const auto below = std::ranges::find_if(
      names, [&](const auto& name) { return FractionDigits(name) == 9 || (has_seconds && FractionDigits(name) > 0); });
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (const int r = RankAsStamp(names[i], below != names.end()); r > rank) {
      found.columns[kStamp] = i;
      rank = r;
    } else if (const auto axis = axis_of(names[i])) {
      found.has_two_poses = found.has_two_poses || found.columns[*axis];
      if (!found.columns[*axis]) found.columns[*axis] = i;
    }
  }
  if (below != names.end() && found.columns[kStamp] && IsSeconds(names[*found.columns[kStamp]]))
    found.fraction = static_cast<std::size_t>(below - names.begin());
  if (found.columns[1] || found.columns[2] || found.columns[3]) return found;
  if (const std::vector<std::string> others = StemsOf(names, false); others.size() == 1) {  // such as cam_x
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto at = std::ranges::find(names, others[0] + static_cast<char>('x' + axis));
      found.columns[1 + axis] = static_cast<std::size_t>(at - names.begin());
    }
  }
  return found;
}

std::string Lower(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

// Unit of positions that is not the metre; empty: none.
std::string UnitOfLength(const std::string& line) {
  for (const std::string unit : {"mm", "cm", "dm", "km"})
    if (HasAny(line, {"[" + unit + "]", "(" + unit + ")"})) return unit;
  return "";
}

}  // namespace

bool StatesRealPartFirst(std::string_view comment) {
  return HasAny(Lower(comment), {"wxyz", "w x y z", "w, x, y, z", "qw qx", "qw, qx", "scalar first", "scalar-first"});
}

bool StatesInverse(std::string_view comment) {
  const std::string text = Lower(comment);
  return HasAny(text, {"world to cam", "world-to-cam", "world_to_cam", "world2cam", "t_cw"}) &&
         !HasAny(text, {"to world", "to-world", "to_world", "2world", "inverse of"});
}

std::vector<Word> Cells(std::string_view line) {
  for (const char separator : {';', ','}) {
    if (std::ranges::count(line, separator) < static_cast<std::ptrdiff_t>(PoseHeader::kPose) - 1) continue;
    std::vector<Word> cells;
    bool has_words = false;  // numbers with decimal commas
    for (std::size_t begin = 0; begin <= line.size();) {
      std::size_t end = begin;
      for (bool is_quoted = false; end < line.size() && (is_quoted || line[end] != separator); ++end)
        is_quoted = is_quoted != (line[end] == '"');
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

std::optional<PoseHeader> ReadPoseHeader(std::string_view written, std::string& problem) {
  const std::string line = WithNamedAxes(written);
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
  PoseHeader header{{}, names.size(), false, 0, found.fraction};
  if (header.fraction) header.fraction_digits = FractionDigits(names[*header.fraction]);
  for (std::size_t first = 0; is_prose && first + PoseHeader::kPose <= names.size(); ++first) {
    const Named run = Assign(std::span(names).subspan(first, PoseHeader::kPose));
    if (!run.is_complete()) continue;
    header.is_prose = true;
    header.fraction.reset();
    found = run;
    for (auto& column : found.columns) *column += first;
    break;
  }
  if (!found.is_complete() || found.has_two_poses) {
    const auto has = [&](std::size_t i) { return found.columns[i].has_value(); };
    const auto is_w = [](const std::string& name) { return name == "q0" || name == "q4" || name.ends_with("wxyz"); };
    const bool has_w = has(kW) || std::ranges::any_of(names, is_w);
    std::string missing;
    for (std::size_t i = 0; i < PoseHeader::kPose; ++i)
      if (!has(i)) missing += (missing.empty() ? "" : ", ") + std::string(kNames[i]);
    const std::string all = ": name the columns timestamp tx ty tz qx qy qz qw, in their order";
    if (found.is_complete())
      problem = "the header names two poses a line: keep one";
    else if ((has_w && (is_prose ? has(1) && has(2) && has(3) : has(1) || has(4))) ||
             (!is_prose && has(1) && has(2) && has(3)))
      problem = "the header names no column for " + missing + all;
    return std::nullopt;
  }
  if (const std::string unit = UnitOfLength(Lower(line)); !unit.empty()) {
    problem = "the header states positions in " + unit + ": write metres";
    return std::nullopt;
  }
  std::ranges::transform(found.columns, header.columns.begin(), [](const auto& column) { return *column; });
  header.exponent = exponents[header.columns[kStamp]];
  if (HasAny(line, {"field.", "q_RS_w"})) header.exponent = -9;  // `rostopic echo -p`, EuRoC
  return header;
}

}  // namespace base
