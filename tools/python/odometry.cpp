#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>

#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/prior.h"
#include "tools/bench/systems/systems.h"
#include "tools/python/module.h"
#include "vo/point_odometry.h"

namespace vobench::python {
namespace {

using Bytes = py::array_t<std::uint8_t, py::array::c_style>;
using Ids = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
using Pixels = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

vo::Params ParamsOf(const std::string& system, const vo::Params& params) {
  const std::vector<std::string>& names = SystemNames();
  if (std::find(names.begin(), names.end(), system) == names.end()) {
    throw std::invalid_argument("system = " + system + " is none of " + SystemList());
  }
  return ForSystem(system, params);
}

// Of the keys of a scenario's section odometry: "filter.particles".
vo::Params ParamsOf(const std::string& system, const py::dict& settings) {
  settings::Document document = settings::Document::FromText("{}", "settings");
  for (const auto& [key, value] : OverridesOf(settings, "odometry.")) document.Override(key, value);
  vo::Params params;
  ReadOdometry(document.root().Child("odometry"), params);
  document.ThrowIfBad();
  return ParamsOf(system, params);
}

// As `vobench run` starts it: its prior is a function of the seed.
vo::Odometry OdometryOf(const Simulator& simulator, const std::string& system, std::uint64_t seed) {
  const Experiment& experiment = *simulator.scenario;
  const vo::Prior prior = PriorOf(experiment.prior, experiment.scenario.motion, TruthOf(simulator.simulator, 0), seed);
  return {CameraForOdometry(experiment), ParamsOf(system, experiment.odometry), prior, seed};
}

vo::PointOdometry OdometryOf(const PointWorld& world, const std::string& system, std::optional<std::uint64_t> seed) {
  const Experiment& experiment = *world.scenario;
  const std::uint64_t number = seed.value_or(world.world.scenario().seed);
  return {CameraForOdometry(experiment), ParamsOf(system, experiment.odometry),
          PriorOf(experiment.prior, world.world, number), number};
}

vo::Frame FrameOf(std::int64_t stamp_ns, const Bytes& image) {
  const bool colour = image.ndim() == 3 && image.shape(2) == 3;
  if (image.ndim() != 2 && !colour)
    throw std::invalid_argument("an image is an array of (height, width) or (height, width, 3)");
  const cv::Mat pixels(static_cast<int>(image.shape(0)), static_cast<int>(image.shape(1)), colour ? CV_8UC3 : CV_8UC1,
                       const_cast<std::uint8_t*>(image.data()));  // only read
  vo::Frame frame{stamp_ns, {}};
  if (colour) {
    cv::cvtColor(pixels, frame.image, cv::COLOR_RGB2BGR);
  } else {
    frame.image = pixels.clone();
  }
  return frame;
}

vo::PointFrame FrameOf(std::int64_t stamp_ns, const Ids& ids, const Pixels& pixels) {
  if (ids.ndim() != 1 || ids.shape(0) != pixels.rows()) {
    throw std::invalid_argument(std::to_string(ids.size()) + " ids, but " + std::to_string(pixels.rows()) + " pixels");
  }
  vo::PointFrame frame{stamp_ns, {}};
  for (Eigen::Index i = 0; i < pixels.rows(); ++i) frame.observations.push_back({ids.at(i), pixels.row(i)});
  return frame;
}

vo::Estimate MakeEstimate(const vo::Matrix12& covariance, const Eigen::Vector3d& p_WC, const Eigen::Vector4d& q_WC,
                          const Eigen::Vector3d& v_WC, const Eigen::Vector3d& w_WC_C, std::int64_t stamp_ns) {
  return {stamp_ns, {p_WC, Rotation(q_WC)}, v_WC, w_WC_C, covariance, {}};
}

py::tuple Particles(const vo::PointOdometry& self) {
  const std::vector<vo::BeliefComponent>& mixture = self.Mixture();
  const auto n = static_cast<py::ssize_t>(mixture.size());
  py::array_t<double> weight(n), p({n, py::ssize_t(3)}), q({n, py::ssize_t(4)}), velocity({n, py::ssize_t(6)}),
      covariance({n, py::ssize_t(12), py::ssize_t(12)});
  for (py::ssize_t i = 0; i < n; ++i) {
    const vo::BeliefComponent& c = mixture[i];
    weight.mutable_at(i) = c.weight;
    std::copy_n(c.pose.p_WC.data(), 3, p.mutable_data(i));
    std::copy_n(c.pose.q_WC.coeffs().data(), 4, q.mutable_data(i));
    std::copy_n(c.velocity.data(), 6, velocity.mutable_data(i));
    std::copy_n(c.covariance.data(), 144, covariance.mutable_data(i));  // symmetric
  }
  return py::make_tuple(weight, p, q, velocity, covariance);
}

template <class Self>
py::tuple Map(const Self& self) {
  const std::vector<vo::MapPoint> points = self.Map();
  py::array_t<std::int64_t> ids(static_cast<py::ssize_t>(points.size()));
  Rows X_W(points.size(), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ids.mutable_at(i) = points[i].id;
    X_W.row(i) = points[i].X_W;
  }
  return py::make_tuple(ids, X_W);
}

py::tuple Features(const vo::Odometry& self) {
  const std::vector<vo::FeatureView>& views = self.Features();
  const auto n = static_cast<py::ssize_t>(views.size());
  py::array_t<std::int64_t> ids(n), status(n);
  Rows predicted(n, 2), pixel(n, 2);
  py::array_t<double> S({n, py::ssize_t(2), py::ssize_t(2)}), R({n, py::ssize_t(2), py::ssize_t(2)});
  for (py::ssize_t i = 0; i < n; ++i) {
    const vo::FeatureView& view = views[i];
    ids.mutable_at(i) = view.id;
    status.mutable_at(i) = static_cast<std::int64_t>(view.status);
    predicted.row(i) = view.predicted;
    pixel.row(i) = view.pixel;
    std::copy_n(view.S.data(), 4, S.mutable_data(i));  // symmetric
    std::copy_n(view.R.data(), 4, R.mutable_data(i));
  }
  return py::make_tuple(ids, status, predicted, pixel, S, R);
}

// A class with pose and velocity.
template <class State>
py::class_<State> AddState(py::module_& m, const std::string& name, const char* doc) {
  py::class_<State> added(m, name.c_str(), doc);
  added
      .def_property_readonly(
          "p_WC", [](const State& s) { return s.pose.p_WC; }, "[m]")
      .def_property_readonly(
          "q_WC", [](const State& s) -> Eigen::Vector4d { return s.pose.q_WC.coeffs(); }, "(x, y, z, w)")
      .def_readwrite("v_WC", &State::v_WC, Doc("vo/base/result.h:" + name + "::v_WC"))
      .def_readwrite("w_WC_C", &State::w_WC_C, Doc("vo/base/result.h:" + name + "::w_WC_C"));
  return added;
}

void AddEstimate(py::module_& m) {
  const auto zero = [] { return Eigen::Vector3d(0, 0, 0); };
  const Eigen::Vector4d identity(0, 0, 0, 1);
  AddState<vo::Prior>(m, "Prior", Doc("vo/base/result.h:Prior"))
      .def(py::init([](const Eigen::Vector3d& p_WC, const Eigen::Vector4d& q_WC, const Eigen::Vector3d& v_WC,
                       const Eigen::Vector3d& w_WC_C, const std::optional<vo::Matrix6>& pose_covariance,
                       const std::optional<vo::Matrix6>& velocity_covariance) {
             vo::Prior prior{{p_WC, Rotation(q_WC)}, v_WC, w_WC_C};
             if (pose_covariance) prior.pose_covariance = *pose_covariance;
             if (velocity_covariance) prior.velocity_covariance = *velocity_covariance;
             return prior;
           }),
           py::kw_only(), py::arg("p_WC") = zero(), py::arg("q_WC") = identity, py::arg("v_WC") = zero(),
           py::arg("w_WC_C") = zero(), py::arg("pose_covariance") = py::none(),
           py::arg("velocity_covariance") = py::none())
      .def_readwrite("pose_covariance", &vo::Prior::pose_covariance)
      .def_readwrite("velocity_covariance", &vo::Prior::velocity_covariance);
  py::class_<vo::NumericalEvents>(m, "NumericalEvents", Doc("vo/base/result.h:NumericalEvents"))
      .def_readonly("not_converged", &vo::NumericalEvents::not_converged,
                    Doc("vo/base/result.h:NumericalEvents::not_converged"))
      .def_readonly("behind_camera", &vo::NumericalEvents::behind_camera,
                    Doc("vo/base/result.h:NumericalEvents::behind_camera"))
      .def_readonly("not_positive_definite", &vo::NumericalEvents::not_positive_definite,
                    Doc("vo/base/result.h:NumericalEvents::not_positive_definite"))
      .def_readonly("non_finite_weight", &vo::NumericalEvents::non_finite_weight,
                    Doc("vo/base/result.h:NumericalEvents::non_finite_weight"));
  py::class_<vo::FrameDiagnostics>(m, "Diagnostics", "What an odometry did in a frame.")
      .def_readonly("searched", &vo::FrameDiagnostics::searched, Doc("vo/base/result.h:FrameDiagnostics::searched"))
      .def_readonly("matched", &vo::FrameDiagnostics::matched, Doc("vo/base/result.h:FrameDiagnostics::matched"))
      .def_readonly("landmarks", &vo::FrameDiagnostics::landmarks, Doc("vo/base/result.h:FrameDiagnostics::landmarks"))
      .def_readonly("nis", &vo::FrameDiagnostics::nis, Doc("vo/base/result.h:FrameDiagnostics::nis"))
      .def_readonly("nis_dof", &vo::FrameDiagnostics::nis_dof)
      .def_readonly("effective_particles", &vo::FrameDiagnostics::effective_particles,
                    Doc("vo/base/result.h:FrameDiagnostics::effective_particles"))
      .def_readonly("events", &vo::FrameDiagnostics::events, Doc("vo/base/result.h:FrameDiagnostics::events"))
      .def_readonly("repeated", &vo::FrameDiagnostics::repeated, Doc("vo/base/result.h:FrameDiagnostics::repeated"))
      .def_property_readonly("tracked", &vo::FrameDiagnostics::tracked,
                             Doc("vo/base/result.h:FrameDiagnostics::tracked"));
  AddState<vo::Estimate>(m, "Estimate", "What a filter says after a frame: conventions as in docs/conventions.md.")
      .def(py::init(&MakeEstimate), py::kw_only(), py::arg("covariance"), py::arg("p_WC") = zero(),
           py::arg("q_WC") = identity, py::arg("v_WC") = zero(), py::arg("w_WC_C") = zero(), py::arg("stamp_ns") = 0)
      .def_readwrite("stamp_ns", &vo::Estimate::stamp_ns)
      .def_readwrite("covariance", &vo::Estimate::covariance, Doc("vo/base/result.h:Estimate::covariance"))
      .def_readonly("diagnostics", &vo::Estimate::diagnostics);
}

template <class Class>
py::class_<Class> AddClass(py::module_& m, const std::string& name, const std::string& header) {
  py::class_<Class> added(m, name.c_str(), Doc(header));
  added
      .def(py::init([](const vo::Camera& camera, const std::string& system, const py::dict& settings,
                       const vo::Prior& prior,
                       std::uint64_t seed) { return Class(camera, ParamsOf(system, settings), prior, seed); }),
           py::arg("camera"), py::arg("system") = "rb2pf", py::arg("settings") = py::dict(),
           py::arg_v("prior", vo::Prior(), "Prior()"), py::arg("seed") = 1, Doc(header + name + "::" + name))
      .def(
          "reissued",
          [](const Class& self) {
            Trajectory trajectory;
            for (const auto& [stamp_ns, pose] : self.Reissued())
              trajectory.poses.push_back({stamp_ns, pose.p_WC, pose.q_WC});
            return trajectory;
          },
          Doc("vo/odometry.h:Odometry::Reissued"))
      .def("map", &Map<Class>, "(ids, X_W (n, 3)) of the landmarks in the map [m]");
  return added;
}

}  // namespace

void AddOdometry(py::module_& m) {
  m.attr("SYSTEMS") = py::tuple(py::cast(SystemNames()));
  AddEstimate(m);
  AddClass<vo::Odometry>(m, "Odometry", "vo/odometry.h:")
      .def_static("of", py::overload_cast<const Simulator&, const std::string&, std::uint64_t>(&OdometryOf),
                  py::arg("simulator"), py::arg("system") = "rb2pf", py::arg("seed") = 1,
                  "With the scenario's settings and prior, as `vobench run` has it.")
      .def(
          "track", [](vo::Odometry& self, const sim::Frame& frame) { return self.Track(ToOdometry(frame)); },
          py::arg("frame"), Unlocked(), Doc("vo/odometry.h:Odometry::Track"))
      .def("track", py::overload_cast<const vo::Frame&>(&vo::Odometry::Track), py::arg("frame"), Unlocked())
      .def(
          "track",
          [](vo::Odometry& self, std::int64_t stamp_ns, const Bytes& image) {
            const vo::Frame frame = FrameOf(stamp_ns, image);
            const py::gil_scoped_release unlocked;
            return self.Track(frame);
          },
          py::arg("stamp_ns"), py::arg("image"))
      .def("features", &Features,
           "What was seen of each landmark in the last frame: (ids (n,), status (n,): 0 matched, 1 missed, 2 rejected "
           "as an outlier, 3 new; "
           "predicted (n, 2), pixel (n, 2) [px], S (n, 2, 2): covariance of the prediction, R (n, 2, 2): of the "
           "match's error [px^2]).");
  AddClass<vo::PointOdometry>(m, "PointOdometry", "vo/point_odometry.h:")
      .def_static("of",
                  py::overload_cast<const PointWorld&, const std::string&, std::optional<std::uint64_t>>(&OdometryOf),
                  py::arg("world"), py::arg("system") = "rb2pf", py::arg("seed") = py::none(),
                  "With the scenario's settings and prior, as `vobench run` has it; with the world's seed by default.")
      .def(
          "track", [](vo::PointOdometry& self, const sim::PointFrame& frame) { return self.Track(ToOdometry(frame)); },
          py::arg("frame"), Unlocked(), Doc("vo/point_odometry.h:PointOdometry::Track"))
      .def(
          "track",
          [](vo::PointOdometry& self, std::int64_t stamp_ns, const Ids& ids, const Pixels& pixels) {
            const vo::PointFrame frame = FrameOf(stamp_ns, ids, pixels);
            const py::gil_scoped_release unlocked;
            return self.Track(frame);
          },
          py::arg("stamp_ns"), py::arg("ids"), py::arg("pixels"))
      .def("particles", &Particles,
           "What the last estimate is the moments of: (weight (n,), p_WC (n, 3), q_WC (n, 4), velocity (n, 6): v in W, "
           "w in C, "
           "covariance (n, 12, 12)); empty before the first update.");
}

}  // namespace vobench::python
