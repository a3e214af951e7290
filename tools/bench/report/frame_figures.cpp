// What the odometry did frame by frame: features, map, time.
#include <algorithm>
#include <limits>

#include "tools/bench/report/drawn_runs.h"
#include "tools/bench/report/figures.h"
#include "tools/bench/text.h"

namespace vobench::report {
namespace {

namespace ev = evaluation;

template <class Value>
Numbers Of(const RunData& run, const Value& value) {
  Numbers values;
  for (const ev::FrameRecord& frame : run.run.frames) values.push_back(value(frame));
  return values;
}

Figure InTime(const std::string& title, const std::string& description, const std::string& label) {
  Figure figure;
  figure.title = title;
  figure.description = description;
  figure.x.label = "time [s]";
  figure.y = {label, false, false, true};
  return figure;
}

// A line for a part of the whole: told apart by colour, of one system.
Series Part(std::size_t number, const char* name, Numbers t, Numbers values) {
  Series part = LineOf(name, number, std::move(t), std::move(values));
  part.name = name;
  return part;
}

void AddFigures(const ResultData& data, std::size_t s, std::vector<Figure>& figures) {
  const std::string system = data.Systems()[s], name = DisplayName(system);
  const RunData& run = data.Typical(system);
  if (run.run.frames.empty()) return;
  const Numbers t = Of(run, [&](const ev::FrameRecord& frame) { return Seconds(data, frame.stamp_ns); });
  const auto line = [&](Role role, const char* label, const auto& value) {
    Series series = LineAs(role, label, t, Of(run, value));
    series.system = s;
    return series;
  };
  Figure features = InTime("Features of " + name, "Landmarks searched for and found in each frame.", "features");
  features.series = {
      line(Role::context, "searched", [](const ev::FrameRecord& f) { return f.searched; }),
      line(Role::system, "matched", [](const ev::FrameRecord& f) { return f.matched; }),
  };
  Series coasted = LineAs(Role::warning, "coasted", {}, {});
  coasted.draw = Draw::dots;
  for (const ev::FrameRecord& frame : run.run.frames) {
    if (frame.tracked) continue;
    coasted.x.push_back(Seconds(data, frame.stamp_ns));
    coasted.y.push_back(frame.matched);
  }
  if (!coasted.x.empty()) features.series.push_back(coasted);
  Figure map = InTime("Map of " + name, "Landmarks in the map after each frame.", "landmarks");
  map.series = {line(Role::context, "all", [](const ev::FrameRecord& f) { return f.landmarks; }),
                line(Role::system, "permanent", [](const ev::FrameRecord& f) { return f.permanent; })};
  figures.push_back(features);
  figures.push_back(map);

  Figure time = InTime("Time of " + name, "Milliseconds that each stage took, frame by frame.", "time per frame [ms]");
  time.series = {Part(2, "features", t, Of(run, [](const ev::FrameRecord& f) { return f.ms_features; })),
                 Part(3, "matching", t, Of(run, [](const ev::FrameRecord& f) { return f.ms_matching; })),
                 Part(4, "filter", t, Of(run, [](const ev::FrameRecord& f) { return f.ms_filter; }))};
  const auto taken = [](const ev::FrameRecord& f) { return f.ms_features + f.ms_matching + f.ms_filter; };
  if (std::any_of(run.run.frames.begin(), run.run.frames.end(),
                  [&](const ev::FrameRecord& f) { return taken(f) > 0; })) {
    figures.push_back(time);
  }
}

}  // namespace

std::vector<Figure> FrameFigures(const ResultData& data) {
  std::vector<Figure> figures;
  for (std::size_t s = 0; s < data.Systems().size(); ++s) AddFigures(data, s, figures);
  return figures;
}

}  // namespace vobench::report
