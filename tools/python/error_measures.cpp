#include <cmath>
#include <stdexcept>
#include <type_traits>

#include "tools/base/text.h"
#include "tools/judge/evaluation/ate.h"
#include "tools/judge/evaluation/rpe.h"
#include "tools/judge/evaluation/text_file.h"
#include "tools/python/module.h"

namespace vobench::python {
namespace {

using evaluation::StampedPose;
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Quaternions = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;
using Stamps = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

Trajectory MakeTrajectory(const Stamps& stamps_ns, const Points& positions, const Quaternions& orientations) {
  const Eigen::Index n = stamps_ns.size();
  if (stamps_ns.ndim() != 1 || positions.rows() != n || orientations.rows() != n) {
    throw std::invalid_argument("a trajectory of " + std::to_string(n) + " stamps, " +
                                std::to_string(positions.rows()) + " positions and " +
                                std::to_string(orientations.rows()) + " orientations");
  }
  Trajectory trajectory;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (i > 0 && stamps_ns.at(i) <= stamps_ns.at(i - 1)) {
      throw std::invalid_argument("stamps_ns[" + std::to_string(i) + "] is not after the one before");
    }
    if (stamps_ns.at(i) < -base::kLatest_ns || stamps_ns.at(i) > base::kLatest_ns) {
      throw std::invalid_argument("stamps_ns[" + std::to_string(i) + "] is beyond 4e18");
    }
    if (!positions.row(i).allFinite())
      throw std::invalid_argument("positions[" + std::to_string(i) + "] is not finite");
    trajectory.poses.push_back({stamps_ns.at(i), positions.row(i), Rotation(orientations.row(i))});
  }
  return trajectory;
}

// A view of one member of all poses: `width` numbers from First(pose) on.
template <auto First, py::ssize_t width>
py::array Column(const py::object& self) {
  const evaluation::Trajectory& poses = self.cast<const Trajectory&>().poses;
  using T = std::remove_cvref_t<decltype(*First(poses.front()))>;
  std::vector<py::ssize_t> shape{py::ssize_t(poses.size())}, strides{sizeof(StampedPose)};
  if (width > 1) {
    shape.push_back(width);
    strides.push_back(sizeof(T));
  }
  return py::array(py::dtype::of<T>(), shape, strides, poses.empty() ? nullptr : First(poses.front()), self);
}

std::int64_t Nanoseconds(const std::string& name, double seconds) {
  const auto ns = evaluation::Nanoseconds(seconds);
  if (!ns) throw std::invalid_argument(name + " = " + std::to_string(seconds) + " is not a time of 1e9 s at most");
  return *ns;
}

evaluation::MatchedTrajectories Match(const Trajectory& estimate, const Trajectory& truth, double gap_s) {
  evaluation::AssociationOptions options;
  options.gap_ns = Nanoseconds("gap_s", gap_s);
  return evaluation::MatchTrajectories(estimate.poses, truth.poses, options);
}

evaluation::Ate AteOf(const Trajectory& estimate, const Trajectory& truth, const std::string& align, double gap_s) {
  return evaluation::ComputeAte(Match(estimate, truth, gap_s), evaluation::AlignmentNamed(align));
}

evaluation::Rpe RpeOf(const Trajectory& estimate, const Trajectory& truth, double delta_s, double scale, double gap_s) {
  const evaluation::MatchedTrajectories matched = Match(estimate, truth, gap_s);
  return evaluation::ComputeRpe(matched, evaluation::PairsByTime(matched.truth, Nanoseconds("delta_s", delta_s)),
                                scale);
}

py::array_t<double> Copy(const std::vector<double>& values) {
  return py::array_t<double>(py::ssize_t(values.size()), values.data());
}

}  // namespace

