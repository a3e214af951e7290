#include <algorithm>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tools/bench/systems/bridge.h"
#include "tools/python/module.h"
#include "vo/sequence/reader.h"

namespace vobench::python {
namespace {

int JobsOf(int jobs) { return jobs == 0 ? static_cast<int>(std::max(1U, std::thread::hardware_concurrency())) : jobs; }

std::int64_t Checked(std::int64_t index, std::int64_t count) {
  if (index < 0 || index >= count) {
    throw py::index_error("frame " + std::to_string(index) + " of " + std::to_string(count));
  }
  return index;
}

// View of numbers in the memory of `owner`, which lives as long as the view.
template <class T>
py::array ViewOf(const T* first, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides, py::handle owner) {
  return py::array(py::dtype::of<T>(), std::move(shape), std::move(strides), first, owner);
}

py::array Pixels(const py::object& self) {
  const sim::Image& image = self.cast<const sim::Frame&>().image;
  std::vector<py::ssize_t> shape{image.height, image.width};
  const py::ssize_t size = image.bits > 8 ? 2 : 1;
  std::vector<py::ssize_t> strides{size * image.width * image.channels, image.channels * size};
  if (image.channels > 1) {
    shape.push_back(image.channels);
    strides.push_back(size);
  }
  if (image.bits > 8) return ViewOf(image.wide.data(), shape, strides, self);
  return ViewOf(image.data.data(), shape, strides, self);
}

py::array Depth(const Simulator& self, std::int64_t index) {
  auto depth = std::make_unique<std::vector<float>>();
  {
    const py::gil_scoped_release unlocked;
    *depth = self.simulator.Depth(index);
  }
  const std::vector<float>& numbers = *depth;
  const py::ssize_t height = self.simulator.camera().height(), width = self.simulator.camera().width();
  const py::capsule owner(depth.release(), [](void* kept) { delete static_cast<std::vector<float>*>(kept); });
  return ViewOf(numbers.data(), {height, width}, {4 * width, 4}, owner);
}

py::array Ids(const py::object& self) {
  const auto& seen = self.cast<const sim::PointFrame&>().observations;
  return ViewOf(seen.empty() ? nullptr : &seen.front().id, {py::ssize_t(seen.size())}, {sizeof(sim::PointObservation)},
                self);
}

py::array Places(const py::object& self) {
  const auto& seen = self.cast<const sim::PointFrame&>().observations;
  return ViewOf(seen.empty() ? nullptr : &seen.front().x_px, {py::ssize_t(seen.size()), 2},
                {sizeof(sim::PointObservation), sizeof(double)}, self);
}

py::array_t<double> Landmarks(const PointWorld& self) {
  const std::vector<sim::PointLandmark>& landmarks = self.world.landmarks();
  py::array_t<double> X_W({py::ssize_t(landmarks.size()), py::ssize_t(4)});
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    for (int d = 0; d < 4; ++d) X_W.mutable_at(i, d) = landmarks[i].X_W[d];
  }
  return X_W;
}

sim::PointWorld WorldOf(const Scenario& scenario, std::optional<std::uint64_t> seed) {
  sim::Scenario of_seed = scenario->scenario;
  if (seed) of_seed.seed = *seed;
  return sim::PointWorld(of_seed);
}

struct FrameIterator {
  std::shared_ptr<Simulator> simulator;
  std::int64_t next = 0;
};

sim::Frame NextFrame(FrameIterator& self) {
  if (self.next >= self.simulator->simulator.frame_count()) throw py::stop_iteration();
  const py::gil_scoped_release unlocked;
  return self.simulator->simulator.Render(self.next++);
}

// Red, green, blue: a view of OpenCV's blue, green, red, backwards.
py::array PixelsOfMat(const py::object& self) {
  const cv::Mat& image = self.cast<const vo::Frame&>().image;
  const auto row = static_cast<py::ssize_t>(image.step[0]);
  if (image.channels() == 1) return ViewOf(image.data, {image.rows, image.cols}, {row, 1}, self);
  return ViewOf(image.data + 2, {image.rows, image.cols, 3}, {row, 3, -1}, self);
}

void AddSimulator(py::module_& m) {
  py::class_<sim::Frame>(m, "Frame", "A rendered frame with its truth.")
      .def_readonly("index", &sim::Frame::index)
      .def_readonly("stamp_ns", &sim::Frame::stamp_ns, Doc("sim/simulator.h:Frame::stamp_ns"))
      .def_property_readonly("exposure_s", [](const sim::Frame& f) { return f.setting.exposure_s; })
      .def_property_readonly("image", &Pixels,
                             "(height, width), or (height, width, 3): red, green, blue. uint8, or uint16 above 8 bits. "
                             "A view of the frame.")
      .def_property_readonly("truth", [](const sim::Frame& f) {
        return StampedTruth{f.stamp_ns, f.truth};
      });

  py::class_<FrameIterator>(m, "_FrameIterator")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &NextFrame);

