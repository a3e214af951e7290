// The Python module vobench._core; tools/python/vobench/__init__.py is what users import.
#include "tools/python/module.h"

#include <cmath>
#include <stdexcept>

#include "sim/world/scene.h"
#include "tools/base/settings/problem.h"
#include "tools/judge/evaluation/text_file.h"

namespace vobench::python {
namespace {

struct Entry {
  const char *key, *text;
};
constexpr Entry kDocs[] = {
#include "docstrings.inc"
};

}  // namespace

const char* Doc(const std::string& key) {
  for (const Entry& entry : kDocs) {
    if (entry.key == key) return entry.text;
  }
  throw std::logic_error("no documentation of " + key);
}

void AddErrors(py::module_& m) {
  py::register_exception<settings::Error>(m, "SettingsError", PyExc_ValueError).doc() =
      Doc("tools/base/settings/problem.h:");
  py::register_exception<sim::SceneError>(m, "SceneError", PyExc_ValueError).doc() =
      Doc("sim/world/scene.h:SceneError");
  py::register_exception<evaluation::InputError>(m, "InputError", PyExc_ValueError).doc() =
      Doc("tools/judge/evaluation/text_file.h:InputError");
}

Eigen::Quaterniond Rotation(const Eigen::Vector4d& xyzw) {
  if (!(std::abs(xyzw.norm() - 1) < 1e-6)) {
    throw std::invalid_argument("the quaternion (x, y, z, w) is not a unit one: its norm is " +
                                std::to_string(xyzw.norm()));
  }
  return Eigen::Quaterniond(xyzw);
}

Overrides OverridesOf(const py::dict& settings, const std::string& prefix) {
  const py::object json = py::module_::import("json").attr("dumps");  // JSON is YAML
  Overrides overrides;
  for (const auto& [key, value] : settings) {
    const bool word = py::isinstance<py::str>(value);
    overrides.emplace_back(prefix + key.cast<std::string>(), (word ? py::str(value) : json(value)).cast<std::string>());
  }
  return overrides;
}

}  // namespace vobench::python

PYBIND11_MODULE(_core, m) {
  m.attr("__version__") = VOBENCH_VERSION;
  vobench::python::AddErrors(m);
  vobench::python::AddScenario(m);
  vobench::python::AddFrames(m);
  vobench::python::AddOdometry(m);
  vobench::python::AddErrorMeasures(m);
  vobench::python::AddConsistency(m);
}
