#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "tools/bench/points/point_consistency.h"
#include "tools/judge/evaluation/anees_test.h"
#include "tools/judge/evaluation/distributions.h"
#include "tools/python/module.h"
#include "vo/odometry.h"

namespace vobench::python {
namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Nees = std::vector<std::vector<double>>;  // [run][frame]

PointEstimate ToPointEstimate(const vo::Estimate& e) {
  return {e.pose.p_WC, e.pose.q_WC, e.v_WC, e.w_WC_C, e.covariance};
}

// Owner of a Python object that may be released by threads without the interpreter lock.
std::shared_ptr<py::object> Keep(py::object object) {
  return {new py::object(std::move(object)), [](py::object* kept) {
            const py::gil_scoped_acquire locked;
            delete kept;
          }};
}

// Anything with track(stamp_ns, ids, pixels) -> Estimate.
PointFilter FilterOf(py::object filter) {
  return [kept = Keep(std::move(filter))](std::int64_t stamp_ns, const std::vector<sim::PointObservation>& seen) {
    const py::gil_scoped_acquire locked;
    const auto n = static_cast<py::ssize_t>(seen.size());
    py::array_t<std::int64_t> ids(n);
    py::array_t<double> pixels({n, py::ssize_t(2)});
    for (py::ssize_t i = 0; i < n; ++i) {
      ids.mutable_at(i) = seen[i].id;
      pixels.mutable_at(i, 0) = seen[i].x_px;
      pixels.mutable_at(i, 1) = seen[i].y_px;
    }
    const py::object answer = kept->attr("track")(stamp_ns, ids, pixels);
    if (!py::isinstance<vo::Estimate>(answer)) {
      throw py::type_error("track() must return a vobench.Estimate, not " + std::string(py::str(py::type::of(answer))));
    }
    return ToPointEstimate(answer.cast<const vo::Estimate&>());
  };
}

evaluation::ConsistencyVerdict Test(const Scenario& scenario, const py::object& make, int runs, std::uint64_t seed,
                                    double false_alarm) {
  const MakePointFilter maker = [&](const sim::PointWorld& world) {
    const py::gil_scoped_acquire locked;
    return FilterOf(make(PointWorld{scenario, world}));
  };
  const py::gil_scoped_release unlocked;
  return TestConsistency(scenario->scenario, maker, {runs, seed, false_alarm});
}

PointPlay PlayWorld(PointWorld& world, const py::object& filter) {
  const PointFilter tracked = FilterOf(filter);
  const py::gil_scoped_release unlocked;
  return Play(world.world, tracked);
}

// Estimates from another program, each with the truth of its time.
PointPlay Together(const std::vector<vo::Estimate>& estimates, const std::vector<StampedTruth>& truths) {
  if (estimates.size() != truths.size()) {
    throw std::invalid_argument(std::to_string(estimates.size()) + " estimates, but " + std::to_string(truths.size()) +
                                " truths");
  }
  PointPlay play;
  for (std::size_t k = 0; k < truths.size(); ++k) {
    const vo::Estimate& e = estimates[k];
    const std::int64_t stamp_ns = truths[k].stamp_ns;
    if (k > 0 && stamp_ns <= truths[k - 1].stamp_ns)
      throw std::invalid_argument("truths[" + std::to_string(k) + "] is not after the one before");
    if (e.stamp_ns != 0 && e.stamp_ns != stamp_ns) {
      throw std::invalid_argument("estimates[" + std::to_string(k) + "] is of another time than truths[" +
                                  std::to_string(k) + "]");
    }
    Append(stamp_ns, truths[k].truth, play.truth);
    play.estimates.trajectory.push_back({stamp_ns, e.pose.p_WC, e.pose.q_WC});
    play.estimates.beliefs.push_back({{stamp_ns, e.v_WC, e.w_WC_C}, e.covariance});
  }
  return play;
}

Numbers Errors(const PointPlay& play, evaluation::Vector12d evaluation::FrameConsistency::*member) {
  const std::vector<evaluation::FrameConsistency> frames = ConsistencyOf(play);
  Numbers rows({py::ssize_t(frames.size()), py::ssize_t(12)});
  for (std::size_t k = 0; k < frames.size(); ++k) std::copy_n((frames[k].*member).data(), 12, rows.mutable_data(k));
  return rows;
}

py::dict NeesOfBlocks(const PointPlay& play) {
  const std::vector<BlockNees> nees = NeesByBlock(play.estimates, ConsistencyOf(play));
  py::dict blocks;
  for (std::size_t b = 0; b < evaluation::kStateBlocks.size(); ++b) {
    py::array_t<double> values(static_cast<py::ssize_t>(nees.size()));
    for (std::size_t k = 0; k < nees.size(); ++k) values.mutable_at(k) = nees[k][b];
    blocks[evaluation::kStateBlocks[b].name] = values;
  }
  return blocks;
}

Numbers NeesOfArrays(const Numbers& errors, const Numbers& covariances) {
  const py::ssize_t d = errors.ndim(), n = d > 0 ? errors.shape(d - 1) : 0;
  bool fits = d > 0 && covariances.ndim() == d + 1 && covariances.shape(d) == n;
  for (py::ssize_t i = 0; fits && i < d; ++i) fits = covariances.shape(i) == errors.shape(i);
  if (!fits || n == 0) throw std::invalid_argument("errors must be (..., n) and covariances (..., n, n)");
  Numbers nees(std::vector<py::ssize_t>(errors.shape(), errors.shape() + d - 1));
  for (py::ssize_t k = 0; k < nees.size(); ++k) {
    nees.mutable_data()[k] = evaluation::Nees(Eigen::Map<const Eigen::VectorXd>(errors.data() + k * n, n),
                                              Eigen::Map<const Eigen::MatrixXd>(covariances.data() + k * n * n, n, n));
  }
  return nees;
}

Nees RunsOf(const Numbers& nees, const char* name) {
  if (nees.ndim() != 2 || nees.size() == 0) throw std::invalid_argument(std::string(name) + " must be (runs, frames)");
  Nees runs;
  for (py::ssize_t m = 0; m < nees.shape(0); ++m) runs.emplace_back(nees.data(m), nees.data(m) + nees.shape(1));
  return runs;
}

int TrialsFor(double false_alarm) {
  if (!(false_alarm > 0 && false_alarm < 0.5)) throw std::invalid_argument("false_alarm must be above 0 and below 0.5");
  return std::max(1000, static_cast<int>(std::ceil(2 / false_alarm)));
}

evaluation::AneesVerdict TestLinear(const Numbers& nees, const evaluation::LinearFilter& reference,
                                    double false_alarm) {
  const Nees runs = RunsOf(nees, "nees");
  const int trials = TrialsFor(false_alarm);
  const py::gil_scoped_release unlocked;
  return evaluation::TestAnees(
      runs, reference.dof(),
      evaluation::ExactAneesOf(reference, static_cast<int>(runs.size()), static_cast<int>(runs.front().size()), trials),
      false_alarm);
}

evaluation::AneesVerdict TestPool(const Numbers& nees, int dof, const Numbers& reference, double false_alarm) {
  const Nees runs = RunsOf(nees, "nees"), pool = RunsOf(reference, "reference");
  if (runs.front().size() != pool.front().size())
    throw std::invalid_argument("nees and reference must have equally many frames");
  const int trials = TrialsFor(false_alarm);
  const py::gil_scoped_release unlocked;
  return evaluation::TestAnees(
      runs, dof, evaluation::ExactAneesOfPool(pool, dof, static_cast<int>(runs.size()), trials), false_alarm);
}

std::string Text(const evaluation::ConsistencyVerdict& verdict) {
  const std::string failed = FailedChecks(verdict);
  return verdict.consistent() ? "consistent: no check failed" : "not consistent:\n" + failed;
}

std::string Text(const evaluation::AneesVerdict& v) {
  std::ostringstream text;
  text.precision(3);
  text << (v.pass() ? "consistent" : "not consistent") << ": ANEES / dof " << v.measured.mean
       << " (an exact filter's: " << v.mean_low << " to " << v.mean_high << "), " << 100 * v.measured.share
       << " % of the frames in their band (at least " << 100 * v.threshold << " %)";
  return text.str();
}

evaluation::LinearFilter::Judged JudgedOf(const std::string& name) {
  using enum evaluation::LinearFilter::Judged;
  if (name == "position") return position;
  if (name == "velocity") return velocity;
  if (name == "both") return both;
  throw std::invalid_argument("judged = " + name + " is none of position, velocity, both");
}

void AddAneesTest(py::module_& m) {
  using evaluation::AneesVerdict;
  using evaluation::LinearFilter;
  py::class_<LinearFilter>(m, "LinearFilter", Doc("tools/judge/evaluation/anees_test.h:LinearFilter"))
      .def(py::init([](int axes, const std::string& judged, double dt, double psd, double sigma_position) {
             return LinearFilter{axes, JudgedOf(judged), dt, psd, sigma_position};
           }),
           py::kw_only(), py::arg("axes") = 3, py::arg("judged") = "position", py::arg("dt") = LinearFilter().dt,
           py::arg("psd") = LinearFilter().psd, py::arg("sigma_position") = LinearFilter().sigma_position)
      .def_property_readonly("dof", &LinearFilter::dof)
      .def_property_readonly("measurement_sigma", &evaluation::MeasurementSigma,
                             Doc("tools/judge/evaluation/anees_test.h:MeasurementSigma"));
  py::class_<AneesVerdict>(m, "AneesVerdict", Doc("tools/judge/evaluation/anees_test.h:AneesVerdict"))
      .def_property_readonly("passed", &AneesVerdict::pass)
      .def_property_readonly(
          "share", [](const AneesVerdict& v) { return v.measured.share; },
          Doc("tools/judge/evaluation/anees_test.h:AneesShare::share"))
      .def_property_readonly(
          "mean", [](const AneesVerdict& v) { return v.measured.mean; },
          Doc("tools/judge/evaluation/anees_test.h:AneesShare::mean"))
      .def_readonly("threshold", &AneesVerdict::threshold,
                    Doc("tools/judge/evaluation/anees_test.h:AneesVerdict::threshold"))
      .def_readonly("mean_low", &AneesVerdict::mean_low,
                    Doc("tools/judge/evaluation/anees_test.h:AneesVerdict::mean_low"))
      .def_readonly("mean_high", &AneesVerdict::mean_high)
      .def_readonly("false_alarm", &AneesVerdict::false_alarm,
                    Doc("tools/judge/evaluation/anees_test.h:AneesVerdict::false_alarm"))
      .def("__bool__", &AneesVerdict::pass)
      .def("__repr__", py::overload_cast<const AneesVerdict&>(&Text));
  m.def("anees_test", &TestLinear, py::arg("nees"), py::arg_v("reference", LinearFilter(), "LinearFilter()"),
        py::arg("false_alarm") = 0.01, Doc("tools/judge/evaluation/anees_test.h:"));
  m.def("anees_test_against", &TestPool, py::arg("nees"), py::arg("dof"), py::arg("reference"),
        py::arg("false_alarm") = 0.01, Doc("tools/judge/evaluation/anees_test.h:ExactAneesOfPool"));
  m.def("nees", &NeesOfArrays, py::arg("errors"), py::arg("covariances"),
        Doc("tools/judge/evaluation/consistency.h:Nees"));
  m.def(
      "chi2_band",
      [](double dof, int runs, double probability) {
        const evaluation::Band band = evaluation::Chi2MeanBand(dof, runs, probability);
        return py::make_tuple(band.low, band.high);
      },
      py::arg("dof"), py::arg("runs") = 1, py::arg("probability") = 0.95,
      Doc("tools/judge/evaluation/distributions.h:Chi2MeanBand"));
}

}  // namespace

