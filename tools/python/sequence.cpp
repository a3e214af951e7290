#include <opencv2/imgproc.hpp>
#include <optional>

#include "tools/python/module.h"
#include "vo/sequence/reader.h"

namespace vobench::python {
namespace {

// Red, green, blue: a view of OpenCV's blue, green, red, backwards.
py::array Pixels(const py::object& self) {
  const cv::Mat& image = self.cast<const vo::Frame&>().image;
  const auto row = static_cast<py::ssize_t>(image.step[0]);
  if (image.channels() == 1)
    return py::array(py::dtype::of<std::uint8_t>(), {image.rows, image.cols}, {row, py::ssize_t(1)}, image.data, self);
  return py::array(py::dtype::of<std::uint8_t>(), {image.rows, image.cols, 3}, {row, py::ssize_t(3), py::ssize_t(-1)},
                   image.data + 2, self);
}

}  // namespace

void AddSequence(py::module_& m) {
  py::class_<vo::Frame>(m, "ImageFrame", "An image of a sequence on disk; no truth.")
      .def_readonly("stamp_ns", &vo::Frame::stamp_ns, Doc("vo/base/source.h:Frame::stamp_ns"))
      .def_property_readonly("image", &Pixels,
                             "(height, width), or (height, width, 3): red, green, blue; uint8. A view of the frame.");
  py::class_<vo::SequenceReader>(m, "Sequence", Doc("vo/sequence/reader.h:"))
      .def(py::init<const std::filesystem::path&>(), py::arg("folder"),
           Doc("vo/sequence/reader.h:SequenceReader::SequenceReader"))
      .def("__len__", &vo::SequenceReader::size)
      .def("__iter__", [](py::object self) { return self; })
      .def(
          "__next__",
          [](vo::SequenceReader& self) {
            std::optional<vo::Frame> frame;
            {
              const py::gil_scoped_release unlocked;
              frame = self.Next();
            }
            if (!frame) throw py::stop_iteration();
            return *std::move(frame);
          },
          Doc("vo/base/source.h:FrameSource::Next"));
}

}  // namespace vobench::python
