#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/experiment.h"
#include "tools/python/module.h"
#include "vo/geometry/camera_file.h"

namespace vobench::python {
namespace {

using Points2 = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;
using Points3 = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

Points2 Project(const vo::Camera& camera, const Points3& points) {
  Points2 pixels(points.rows(), 2);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    if (!(points(i, 2) > 0))
      throw std::invalid_argument("point " + std::to_string(i) + " is not in front of the camera");
    pixels.row(i) = camera.Project(points.row(i));
  }
  return pixels;
}

Points2 Undistort(const vo::Camera& camera, const Points2& pixels) {
  Points2 rays(pixels.rows(), 2);
  for (Eigen::Index i = 0; i < pixels.rows(); ++i) rays.row(i) = camera.Undistort(pixels.row(i));
  return rays;
}

Scenario Load(const std::filesystem::path& file, const py::dict& settings, std::optional<std::uint64_t> seed) {
  Overrides overrides = OverridesOf(settings);
  if (seed) overrides.emplace_back("seed", std::to_string(*seed));
  return std::make_shared<Experiment>(LoadExperiment(file, overrides));
}

Eigen::Vector3d Vector(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Eigen::Matrix4d Matrix(const StampedTruth& of) {
  const glm::dquat& q = of.truth.q_WC;
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix();
  T.topRightCorner<3, 1>() = Vector(of.truth.p_WC);
  return T;
}

void AddCamera(py::module_& m) {
  py::class_<vo::Camera> camera(m, "Camera", Doc("vo/geometry/camera.h:"));
  camera.def(py::init<>())
      .def_static("load", &vo::CameraFrom, py::arg("preset_or_file"), Doc("vo/geometry/camera_file.h:CameraFrom"))
      .def_readwrite("width", &vo::Camera::width)
      .def_readwrite("height", &vo::Camera::height);
  const std::pair<const char*, double vo::Camera::*> numbers[] = {
      {"fx", &vo::Camera::fx}, {"fy", &vo::Camera::fy}, {"cx", &vo::Camera::cx}, {"cy", &vo::Camera::cy},
      {"k1", &vo::Camera::k1}, {"k2", &vo::Camera::k2}, {"p1", &vo::Camera::p1}, {"p2", &vo::Camera::p2},
      {"k3", &vo::Camera::k3}, {"k4", &vo::Camera::k4}};
  for (const auto& [name, member] : numbers) camera.def_readwrite(name, member);
  camera.def_property_readonly("fisheye", [](const vo::Camera& c) { return c.lens == vo::Lens::fisheye; })
      .def("project", &Project, py::arg("points"), Doc("vo/geometry/camera.h:Camera::Project"))
      .def("undistort", &Undistort, py::arg("pixels"), Doc("vo/geometry/camera.h:Camera::Undistort"));
}

void AddTruth(py::module_& m) {
  py::class_<StampedTruth> truth(m, "Truth", Doc("sim/motion/trajectory.h:Truth"));
  truth.def_readonly("stamp_ns", &StampedTruth::stamp_ns)
      .def_property_readonly(
          "q_WC",
          [](const StampedTruth& t) {
            const glm::dquat& q = t.truth.q_WC;
            return Eigen::Vector4d(q.x, q.y, q.z, q.w);
          },
          "(x, y, z, w); unit, w >= 0")
      .def_property_readonly("T_WC", &Matrix, "4 x 4, from C to W");
  const std::pair<const char*, glm::dvec3 sim::Truth::*> vectors[] = {{"p_WC", &sim::Truth::p_WC},
                                                                      {"v_WC", &sim::Truth::v_WC},
                                                                      {"w_WC_C", &sim::Truth::w_WC_C},
                                                                      {"a_WC", &sim::Truth::a_WC},
                                                                      {"alpha_WC_C", &sim::Truth::alpha_WC_C}};
  for (const auto& [name, member] : vectors) {
    truth.def_property_readonly(
        name, [member = member](const StampedTruth& t) { return Vector(t.truth.*member); },
        Doc(std::string("sim/motion/trajectory.h:Truth::") + name));
  }
}

}  // namespace

void AddScenario(py::module_& m) {
  AddCamera(m);
  py::list settings;
  for (const auto& [key, value, range, help] : SettingsTable())
    settings.append(py::make_tuple(key, value, range, help));
  m.attr("SETTINGS") = py::tuple(settings);
  AddTruth(m);
  py::class_<Experiment, Scenario>(m, "Scenario", Doc("tools/bench/systems/experiment.h:"))
      .def(py::init(&Load), py::arg("file"), py::arg("settings") = py::dict(), py::arg("seed") = py::none(),
           Doc("sim/scenario/scenario.h:LoadScenario"))
      .def_property_readonly("name", [](const Experiment& e) { return e.scenario.name; })
      .def_property_readonly("seed", [](const Experiment& e) { return e.scenario.seed; })
      .def_property_readonly("rate_hz", [](const Experiment& e) { return e.scenario.time.rate_hz; })
      .def_property_readonly("duration_s", [](const Experiment& e) { return e.scenario.time.duration_s; })
      .def_property_readonly(
          "has_points", [](const Experiment& e) { return e.scenario.points.has_value(); },
          "Landmarks without images: for PointWorld, not for Simulator.")
      .def_property_readonly("camera", [](const Experiment& e) { return CameraOf(e.scenario); })
      .def_property_readonly(
          "resolved", [](const Experiment& e) { return e.resolved; },
          Doc("tools/bench/systems/experiment.h:Experiment::resolved"));
}

}  // namespace vobench::python
