#include "tools/bench/campaign/external_system.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <set>
#include <sstream>

#include "tools/base/settings/settings.h"
#include "tools/bench/campaign/sequence_cache.h"
#include "tools/bench/text.h"

namespace vobench::campaign {
namespace {

const std::vector<std::pair<std::string, SequenceLayout>> kLayouts = {
    {"tum", SequenceLayout::tum}, {"euroc", SequenceLayout::euroc}, {"images", SequenceLayout::images}};

const std::vector<std::pair<std::string, Sensors>> kSensors = {
    {"mono", {false, false}}, {"stereo", {true, false}}, {"mono_imu", {false, true}}, {"stereo_imu", {true, true}}};

constexpr const char* kHere = "here";  // the variable that every entry has: the folder of its file

const std::vector<std::pair<std::string, CalibrationFormat>> kFormats = {
    {"none", CalibrationFormat::none},
    {"camera_yaml", CalibrationFormat::camera_yaml},
    {"orb_slam2", CalibrationFormat::orb_slam2},
    {"orb_slam3", CalibrationFormat::orb_slam3},
    {"dso", CalibrationFormat::dso},
    {"svo", CalibrationFormat::svo},
    {"lsd_slam", CalibrationFormat::lsd_slam}};

template <class T>
std::string NameIn(const std::vector<std::pair<std::string, T>>& names, T value) {
  return std::ranges::find(names, value, &std::pair<std::string, T>::second)->first;
}

// A word in braces, or the text between two such. Braces around anything else, and behind $, are sh's own.
struct Piece {
  std::string text;  // without the braces
  bool is_placeholder = false;
};

std::vector<Piece> Pieces(const std::string& command) {
  constexpr char kWord[] = "abcdefghijklmnopqrstuvwxyz_0123456789";
  std::vector<Piece> pieces;
  std::size_t done = 0;
  for (std::size_t open = command.find('{'); open != std::string::npos; open = command.find('{', open + 1)) {
    const std::size_t close = command.find_first_not_of(kWord, open + 1);
    const bool is_shells = open > 0 && command[open - 1] == '$';
    if (close == std::string::npos || command[close] != '}' || close == open + 1 || is_shells) continue;
    pieces.push_back({command.substr(done, open - done), false});
    pieces.push_back({command.substr(open + 1, close - open - 1), true});
    done = close + 1;
  }
  pieces.push_back({command.substr(done), false});
  return pieces;
}

void CheckPlaceholders(settings::Section& section, const ExternalSystem& system, const std::string& key,
                       const std::string& command) {
  std::set<std::string> known = {"sequence", "calibration", "configs", "trajectory", "seed"};
  for (const auto& [name, value] : system.variables) known.insert(name);
  for (const auto& [word, is_placeholder] : Pieces(command)) {
    if (!is_placeholder) continue;
    if (!known.contains(word)) {
      section.Reject(
          key, fmt::format("'{}': {{{}}} stands for nothing; there are {{{}}}", key, word, fmt::join(known, "}, {")));
    }
    if (word == "calibration" && system.calibration == CalibrationFormat::none) {
      section.Reject(key, "'" + key + "': {calibration} needs the key 'calibration', which says in what format");
    }
    if (word == "configs" && system.configs.empty())
      section.Reject(key, "'" + key + "': {configs} needs the key 'configs', the command that writes what is in it");
  }
}

// Sensors and alignment of a system: never Sim(3) for a metric one.
void ReadSensors(settings::Section& section, ExternalSystem& system) {
  using evaluation::Alignment;
  const Sensors& sensors = system.sensors;
  section.ReadChoice("sensors", system.sensors, kSensors);
  section.Read("configs", system.configs);
  section.ReadChoice("poses_of", system.poses_of_imu, {{"camera", false}, {"imu", true}});
  if (sensors.metric()) system.align = sensors.imu ? Alignment::yaw : Alignment::se3;
  if (sensors.metric()) section.ReadChoice("align", system.align, {{"se3", Alignment::se3}, {"yaw", Alignment::yaw}});
  if (sensors.metric() && (system.layout != SequenceLayout::euroc || system.rectified))
    section.Reject("sensors",
                   "'sensors': more than the pictures of one camera needs 'layout: euroc', with original images");
  if (!sensors.metric() && section.Has("align"))
    section.Reject("align", "'align': of one camera `judge.align` of the campaign counts");
  if (system.align == Alignment::yaw && !sensors.imu)
    section.Reject("align", "'align': yaw needs an IMU, which knows gravity");
  if (system.poses_of_imu && !sensors.imu) section.Reject("poses_of", "'poses_of': it takes no IMU");
}

// Of a command for sh, without their quotes; all up to a space or one of `;|&`.
std::vector<std::string> Words(const std::string& command) {
  std::vector<std::string> words;
  bool open = false;
  char quote = 0;
  for (const char c : command) {
    if (quote == 0 && std::string_view(" \t\n;|&").find(c) != std::string_view::npos) {
      open = false;
    } else if (quote == 0 ? c == '\'' || c == '"' : c == quote) {
      quote = quote == 0 ? c : 0;
    } else {
      if (!open) words.emplace_back();
      open = true;
      words.back() += c;
    }
  }
  return words;
}

bool IsExecutable(const std::filesystem::path& file) {
  return std::filesystem::is_regular_file(file) && access(file.c_str(), X_OK) == 0;
}

// Path by sh's search; empty where there is none.
std::filesystem::path PathOfProgram(const std::string& word) {
  if (word.find('/') != std::string::npos) return std::filesystem::path(IsExecutable(word) ? word : "");
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (IsExecutable(std::filesystem::path(folder) / word)) return std::filesystem::path(folder) / word;
  return {};
}

constexpr const char* kOfShell = "$`(){}=<>!";  // a word with one of these is sh's own

// An interpreter's script, as written in the command, where that path does not exist. A relative one is resolved from
// the empty folder of the run; not behind `cd`.
std::string MissingScript(const ExternalSystem& system) {
  static const std::regex interpreter("(.*/)?(python|perl|ruby|node|julia|Rscript|octave|(ba|da|z)?sh)[0-9.]*");
  static const std::regex script(".*/.*[.](py|sh|pl|rb|js|mjs|jl|R|m)");
  const std::vector<std::string> words = Words(system.command);
  const bool moves = std::ranges::count(words, "cd") > 0;
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    const std::string& word = words[i + 1];
    const std::vector<std::string> filled = Words(FillIn(word, system.variables));
    if (!std::regex_match(words[i], interpreter) || filled.size() != 1) continue;
    if (filled[0].find_first_of(kOfShell) != std::string::npos) continue;
    const bool is_path = filled[0].starts_with('/') || (!moves && std::regex_match(filled[0], script));
    if (is_path && (!filled[0].starts_with('/') || !std::filesystem::exists(filled[0]))) return word;
  }
  return "";
}

}  // namespace

