// JSON files of the result folder, read within the limits of tools/base/limits/structured_text.h.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/judge/evaluation/text_file.h"

namespace vobench {

// Throws evaluation::InputError naming the file.
nlohmann::ordered_json ReadJson(const std::filesystem::path& file);

// read(json) of a file with this "format". What it throws, evaluation::InputError too, gets the file's name.
template <class Read>
auto ReadJson(const std::filesystem::path& file, const std::string& format, const Read& read) {
  const nlohmann::ordered_json json = ReadJson(file);
  const auto name = [&](const std::exception& error) {
    return evaluation::InputError({file.string() + ": " + error.what()});
  };
  try {
    if (json.at("format") != format) throw evaluation::InputError({"the format is not '" + format + "'"});
    return read(json);
  } catch (const nlohmann::json::exception& error) {
    throw name(error);
  } catch (const evaluation::InputError& error) {
    throw name(error);
  }
}

}  // namespace vobench
