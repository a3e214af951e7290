#include "tools/bench/campaign/external_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "tools/base/settings/settings.h"
#include "tools/bench/text.h"

namespace vobench::campaign {
namespace {

const std::vector<std::pair<std::string, SequenceLayout>> kLayouts = {
    {"tum", SequenceLayout::tum}, {"euroc", SequenceLayout::euroc}, {"images", SequenceLayout::images}};

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

// A word in braces, or what stands between two such. Braces around anything else, and behind $, are sh's own.
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

void CheckPlaceholders(settings::Section& section, const ExternalSystem& system) {
  std::set<std::string> known = {"sequence", "calibration", "trajectory", "seed"};
  for (const auto& [name, value] : system.variables) known.insert(name);
  for (const auto& [word, is_placeholder] : Pieces(system.command)) {
    if (!is_placeholder) continue;
    if (!known.contains(word)) {
      section.Reject("command", fmt::format("'command': {{{}}} stands for nothing; there are {{{}}}", word,
                                            fmt::join(known, "}, {")));
    }
    if (word == "calibration" && system.calibration == CalibrationFormat::none) {
      section.Reject("command", "'command': {calibration} needs the key 'calibration', which says in what format");
    }
  }
}

}  // namespace

std::string Name(SequenceLayout layout) { return NameIn(kLayouts, layout); }
std::string Name(CalibrationFormat format) { return NameIn(kFormats, format); }

std::vector<ExternalSystem> ReadExternalSystems(const std::filesystem::path& file) {
  settings::Document document = settings::Document::FromFile(file);
  std::vector<ExternalSystem> systems;
  std::set<std::string> names;
  for (settings::Section& section : document.root().List("systems")) {
    ExternalSystem& system = systems.emplace_back();
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
    section.ReadChoice("layout", system.layout, kLayouts);
    section.ReadChoice("calibration", system.calibration, kFormats);
    section.Read("trajectory", system.trajectory);
    section.Read("timeout", system.timeout_s, settings::Unit::time, settings::Range::Positive());
    if (!names.insert(system.name).second) section.Reject("name", "there is a system '" + system.name + "' already");
    CheckPlaceholders(section, system);
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

std::string Description(const ExternalSystem& system) {
  std::string text = fmt::format("{}\n{}\n{}\n{}\n{}\n", system.command, Name(system.layout), Name(system.calibration),
                                 system.trajectory, system.timeout_s);
  for (const auto& [name, value] : system.variables) text += name + "=" + value + "\n";
  return text;
}

}  // namespace vobench::campaign
