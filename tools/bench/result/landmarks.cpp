#include "tools/bench/result/landmarks.h"

#include <fmt/format.h>

#include <utility>

#include "tools/base/files.h"
#include "tools/judge/evaluation/text_file.h"

namespace vobench {

namespace ev = evaluation;

void WriteLandmarks(const std::filesystem::path& run_folder, const std::vector<Landmark>& landmarks) {
  std::string table = "id,x,y,z,inverse_depth,inverse_depth_sigma,permanent\n";
  for (const Landmark& l : landmarks) {
    table += fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{}\n", l.id, l.X_W.x(), l.X_W.y(), l.X_W.z(),
                         l.inverse_depth, l.inverse_depth_sigma, l.permanent ? 1 : 0);
  }
  base::WriteFile(run_folder / "landmarks.csv", table);
}

std::vector<Landmark> ReadLandmarks(const std::filesystem::path& run_folder) {
  const std::filesystem::path file = run_folder / "landmarks.csv";
  if (!std::filesystem::exists(file)) return {};
  ev::Problems problems;
  std::vector<Landmark> landmarks;
  bool header = true;
  for (const ev::Line& line : ev::Lines(file, ',')) {
    if (line.tokens.size() != 7) {
      problems.Add(file, line.number, 1, std::to_string(line.tokens.size()) + " columns where 7 are expected");
      continue;
    }
    if (std::exchange(header, false)) {
      if (line.tokens[0].text == "id") continue;
      problems.Add(file, line.number, 1, "no header line");
    }
    Landmark landmark;
    for (int k = 0; k < 3; ++k) {
      const ev::Token& token = line.tokens[static_cast<std::size_t>(k) + 1];
      const auto value = ev::ParseNumber(token.text);
      if (!value) problems.Add(file, line.number, token.column, "'" + token.text + "' is not a finite number");
      landmark.X_W[k] = value.value_or(0);
    }
    const ev::Token& last = line.tokens[6];
    landmark.permanent = last.text == "1";
    if (last.text != "0" && last.text != "1")
      problems.Add(file, line.number, last.column, "'" + last.text + "' is not 0 or 1");
    landmarks.push_back(landmark);
  }
  problems.ThrowIfAny();
  return landmarks;
}

}  // namespace vobench
