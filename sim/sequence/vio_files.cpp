#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <sstream>

#include "sim/sequence/layout.h"
#include "sim/sequence/vio_templates.h"

namespace sim {
namespace {

using Values = std::map<std::string, std::string>;

// @name@ by its value. What is between "@for A B@" and "@end@" is for each of the cameras A ... B - 1 that there are.
std::string Filled(std::string text, const Values& values, const std::vector<Values>& cameras) {
  constexpr std::string_view kEnd = "@end@";
  for (std::size_t at = 0; (at = text.find('@', at)) != std::string::npos;) {
    std::size_t end = text.find('@', at + 1) + 1;
    const std::string name = text.substr(at + 1, end - at - 2);
    std::string filled;
    if (name.starts_with("for ")) {
      const std::size_t stop = text.find(kEnd, end), last = static_cast<std::size_t>(name[6] - '0');
      for (auto k = static_cast<std::size_t>(name[4] - '0'); k < std::min(cameras.size(), last); ++k)
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

// names: separated by blanks.
void Add(Values& values, const std::string& names, const std::vector<std::string>& texts) {
  std::istringstream words(names);
  std::string name;
  for (const std::string& text : texts) values[(words >> name, name)] = text;
}
void Add(Values& values, const std::string& names, std::initializer_list<double> numbers) {
  std::vector<std::string> texts;
  for (const double number : numbers) texts.push_back(FormatDecimal(number));
  Add(values, names, texts);
}

// A^-1 B, as a matrix and by its rows.
void AddPlace(Values& values, const std::string& name, const Pose& A, const Pose& B) {
  const glm::dquat q_A = glm::conjugate(A.q_WC);
  const glm::dmat3 R = glm::mat3_cast(q_A * B.q_WC);
  const glm::dvec3 p = q_A * (B.p_WC - A.p_WC);
  for (int i = 0; i < 3; ++i) {
    const std::string row = FormatDecimal(R[0][i]) + ", " + FormatDecimal(R[1][i]) + ", " + FormatDecimal(R[2][i]) +
                            ", " + FormatDecimal(p[i]);
    values[name + "_" + std::to_string(i)] = row;
    values[name] += row + ", ";
  }
  values[name] += "0.0, 0.0, 0.0, 1.0";
}

Values CameraValues(const CameraParams& c, const std::vector<Pose>& T_imu_cam, std::size_t k) {
  const bool fisheye = c.lens == Lens::fisheye, straight = !fisheye && c.k1 == 0 && c.k2 == 0 && c.p1 == 0 && c.p2 == 0;
  const glm::dvec3& p = T_imu_cam[k].p_WC;
  const glm::dquat& q = T_imu_cam[k].q_WC;
  Values v;
  Add(v, "k n comma width height",
      {std::to_string(k), std::to_string(k + 1), k > 0 ? "," : "", std::to_string(c.width), std::to_string(c.height)});
  Add(v, "fx fy cx cy d0 d1 d2 d3", {c.fx, c.fy, c.cx, c.cy, c.k1, c.k2, fisheye ? c.k3 : c.p1, fisheye ? c.k4 : c.p2});
  Add(v, "px py pz qx qy qz qw", {p.x, p.y, p.z, q.x, q.y, q.z, q.w});
  Add(v, "kalibr_lens orb_lens orb_d2 orb_d3 basalt_lens overlaps",
      {fisheye ? "equidistant" : "radtan", fisheye ? "KannalaBrandt8" : "PinHole", fisheye ? "k3" : "p1",
       fisheye ? "k4" : "p2",
       Filled(fisheye    ? kBasaltFisheye
              : straight ? kBasaltPinhole
                         : kBasaltRadtan,
              v, {}),
       ""});
  AddPlace(v, "T_imu_cam", {}, T_imu_cam[k]);
  AddPlace(v, "T_cam_imu", T_imu_cam[k], {});
  AddPlace(v, "T_cam0_cam", T_imu_cam[0], T_imu_cam[k]);
  AddPlace(v, "T_cam_before", T_imu_cam[k], T_imu_cam[k > 0 ? k - 1 : 0]);
  for (std::size_t other = 0; other < T_imu_cam.size(); ++other)
    if (other != k) v["overlaps"] += (v["overlaps"].empty() ? "" : ", ") + std::to_string(other);
  return v;
}

}  // namespace

std::vector<StreamFile> VioFiles(const Scenario& scenario, std::span<const StampedTruth> first) {
  if (!scenario.truth.streams.contains(TruthStream::imu)) return {};
  const std::vector<RigCamera> all = AllCameras(scenario);
  const std::size_t count = all.size();
  std::vector<Pose> T_imu_cam;
  for (std::size_t k = 0; k < count; ++k) T_imu_cam.push_back(EurocBody(scenario).OfCamera(scenario, k));
  std::vector<Values> cameras;
  for (std::size_t k = 0; k < count; ++k) cameras.push_back(CameraValues(all[k].camera, T_imu_cam, k));
  Values values = cameras[0];
  Add(values, "cameras pair stereo whole_rate",
      {std::to_string(count), count > 1 ? "2" : "1", count > 1 ? "true" : "false",
       std::to_string(std::lround(scenario.time.rate_hz))});
  // No filter takes a density of 0: those of EuRoC's IMU then.
  const ImuParams& imu = scenario.truth.imu;
  const auto density = [](double given, double else_this) { return given > 0 ? given : else_this; };
  Add(values, "gyr_noise gyr_walk acc_noise acc_walk imu_rate gravity track_rate",
      {density(imu.gyroscope_noise, 1.6968e-4), density(imu.gyroscope_walk, 1.9393e-5),
       density(imu.accelerometer_noise, 2e-3), density(imu.accelerometer_walk, 3e-3), imu.rate_hz,
       glm::length(imu.gravity_W), scenario.time.rate_hz + 1});
  std::string times;
  for (const StampedTruth& frame : first) times += std::to_string(frame.stamp_ns) + "\n";
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
        cameras[k].at("orb_lens") == "PinHole" ? kVinsPinhole : kVinsFisheye, cameras[k]);
  add("orb_slam3/settings.yaml", kOrbSlam3, values);
  add("orb_slam3/times.txt", times, values);
  add("basalt/calibration.json", kBasaltCalibration, values);
  return files;
}

}  // namespace sim
