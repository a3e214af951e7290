// Encoder of the truth streams: files of each frame, and of the whole sequence.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "sim/render/surface_tracer.h"
#include "sim/scenario/scenario.h"
#include "sim/sequence/encode.h"
#include "sim/simulator.h"
#include "sim/world/labels.h"

namespace sim {

// The files of one frame: a pure function of its arguments, not of the range that is written. Flow exists where the
// simulator has the other frame. May be called from several threads.
std::vector<StreamFile> FrameStreams(const Simulator& simulator, std::int64_t index,
                                     const std::set<TruthStream>& streams);

// The files of frames [first, last) together: lists of those above, acceleration, IMU, landmarks; and, independently of
// the streams, the poses of each object.
std::vector<StreamFile> SequenceStreams(const Simulator& simulator, std::int64_t first, std::int64_t last,
                                        const std::set<TruthStream>& streams);

// The IMU's files, with the readings that are not outside of the stamps.
std::vector<StreamFile> ImuStreams(const Simulator& simulator, std::int64_t first_ns, std::int64_t last_ns);

// Instance id of each pixel: 1, 2, ...; 0: nothing. Throws std::runtime_error above 65535 instances.
std::vector<std::uint16_t> InstanceIds(const Simulator& simulator, const std::vector<SurfacePoint>& points);
// CSV, a line for each visible instance: its outermost pixels, its number of pixels, its box in C.
std::string Boxes(const Simulator& simulator, const View& view, const std::vector<std::uint16_t>& ids);
// JSON: instances with name, class and entry in the scenario; classes.
std::string LabelsJson(const Labels& labels);

// Calibration file of the IMU.
inline constexpr const char* kImuYaml = "imu0/sensor.yaml";

// All names at a sequence's top level that either function may create.
std::set<std::string> StreamNames();

}  // namespace sim
