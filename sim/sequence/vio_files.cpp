#include "sim/sequence/vio_files.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>

#include "sim/sequence/vio_templates.h"

namespace sim {
namespace {

using Values = std::map<std::string, std::string>;

// @name@ by its value. What is between "@for all@" and "@end@" is for each camera; `pair`: the first two, `first`,
// `second`, `rest`: all but the first.
std::string Filled(std::string text, const Values& values, const std::vector<Values>& cameras) {
  constexpr std::string_view kEnd = "@end@";
  for (std::size_t at = 0; (at = text.find('@', at)) != std::string::npos;) {
    std::size_t end = text.find('@', at + 1) + 1;
    const std::string name = text.substr(at + 1, end - at - 2);
    std::string filled;
    if (name.starts_with("for ")) {
      const std::size_t stop = text.find(kEnd, end), last = name == "for first"                       ? 1
                                                            : name == "for all" || name == "for rest" ? cameras.size()
                                                                                                      : 2;
      for (std::size_t k = name == "for second" || name == "for rest" ? 1 : 0; k < std::min(cameras.size(), last); ++k)
        filled += Filled(text.substr(end, stop - end), cameras[k], {});
      end = stop + kEnd.size();
    } else {
      filled = values.at(name);
    }
    text.replace(at, end - at, filled);
    at += filled.size();
  }
  return text;
}

std::string Row(const Pose& T, int row) {
  const glm::dmat3 R = glm::mat3_cast(T.q_WC);
  std::string text;
  for (int column = 0; column < 3; ++column) text += FormatDecimal(R[column][row]) + ", ";
  return text + FormatDecimal(T.p_WC[row]);
}

// A^-1 B.
Pose FromTo(const Pose& A, const Pose& B) {
  const glm::dquat q = glm::conjugate(A.q_WC);
  return {q * (B.p_WC - A.p_WC), q * B.q_WC};
}

Values CameraValues(const CameraParams& c, const std::vector<Pose>& T_imu_cam, std::size_t k) {
  const bool fisheye = c.lens == Lens::fisheye;
  const Pose& T = T_imu_cam[k];
  const double d2 = fisheye ? c.k3 : c.p1, d3 = fisheye ? c.k4 : c.p2;
  Values v = {{"k", std::to_string(k)},
              {"n", std::to_string(k + 1)},
              {"comma", k > 0 ? "," : ""},
              {"overlaps", ""},
              {"width", std::to_string(c.width)},
              {"height", std::to_string(c.height)},
              {"kalibr_lens", fisheye ? "equidistant" : "radtan"},
              {"orb_d2", fisheye ? "k3" : "p1"},
              {"orb_d3", fisheye ? "k4" : "p2"}};
  for (const auto& [name, number] : std::initializer_list<std::pair<const char*, double>>{{"fx", c.fx},
                                                                                          {"fy", c.fy},
                                                                                          {"cx", c.cx},
                                                                                          {"cy", c.cy},
                                                                                          {"d0", c.k1},
                                                                                          {"d1", c.k2},
                                                                                          {"d2", d2},
                                                                                          {"d3", d3},
                                                                                          {"px", T.p_WC.x},
                                                                                          {"py", T.p_WC.y},
                                                                                          {"pz", T.p_WC.z},
                                                                                          {"qx", T.q_WC.x},
                                                                                          {"qy", T.q_WC.y},
                                                                                          {"qz", T.q_WC.z},
                                                                                          {"qw", T.q_WC.w}})
    v[name] = FormatDecimal(number);
  const bool straight = !fisheye && c.k1 == 0 && c.k2 == 0 && c.p1 == 0 && c.p2 == 0;
  const std::string radial = R"(, "k1": )" + v["d0"] + R"(, "k2": )" + v["d1"];
  v["basalt_lens"] = fisheye ? "kb4" : straight ? "pinhole" : "pinhole-radtan8";
  v["basalt_d"] = fisheye    ? radial + R"(, "k3": )" + v["d2"] + R"(, "k4": )" + v["d3"]
                  : straight ? ""
                             : radial + R"(, "p1": )" + v["d2"] + R"(, "p2": )" + v["d3"] +
                                   R"(, "k3": 0.0, "k4": 0.0, "k5": 0.0, "k6": 0.0, "rpmax": 0.0)";
  for (const auto& [name, pose] :
       std::initializer_list<std::pair<std::string, Pose>>{{"T_imu_cam", T},
                                                           {"T_cam_imu", FromTo(T, {})},
                                                           {"T_cam0_cam", FromTo(T_imu_cam[0], T)},
                                                           {"T_cam_before", FromTo(T, T_imu_cam[k > 0 ? k - 1 : 0])}}) {
    for (int row = 0; row < 3; ++row) v[name] += (v[name + "_" + std::to_string(row)] = Row(pose, row)) + ", ";
    v[name] += "0.0, 0.0, 0.0, 1.0";
  }
  for (std::size_t other = 0; other < T_imu_cam.size(); ++other)
    if (other != k) v["overlaps"] += (v["overlaps"].empty() ? "" : ", ") + std::to_string(other);
  return v;
}

}  // namespace

std::vector<StreamFile> VioFiles(const Scenario& scenario, std::span<const StampedTruth> first) {
  if (!scenario.truth.streams.contains(TruthStream::imu)) return {};
  const EurocBody body(scenario);
  const std::size_t count = std::max<std::size_t>(1, scenario.cameras.size());
  std::vector<Pose> T_imu_cam;
  for (std::size_t k = 0; k < count; ++k) T_imu_cam.push_back(body.OfCamera(scenario, k));
  std::vector<Values> cameras;
  for (std::size_t k = 0; k < count; ++k)
    cameras.push_back(
        CameraValues(scenario.cameras.empty() ? scenario.camera : scenario.cameras[k].camera, T_imu_cam, k));
  // No filter takes a density of 0: those of EuRoC's IMU then.
  const ImuParams& imu = scenario.truth.imu;
  const auto density = [](double given, double else_this) { return FormatDecimal(given > 0 ? given : else_this); };
  Values values = cameras[0];
  values.insert({{"cameras", std::to_string(count)},
                 {"pair", count > 1 ? "2" : "1"},
                 {"stereo", count > 1 ? "true" : "false"},
                 {"gyr_noise", density(imu.gyroscope_noise, 1.6968e-4)},
                 {"gyr_walk", density(imu.gyroscope_walk, 1.9393e-5)},
                 {"acc_noise", density(imu.accelerometer_noise, 2e-3)},
                 {"acc_walk", density(imu.accelerometer_walk, 3e-3)},
                 {"imu_rate", FormatDecimal(imu.rate_hz)},
                 {"gravity", FormatDecimal(glm::length(imu.gravity_W))},
                 {"track_rate", FormatDecimal(scenario.time.rate_hz + 1)},
                 {"whole_rate", std::to_string(std::lround(scenario.time.rate_hz))},
                 {"orb_lens", scenario.camera.lens == Lens::fisheye ? "KannalaBrandt8" : "PinHole"}});
  std::vector<StreamFile> files;
  const auto add = [&](const std::string& path, const std::string& text, const Values& with) {
    files.push_back(TextFile("configs/" + path, Filled(text, with, cameras)));
  };
  add("kalibr/camchain-imucam.yaml", kKalibrImucamChain, values);
  add("openvins/kalibr_imucam_chain.yaml", std::string("%YAML:1.0\n\n") + kKalibrImucamChain, values);
  add("openvins/kalibr_imu_chain.yaml", kKalibrImuChain, values);
  add("openvins/estimator_config.yaml", kEstimatorConfig, values);
  add("vins_fusion/config.yaml", kVinsConfig, values);
  for (std::size_t k = 0; k < std::min<std::size_t>(2, count); ++k)
    add("vins_fusion/cam" + std::to_string(k) + ".yaml",
        cameras[k].at("kalibr_lens") == "radtan" ? kVinsPinhole : kVinsFisheye, cameras[k]);
  add("orb_slam3/settings.yaml", kOrbSlam3, values);
  std::string times;
  for (const StampedTruth& frame : first) times += std::to_string(frame.stamp_ns) + "\n";
  add("orb_slam3/times.txt", times, values);
  add("basalt/calibration.json", kBasaltCalibration, values);
  return files;
}

}  // namespace sim