  using Class = py::class_<Simulator, std::shared_ptr<Simulator>>;
  Class(m, "Simulator", Doc("sim/simulator.h:"))
      .def(py::init([](const Scenario& scenario, int jobs) {
             const py::gil_scoped_release unlocked;
             return std::make_shared<Simulator>(Simulator{scenario, sim::Simulator(scenario->scenario, JobsOf(jobs))});
           }),
           py::arg("scenario"), py::arg("jobs") = 0, Doc("sim/simulator.h:Simulator::Simulator"))
      .def_readonly("scenario", &Simulator::scenario)
      .def_property_readonly("camera", [](const Simulator& s) { return CameraOf(s.simulator.scenario()); })
      .def_property_readonly(
          "warnings", [](const Simulator& s) { return s.simulator.warnings(); },
          Doc("sim/simulator.h:Simulator::warnings"))
      .def_property_readonly(
          "cameras",
          [](const Simulator& s) {
            std::vector<Simulator> cameras;
            for (const sim::Simulator& camera : s.simulator.Cameras()) cameras.push_back({s.scenario, camera});
            return cameras;
          },
          Doc("sim/simulator.h:Simulator::Cameras"))
      .def("__len__", [](const Simulator& s) { return s.simulator.frame_count(); })
      .def(
          "__iter__",
          [](std::shared_ptr<Simulator> s) {
            return FrameIterator{std::move(s), 0};
          },
          Doc("sim/simulator.h:Simulator::Next"))
      .def(
          "render",
          [](const Simulator& s, std::int64_t index) {
            Checked(index, s.simulator.frame_count());
            const py::gil_scoped_release unlocked;
            return s.simulator.Render(index);
          },
          py::arg("index"), Doc("sim/simulator.h:Simulator::Render"))
      .def(
          "depth",
          [](const Simulator& s, std::int64_t index) { return Depth(s, Checked(index, s.simulator.frame_count())); },
          py::arg("index"), Doc("sim/simulator.h:Simulator::Depth"))
      .def(
          "truth",
          [](const Simulator& s, std::int64_t index) {
            Checked(index, s.simulator.frame_count());
            return StampedTruth{s.simulator.StampNs(index), s.simulator.TruthAt(index)};
          },
          py::arg("index"), Doc("sim/motion/trajectory.h:Truth"));
}

void AddPoints(py::module_& m) {
  py::class_<sim::PointFrame>(m, "PointFrame", "What is seen of a point world at one time, and the truth.")
      .def_readonly("index", &sim::PointFrame::index)
      .def_readonly("stamp_ns", &sim::PointFrame::stamp_ns)
      .def_property_readonly("ids", &Ids,
                             "(n,), increasing: the same for the same landmark in every frame. A view of the frame.")
      .def_property_readonly(
          "pixels", &Places,
          "(n, 2). Centre of the first pixel = (0, 0), lens distortion included. A view of the frame.")
      .def_property_readonly("truth", [](const sim::PointFrame& f) {
        return StampedTruth{f.stamp_ns, f.truth};
      });

  py::class_<PointWorld>(m, "PointWorld", Doc("sim/points/point_world.h:"))
      .def(py::init([](const Scenario& scenario, std::optional<std::uint64_t> seed) {
             return PointWorld{scenario, WorldOf(scenario, seed)};
           }),
           py::arg("scenario"), py::arg("seed") = py::none(), Doc("sim/points/point_world.h:PointWorld::PointWorld"))
      .def_readonly("scenario", &PointWorld::scenario)
      .def_property_readonly("seed", [](const PointWorld& w) { return w.world.scenario().seed; })
      .def_property_readonly("camera", [](const PointWorld& w) { return ToOdometry(w.world.camera().params()); })
      .def_property_readonly(
          "warnings", [](const PointWorld& w) { return w.world.Warnings(); },
          Doc("sim/points/point_world.h:PointWorld::Warnings"))
      .def("__len__", [](const PointWorld& w) { return w.world.frame_count(); })
      .def("__iter__", [](const py::object& self) { return self; })
      .def(
          "__next__", [](PointWorld& w) { return NextOf(w.world); }, Doc("sim/points/point_world.h:PointWorld::Next"))
      .def(
          "truth",
          [](const PointWorld& w, std::int64_t index) {
            Checked(index, w.world.frame_count());
            return StampedTruth{w.world.StampNs(index), w.world.TruthAt(index)};
          },
          py::arg("index"), Doc("sim/points/point_world.h:PointWorld::TruthAt"))
      .def_property_readonly("landmarks", &Landmarks,
                             "(n, 4): every landmark seen so far, landmarks[id], homogeneous (x, y, z, w) in W.");
}

void AddSequence(py::module_& m) {
  py::class_<vo::Frame>(m, "ImageFrame", "An image of a sequence on disk; no truth.")
      .def_readonly("stamp_ns", &vo::Frame::stamp_ns, Doc("vo/base/source.h:Frame::stamp_ns"))
      .def_property_readonly("image", &PixelsOfMat,
                             "(height, width), or (height, width, 3): red, green, blue; uint8. A view of the frame.");
  py::class_<vo::SequenceReader>(m, "Sequence", Doc("vo/sequence/reader.h:"))
      .def(py::init<const std::filesystem::path&>(), py::arg("folder"),
           Doc("vo/sequence/reader.h:SequenceReader::SequenceReader"))
      .def("__len__", &vo::SequenceReader::size)
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", &NextOf<vo::SequenceReader>, Doc("vo/base/source.h:FrameSource::Next"));
}

}  // namespace

void AddFrames(py::module_& m) {
  AddSimulator(m);
  AddPoints(m);
  AddSequence(m);
}

}  // namespace vobench::python
