#include "tools/bench/result/run_json.h"

#include <algorithm>
#include <exception>

#include "tools/base/files.h"
#include "tools/base/limits/structured_text.h"
#include "tools/bench/result/json_file.h"

namespace vobench {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* kFormat = "vobench run 1";

// Takes fields from an object and notes which are missing or of another type.
class Fields {
 public:
  Fields(const fs::path& file, std::string where, const Json& object, evaluation::Problems& problems)
      : file_(file), where_(std::move(where)), object_(object), problems_(problems) {
    if (!object.is_object()) problems_.Add(file_, where_ + "is not an object");
  }

  template <class Value>
  void Take(const char* name, Value& into) {
    if (!object_.is_object()) return;
    const auto found = object_.find(name);
    if (found == object_.end()) {
      problems_.Add(file_, where_ + "'" + name + "' is missing");
      return;
    }
    try {
      if constexpr (std::is_integral_v<Value>) {
        into = limits::WholeNumber<Value>(*found).value();
      } else {
        into = found->template get<Value>();
      }
    } catch (const std::exception&) {
      problems_.Add(file_, where_ + "'" + name + "' has the wrong type: " + found->dump());
    }
  }

 private:
  const fs::path& file_;
  std::string where_;
  const Json& object_;
  evaluation::Problems& problems_;
};

// Whether a path is below the result folder, on any platform.
bool Inside(const std::string& path) {
  const fs::path p(path);
  return !path.empty() && !p.is_absolute() && std::find(p.begin(), p.end(), "..") == p.end();
}

}  // namespace

void WriteRunJson(const fs::path& out, const RunDescription& description) {
  Json json = {{"format", kFormat},
               {"title", description.title},
               {"input", description.input},
               {"command", description.command},
               {"started_utc", description.started_utc},
               {"seconds", description.seconds},
               {"versions", description.versions},
               {"notes", description.notes},
               {"verdicts", description.verdicts},
               {"runs", Json::array()},
               {"settings", description.settings}};
  for (const RunEntry& run : description.runs) {
    json["runs"].push_back({{"system", run.system}, {"seed", run.seed}, {"path", run.path}, {"seconds", run.seconds}});
    if (run.calibration) json["runs"].back()["calibration"] = ToJson(*run.calibration);
  }
  base::WriteFile(out / "run.json", json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

RunDescription ReadRunJson(const fs::path& out) {
  const fs::path file = out / "run.json";
  const Json json = ReadJson(file);
  evaluation::Problems problems;
  RunDescription description;
  std::string format;
  Json runs;
  Fields top(file, "", json, problems);
  top.Take("format", format);
  top.Take("title", description.title);
  top.Take("input", description.input);
  top.Take("command", description.command);
  top.Take("started_utc", description.started_utc);
  top.Take("seconds", description.seconds);
  top.Take("versions", description.versions);
  top.Take("notes", description.notes);
  if (json.contains("verdicts")) top.Take("verdicts", description.verdicts);  // older ones have none
  top.Take("settings", description.settings);
  top.Take("runs", runs);
  if (!format.empty() && format != kFormat)
    problems.Add(file, "format '" + format + "' where '" + kFormat + "' is expected");
  if (runs.is_array() && runs.empty()) problems.Add(file, "'runs' is empty");
  if (!runs.is_null() && !runs.is_array()) problems.Add(file, "'runs' is not a list");
  for (std::size_t i = 0; runs.is_array() && i < runs.size(); ++i) {
    RunEntry run;
    const std::string where = "runs[" + std::to_string(i) + "]: ";
    Fields fields(file, where, runs[i], problems);
    fields.Take("system", run.system);
    fields.Take("seed", run.seed);
    fields.Take("path", run.path);
    fields.Take("seconds", run.seconds);
    if (!run.path.empty() && !Inside(run.path))
      problems.Add(file, where + "path '" + run.path + "' leads out of the folder");
    if (runs[i].is_object() && runs[i].contains("calibration")) {
      try {
        run.calibration = CalibrationFromJson(runs[i].at("calibration"));
      } catch (const Json::exception& error) {
        problems.Add(file, where + "'calibration': " + error.what());
      }
    }
    description.runs.push_back(run);
  }
  problems.ThrowIfAny();
  return description;
}

}  // namespace vobench
