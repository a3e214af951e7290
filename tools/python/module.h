// The parts of the Python module, and the types that they share. docs/python.md.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim/points/point_world.h"
#include "sim/simulator.h"
#include "tools/bench/systems/experiment.h"
#include "tools/judge/evaluation/trajectory.h"
#include "vo/odometry.h"

namespace vobench::python {

namespace py = pybind11;

// "sim/simulator.h:Simulator::Render": the comment of that declaration; "sim/simulator.h:": the header's purpose.
// docstrings.py collects them from the headers when the module is built. Throws std::logic_error for an unknown key.
const char* Doc(const std::string& key);

// Work that runs without Python's interpreter lock.
using Unlocked = py::call_guard<py::gil_scoped_release>;

// A scenario with its odometry: and prior: sections, shared by the objects made from it.
using Scenario = std::shared_ptr<Experiment>;

// Ground truth of a frame.
struct StampedTruth {
  std::int64_t stamp_ns = 0;
  sim::Truth truth;
};

struct Simulator {
  Scenario scenario;
  sim::Simulator simulator;
};

struct PointWorld {
  Scenario scenario;
  sim::PointWorld world;
};

// A class of its own: std::vector would be copied to a list.
struct Trajectory {
  evaluation::Trajectory poses;
};

// Of (x, y, z, w). Throws std::invalid_argument where it is not a rotation.
Eigen::Quaterniond Rotation(const Eigen::Vector4d& xyzw);

// {"filter.particles": 16} as overrides, with a prefix before each key.
Overrides OverridesOf(const py::dict& settings, const std::string& prefix = "");

// The source's next frame, without the interpreter lock; ends Python's iteration after the last.
template <class Source>
auto NextOf(Source& source) {
  auto frame = [&] {
    const py::gil_scoped_release unlocked;
    return source.Next();
  }();
  if (!frame) throw py::stop_iteration();
  return *std::move(frame);
}

// Each adds classes and functions; in this order, so that signatures name Python's types.
void AddErrors(py::module_& m);
void AddScenario(py::module_& m);       // Scenario, Camera, Truth
void AddFrames(py::module_& m);         // Simulator, Frame, PointWorld, PointFrame, Sequence, ImageFrame
void AddOdometry(py::module_& m);       // Prior, Estimate, Odometry, PointOdometry
void AddErrorMeasures(py::module_& m);  // Trajectory, ate, rpe
void AddConsistency(py::module_& m);    // nees, anees_test, judge, play, test_consistency

}  // namespace vobench::python