std::string Name(SequenceLayout layout) { return NameIn(kLayouts, layout); }
std::string Name(CalibrationFormat format) { return NameIn(kFormats, format); }
std::string Name(const Sensors& sensors) { return NameIn(kSensors, sensors); }

std::vector<ExternalSystem> ReadExternalSystems(const std::filesystem::path& file) {
  settings::Document document = settings::Document::FromFile(file);
  std::vector<ExternalSystem> systems;
  std::set<std::string> names;
  for (settings::Section& section : document.root().List("systems")) {
    ExternalSystem& system = systems.emplace_back();
    for (const char* key : {"accept_exit", "align", "calibration", "command", "configs", "files", "images", "layout",
                            "name", "poses_of", "sensors", "threads", "timeout", "trajectory", "variables", "writes"})
      section.Allow(key);
    section.Require("name", system.name);
    section.Require("command", system.command);
    settings::Section variables = section.Child("variables");
    std::vector<std::pair<std::string, std::string>> entries;
    section.ReadRaw("variables", entries);
    for (const auto& [name, ignored] : entries) {
      std::string value;
      variables.Read(name, value);
      system.variables.emplace_back(name, value);
    }
    system.variables.emplace_back(kHere, std::filesystem::absolute(file).parent_path().lexically_normal().string());
    section.ReadChoice("layout", system.layout, kLayouts);
    section.ReadChoice("calibration", system.calibration, kFormats);
    section.ReadChoice("images", system.rectified, {{"original", false}, {"rectified", true}});
    section.Read("trajectory", system.trajectory);
    section.Read("timeout", system.timeout_s, settings::Unit::time, settings::Range::Positive());
    section.ReadChoice("writes", system.keyframes, {{"frames", false}, {"keyframes", true}});
    section.ReadChoice("accept_exit", system.accepts_any_exit, {{"zero", false}, {"any", true}});
    section.Read("threads", system.threads, settings::Range::AtLeast(1));
    std::vector<std::string> files;
    section.Read("files", files);
    for (const std::string& each : files) {
      system.files.push_back(file.parent_path() / each);
      if (!std::filesystem::exists(system.files.back()))
        section.Reject("files", "'files': " + system.files.back().string() + " is not there");
    }
    if (!names.insert(system.name).second) section.Reject("name", "there is a system '" + system.name + "' already");
    ReadSensors(section, system);
    CheckPlaceholders(section, system, "command", system.command);
    CheckPlaceholders(section, system, "configs", system.configs);
  }
  document.ThrowIfBad();
  return systems;
}

