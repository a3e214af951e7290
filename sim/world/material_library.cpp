#include "sim/world/material_library.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>

#include "sim/world/texture_file.h"
#include "tools/base/text.h"

namespace sim {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";

std::string_view Trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

// What comes before a comment: '#' between blanks, since names like "Material #25" have one, too.
std::string_view WithoutComment(std::string_view statement) {
  for (std::size_t at = statement.find('#'); at != std::string_view::npos; at = statement.find('#', at + 1)) {
    const bool is_last = at + 1 == statement.size();
    if (at > 0 && Trimmed(statement.substr(at - 1, 1)).empty() &&
        (is_last || Trimmed(statement.substr(at + 1, 1)).empty()))
      return Trimmed(statement.substr(0, at));
  }
  return statement;
}

// One to three numbers; of those that are left out `otherwise`.
std::array<double, 3> UpToThree(std::string_view& rest, double otherwise) {
  std::array<double, 3> numbers = {otherwise, otherwise, otherwise};
  for (double& number : numbers) {
    std::string_view after = rest;
    const std::optional<double> read = ToNumber(NextWord(after));
    if (!read || after.empty()) break;  // the last word is the file's name
    number = *read;
    rest = after;
  }
  return numbers;
}

// `[-option values] ... file name`
ImportedMap ReadMap(std::string_view rest) {
  ImportedMap map;
  std::array<double, 3> scale = {1, 1, 1}, offset = {0, 0, 0};
  while (rest.starts_with('-')) {
    std::string_view after = rest;
    const std::string option = Lower(std::string(NextWord(after)));
    if (after.empty()) break;  // a name that begins so
    if (option == "-s") {
      scale = UpToThree(after, 1);
    } else if (option == "-o") {
      offset = UpToThree(after, 0);
    } else if (option == "-t") {
      UpToThree(after, 0);  // turbulence
    } else if (option == "-mm") {
      NextWord(after), NextWord(after);  // base and gain
    } else if (option == "-clamp") {
      map.uv.wrap.fill(NextWord(after) == "on" ? UvWrap::clamp : UvWrap::repeat);
    } else {  // of one word
      NextWord(after);
    }
    if (after.empty()) break;
    rest = after;
  }
  if (rest.size() > 1 && rest.front() == '"' && rest.back() == '"') rest = rest.substr(1, rest.size() - 2);
  map.picture = rest;
  // uv' = scale uv + offset where v points up.
  map.uv.transform = glm::mat3x2(scale[0], 0, 0, scale[1], offset[0], 1 - scale[1] - offset[1]);
  return map;
}

}  // namespace

void ForEachStatement(std::string_view text,
                      const std::function<void(std::string_view word, std::string_view rest, int line)>& call) {
  text = base::WithoutMark(text);
  std::string joined, lines;
  if (text.find('\n') == std::string_view::npos && text.find('\r') != std::string_view::npos) {
    lines = text;
    std::ranges::replace(lines, '\r', '\n');
    text = lines;
  }
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view statement = Trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (statement.ends_with('\\') && !text.empty() && !(joined.empty() && statement.starts_with('#'))) {
      joined += std::string(statement.substr(0, statement.size() - 1)) + ' ';
      continue;
    }
    if (!joined.empty()) statement = joined += statement;
    std::string_view rest = WithoutComment(Trimmed(statement));
    if (!rest.empty() && rest[0] != '#') {
      const std::string_view word = NextWord(rest);
      call(word, rest, line);
    }
    joined.clear();
  }
}

std::string_view NextWord(std::string_view& rest) {
  const std::size_t begin = std::min(rest.find_first_not_of(kBlanks), rest.size());
  const std::size_t end = std::min(rest.find_first_of(kBlanks, begin), rest.size());
  const std::string_view word = rest.substr(begin, end - begin);
  rest = Trimmed(rest.substr(end));
  return word;
}

std::optional<double> ToNumber(std::string_view text) {
  text = base::WithoutPlus(text);
  double value = 0;
  const char* const all = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), all, value);
  if (error == std::errc::result_out_of_range && end == all) return std::strtod(std::string(text).c_str(), nullptr);
  return error == std::errc() && end == all ? std::optional(value) : std::nullopt;
}

std::vector<std::string> ReadMaterialLibrary(std::string_view text, const std::string& folder,
                                             std::map<std::string, ImportedMaterial>& materials) {
  ImportedMaterial* m = nullptr;
  std::vector<std::string> left_out;
  ForEachStatement(text, [&](std::string_view word, std::string_view rest, int line) {
    const std::string key = Lower(std::string(word));
    const auto leave_out = [&] {
      left_out.push_back("line " + std::to_string(line) + ": " + std::string(word) + " " + std::string(rest));
    };
    const auto number = [&](double otherwise) {
      std::string_view words = rest;
      const auto read = ToNumber(NextWord(words));
      if (!read) leave_out();
      return read.value_or(otherwise);
    };
    const auto color = [&](auto& value) {
      std::string_view words = rest;
      const auto r = ToNumber(NextWord(words));
      const bool is_grey = words.empty();
      const auto g = is_grey ? r : ToNumber(NextWord(words)), b = is_grey ? r : ToNumber(NextWord(words));
      if (!r || !g || !b) return leave_out();
      value.r = static_cast<float>(*r);
      value.g = static_cast<float>(*g);
      value.b = static_cast<float>(*b);
    };
    if (key == "newmtl") {
      m = &materials.insert_or_assign(std::string(rest), ImportedMaterial{std::string(rest), folder}).first->second;
      return;
    }
    if (m == nullptr) return;
    if (key == "kd") color(m->base_color);
    if (key == "ke") m->emission = glm::vec3(0), color(m->emission);
    if (key == "d") {
      if (rest.starts_with("-halo")) rest.remove_prefix(5);
      m->opacity = static_cast<float>(number(1));
    }
    if (key == "tr") {  // MeshLab writes 1 for what is opaque
      const double transparency = number(0);
      if (transparency > 0 && transparency < 1) m->opacity = static_cast<float>(1 - transparency);
    }
    if (key == "pr") m->roughness = static_cast<float>(number(1));
    if (key == "pm") m->metallic = static_cast<float>(number(0));
    if (key == "map_kd") m->color_map = ReadMap(rest);
    if (key == "map_d") m->opacity_map = ReadMap(rest);
    if (key == "map_ke") m->emission_map = ReadMap(rest);
    if (key == "bump" || key == "map_bump") m->has_bumps = 1;
    if (key == "map_pr" || key == "map_pm") m->gloss_map = ReadMap(rest);
    if (key == "norm") m->normal_map = ReadMap(rest);
  });
  return left_out;
}

}  // namespace sim
