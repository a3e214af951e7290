// Strict reader of settings files (YAML). Each component reads its own keys; the default is the variable's
// present value. All problems are collected and thrown at once, unknown keys among them. Structs with a field table
// (fields.h) are read by field_reader.h.
//
//   settings::Document document = settings::Document::FromFile("scenario.yaml");
//   document.Override("sensor.exposure", "8 ms");
//   settings::Section sensor = document.root().Child("sensor");
//   sensor.Read("exposure", exposure_s, settings::Unit::time, settings::Range::Positive());
//   sensor.ReadChoice("response", response, {{"linear", Response::linear}, {"srgb", Response::srgb}});
//   document.ThrowIfBad();
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "tools/base/settings/problem.h"
#include "tools/base/settings/quantity.h"

namespace settings {

// Settings given beside a file, --set KEY=VALUE: (dotted key, YAML value), a later one wins.
using Overrides = std::vector<std::pair<std::string, std::string>>;

// Dialects of YAML.
enum class Dialect {
  ours,
  opencv,  // as cv::FileStorage writes it: the first line, "%YAML:1.0", is none of YAML's, and matrices have tags
};

// Unparsed value, for another reader.
struct RawYaml {
  std::string text;  // as written, of a number or a word; else as below
  std::string yaml;  // on one line, for Document::Override
};

struct Element;  // of the file
struct Place;    // in the file
struct Request;  // a registered read of a key
struct State;    // of a document

// A section of the document, present or absent: an absent section reads as one without keys. A cheap handle that keeps
// the document's data alive. The readers return whether the key was present and valid; otherwise `value` is unchanged,
// and if it was present, the document has a problem. Values written to are in SI.
class Section {
 public:
  bool Has(const std::string& key) const;

  bool Read(const std::string& key, double& value, Unit unit = Unit::none, const Range& range = {});
  bool Read(const std::string& key, double& value, const Range& range) { return Read(key, value, Unit::none, range); }
  template <std::integral T>  // int, std::int64_t, std::uint64_t
  bool Read(const std::string& key, T& value, const Range& range = {});
  bool Read(const std::string& key, bool& value);         // true or false
  bool Read(const std::string& key, std::string& value);  // not empty
  bool Read(const std::string& key, std::vector<double>& value, Unit unit = Unit::none, const Range& range = {});
  bool Read(const std::string& key, std::vector<std::string>& value);
  // A list of as many numbers.
  bool Read(const std::string& key, std::span<double> values, Unit unit = Unit::none, const Range& range = {});

  // Like Read with the same arguments, but a missing key is a problem.
  template <class... Arguments>
  bool Require(const std::string& key, Arguments&&... arguments) {
    const bool good = Read(key, std::forward<Arguments>(arguments)...);
    RequirePresent(key);
    return good;
  }

  // One of the names. Throws std::logic_error when the default is not among them.
  template <class T>
  bool ReadChoice(const std::string& key, T& value,
                  const std::vector<std::pair<std::string, std::type_identity_t<T>>>& names) {
    std::vector<std::string> texts;
    std::size_t index = names.size();
    for (std::size_t i = 0; i < names.size(); ++i) {
      texts.push_back(names[i].first);
      if (names[i].second == value) index = i;
    }
    const bool good = ReadName(key, texts, index);
    if (good) value = names[index].second;
    return good;
  }
  template <class T>
  bool RequireChoice(const std::string& key, T& value,
                     const std::vector<std::pair<std::string, std::type_identity_t<T>>>& names) {
    const bool good = ReadChoice(key, value, names);
    RequirePresent(key);
    return good;
  }

  // A key that is permitted but not read: the alternative to one that is.
  void Allow(const std::string& key) { Register(key); }

  Section Child(const std::string& key);
  // The sections of a list; none when it is absent. With a shorthand, an item that is a single word stands for
  // {shorthand: word}.
  std::vector<Section> List(const std::string& key, const std::string& shorthand = "");

  // Unparsed values. A list, or a single value as a list of one; and keys with values, in the order of the file.
  bool ReadRaw(const std::string& key, std::vector<RawYaml>& values);
  bool ReadRaw(const std::string& key, std::vector<std::pair<std::string, std::string>>& entries);

  // Adds a problem at the place of `key` (dotted for one further down), or of this section where the key is absent. For
  // rules between several values.
  void Reject(const std::string& key, const std::string& message);
  // "FILE:LINE:COLUMN" of a key, or of the section where it has none: for problems that are found later.
  std::string Where(const std::string& key) const;
  void Reject(const std::vector<FieldProblem>& problems);
  void RequirePresent(const std::string& key);
  // Where the old key or value is given, adds a problem that names the new one and returns true.
  bool Renamed(const std::string& key, const std::string& now);
  bool Renamed(const std::string& key, const std::string& value, const std::string& now);

  // A key for another reader: neither read nor checked here. Not in Resolved.
  void Ignore(const std::string& key);
  // Ignores all keys that are not read.
  void IgnoreRest();

 private:
  friend class Document;
  Section(std::shared_ptr<State> state, Request* request) : state_(std::move(state)), request_(request) {}

  const Element* Find(const std::string& key) const;
  const Place& PlaceOf(const std::string& key) const;
  Request& Register(const std::string& key);
  bool ReadName(const std::string& key, const std::vector<std::string>& names, std::size_t& index);
  template <class T, class Parse>
  bool ReadBy(const std::string& key, T& value, const Parse& parse);

  std::shared_ptr<State> state_;
  Request* request_;
};

class Document {
 public:
  // Throws Error when the file cannot be read or is not valid YAML. Duplicate keys and the like wait for ThrowIfBad.
  static Document FromFile(const std::filesystem::path& path, Dialect dialect = Dialect::ours);
  static Document FromText(const std::string& text, const std::string& name, Dialect dialect = Dialect::ours);

  // Sets one value (YAML: "3", "8 ms", "[1, 2]", "{a: 1}") by its dotted key; numbers are indices of lists
  // ("keys.0.time"). Problems with it name "--set a.b.c". Before the first root(); throws std::logic_error afterwards.
  void Override(const std::string& key, const std::string& value);

  // Draws each value that is written as a distribution, {uniform: [3 ms, 20 ms]}, {log_uniform: [1, 100]} or
  // {one_of: [a, b, c]}, wherever a value may stand. `uniform`: a number in (0, 1) that is a function of the value's
  // dotted key. Returns keys and values. Before the first root().
  std::vector<std::pair<std::string, std::string>> Draw(const std::function<double(std::string_view path)>& uniform);
  // Whole number of the file's first level, read ahead of the rest; none where it is absent or invalid.
  std::optional<std::uint64_t> Peek(const std::string& key) const;

  Section root();

  // To be called after all keys have been read. Throws Error with all problems, among them each key that was not read.
  void ThrowIfBad() const;

  // All values that were read, defaults included, in SI: JSON, which is valid YAML. Read again, it gives the same
  // settings.
  std::string Resolved() const;

 private:
  explicit Document(std::shared_ptr<State> state) : state_(std::move(state)) {}

  std::shared_ptr<State> state_;
};

}  // namespace settings