void AddErrorMeasures(py::module_& m) {
  py::class_<Trajectory>(m, "Trajectory", "T_WC at times, in order. X_W = q_WC * X_C + p_WC.")
      .def(py::init(&MakeTrajectory), py::arg("stamps_ns"), py::arg("positions"), py::arg("orientations"),
           "positions (n, 3) [m], orientations (n, 4): (x, y, z, w)")
      .def_static(
          "read", [](const std::filesystem::path& file) { return Trajectory{evaluation::ReadTrajectory(file)}; },
          py::arg("file"), Doc("tools/judge/evaluation/trajectory.h:ReadTrajectory"))
      .def(
          "write",
          [](const Trajectory& t, const std::filesystem::path& file) { evaluation::WriteTrajectory(file, t.poses); },
          py::arg("file"), Doc("tools/judge/evaluation/trajectory.h:WriteTrajectory"))
      .def("__len__", [](const Trajectory& t) { return t.poses.size(); })
      .def_property_readonly("stamps_ns", &Column<[](const StampedPose& p) { return &p.stamp_ns; }, 1>, "(n,). A view.")
      .def_property_readonly("positions", &Column<[](const StampedPose& p) { return p.p_WC.data(); }, 3>,
                             "(n, 3) [m]. A view.")
      .def_property_readonly("orientations", &Column<[](const StampedPose& p) { return p.q_WC.coeffs().data(); }, 4>,
                             "(n, 4): (x, y, z, w). A view.")
      .def_property_readonly(
          "path_length", [](const Trajectory& t) { return evaluation::PathLength(t.poses); },
          Doc("tools/judge/evaluation/trajectory.h:PathLength"));

  py::class_<evaluation::Statistics>(m, "Statistics", Doc("tools/judge/evaluation/statistics.h:Statistics"))
      .def_readonly("count", &evaluation::Statistics::count)
      .def_readonly("rmse", &evaluation::Statistics::rmse)
      .def_readonly("mean", &evaluation::Statistics::mean)
      .def_readonly("median", &evaluation::Statistics::median)
      .def_readonly("std", &evaluation::Statistics::std, Doc("tools/judge/evaluation/statistics.h:Statistics::std"))
      .def_readonly("min", &evaluation::Statistics::min)
      .def_readonly("max", &evaluation::Statistics::max);

  py::class_<evaluation::Ate>(m, "Ate", Doc("tools/judge/evaluation/ate.h:"))
      .def_readonly("position", &evaluation::Ate::position, "[m]")
      .def_readonly("orientation", &evaluation::Ate::orientation, "[rad]")
      .def_property_readonly(
          "position_errors", [](const evaluation::Ate& a) { return Copy(a.position_errors); }, "per pair [m]")
      .def_property_readonly(
          "orientation_errors", [](const evaluation::Ate& a) { return Copy(a.orientation_errors); },
          "per pair [rad]; empty if the rotation is undetermined")
      .def_property_readonly(
          "scale", [](const evaluation::Ate& a) { return a.similarity.scale; }, "X_truth ~ scale * R * X_estimate + t")
      .def_property_readonly("R", [](const evaluation::Ate& a) { return a.similarity.R; })
      .def_property_readonly(
          "t", [](const evaluation::Ate& a) { return a.similarity.t; }, "[m]");
  m.def("ate", &AteOf, py::arg("estimate"), py::arg("truth"), py::arg("align") = "sim3", py::arg("gap_s") = 0.02,
        Unlocked(), Doc("tools/judge/evaluation/ate.h:"));

  py::class_<evaluation::Rpe>(m, "Rpe", Doc("tools/judge/evaluation/rpe.h:"))
      .def_readonly("position", &evaluation::Rpe::position_statistics, "[m]")
      .def_readonly("orientation", &evaluation::Rpe::orientation_statistics, "[rad]")
      .def_property_readonly(
          "position_errors", [](const evaluation::Rpe& r) { return Copy(r.position); }, "per pair [m]")
      .def_property_readonly(
          "orientation_errors", [](const evaluation::Rpe& r) { return Copy(r.orientation); }, "per pair [rad]");
  m.def("rpe", &RpeOf, py::arg("estimate"), py::arg("truth"), py::arg("delta_s") = 1.0, py::arg("scale") = 1.0,
        py::arg("gap_s") = 0.02, Unlocked(), Doc("tools/judge/evaluation/rpe.h:"));
}

}  // namespace vobench::python