void AddConsistency(py::module_& m) {
  AddAneesTest(m);
  py::class_<PointPlay>(m, "Run", "A filter's estimates beside the truth; nothing is aligned.")
      .def_property_readonly("estimate", [](const PointPlay& p) { return Trajectory{p.estimates.trajectory}; })
      .def_property_readonly("truth", [](const PointPlay& p) { return Trajectory{p.truth.poses}; })
      .def_property_readonly(
          "errors", [](const PointPlay& p) { return Errors(p, &evaluation::FrameConsistency::error); },
          "(frames, 12): truth less estimate, dp in W, dphi in C, dv in W, dw in C")
      .def_property_readonly(
          "sigmas", [](const PointPlay& p) { return Errors(p, &evaluation::FrameConsistency::sigma); },
          "(frames, 12): square roots of the covariance's diagonal")
      .def_property_readonly("nees", &NeesOfBlocks, Doc("tools/judge/evaluation/mixture_scores.h:BlockNees"));
  m.def("judge", &Together, py::arg("estimates"), py::arg("truths"), "Estimates, each beside the truth of its time.");
  m.def("play", &PlayWorld, py::arg("world"), py::arg("filter"),
        "Plays what is left of a point world to a filter: anything with track(stamp_ns, ids, pixels) -> Estimate.");

  py::class_<evaluation::Check>(m, "Check", "One of the tests of a verdict.")
      .def_readonly("name", &evaluation::Check::name)
      .def_readonly("value", &evaluation::Check::value)
      .def_readonly("threshold", &evaluation::Check::threshold)
      .def_readonly("at_least", &evaluation::Check::at_least,
                    Doc("tools/judge/evaluation/consistency_verdict.h:Check::at_least"))
      .def_readonly("passed", &evaluation::Check::pass)
      .def_readonly("false_alarm", &evaluation::Check::false_alarm,
                    Doc("tools/judge/evaluation/consistency_verdict.h:Check::false_alarm"));
  py::class_<evaluation::ConsistencyVerdict>(m, "Verdict", Doc("tools/judge/evaluation/consistency_verdict.h:"))
      .def_property_readonly("consistent", &evaluation::ConsistencyVerdict::consistent,
                             Doc("tools/judge/evaluation/consistency_verdict.h:ConsistencyVerdict::consistent"))
      .def_readonly("checks", &evaluation::ConsistencyVerdict::checks)
      .def_property_readonly("false_alarm", &evaluation::ConsistencyVerdict::false_alarm,
                             Doc("tools/judge/evaluation/consistency_verdict.h:ConsistencyVerdict::false_alarm"))
      .def("__bool__", &evaluation::ConsistencyVerdict::consistent)
      .def("__repr__", py::overload_cast<const evaluation::ConsistencyVerdict&>(&Text));
  const ConsistencyOptions defaults;
  m.def("test_consistency", &Test, py::arg("scenario"), py::arg("make"), py::arg("runs") = defaults.runs,
        py::arg("seed") = defaults.seed, py::arg("false_alarm") = defaults.false_alarm,
        Doc("tools/bench/points/point_consistency.h:TestConsistency"));
}

}  // namespace vobench::python