std::string FillIn(const std::string& command, const std::vector<std::pair<std::string, std::string>>& values) {
  std::string text;
  for (const auto& [piece, is_placeholder] : Pieces(command)) {
    const auto found = std::ranges::find(values, piece, &std::pair<std::string, std::string>::first);
    text += !is_placeholder ? piece : found == values.end() ? "{" + piece + "}" : QuotedForShell(found->second);
  }
  return text;
}

std::string Label(const ExternalSystem& system, const std::string& name) {
  return system.keyframes ? name + " (key frames)" : name;
}

std::string StartProblem(const ExternalSystem& system) {
  const std::vector<std::string> words = Words(FillIn(system.command, system.variables));
  if (const std::string script = MissingScript(system); !script.empty())
    return "'" + script + "', which the command names, is not there";
  if (words.empty() || words[0].find_first_of(kOfShell) != std::string::npos) return "";
  const std::string found = "command -v " + QuotedForShell(words[0]) + " > /dev/null 2>&1";
  return std::system(found.c_str()) == 0 ? "" : "'" + words[0] + "' is not there, or cannot be executed";
}

std::string DigestOfPrograms(const ExternalSystem& system) {
  std::vector<std::filesystem::path> files = system.files;
  for (const std::string& word : Words(FillIn(system.command + " " + system.configs, system.variables))) {
    const std::filesystem::path program = PathOfProgram(word);
    if (!program.empty() || std::filesystem::is_regular_file(word))
      files.push_back(program.empty() ? std::filesystem::path(word) : program);
  }
  std::string text;
  for (const std::filesystem::path& file : files) text += file.filename().string() + " " + DigestOfFile(file) + "\n";
  return Digest(text);
}

std::string Description(const ExternalSystem& system) {
  std::string text = fmt::format("{}\n{}\n{}\n{}\n{}\n", system.command, Name(system.layout), Name(system.calibration),
                                 system.trajectory, system.timeout_s);
  text += fmt::format("{}{}{}\n{}\n", system.rectified, system.keyframes, system.accepts_any_exit, system.programs);
  if (system.sensors.metric() || !system.configs.empty())
    text += fmt::format("{}\n{}\n{}\n", Name(system.sensors), system.configs, system.poses_of_imu);
  for (const auto& [name, value] : system.variables)
    if (name != kHere) text += name + "=" + value + "\n";  // of what lies there the bytes count
  return text;
}

}  // namespace vobench::campaign
