#include "sim/sequence/layout.h"

#include <glm/geometric.hpp>
#include <glm/gtx/quaternion.hpp>
#include <utility>

#include "tools/base/settings/quantity.h"
#include "tools/base/text.h"

namespace sim {
namespace {

using Frames = std::span<const StampedTruth>;

std::string Line(std::string line, char separator, std::initializer_list<double> numbers) {
  for (const double number : numbers) line += separator + FormatDecimal(number);
  return line + "\n";
}

std::string Distortion(const CameraParams& c) {
  const auto number = settings::FormatNumber;
  const std::string radial = "k1: " + number(c.k1) + ", k2: " + number(c.k2);
  if (c.lens == Lens::fisheye)
    return "{model: fisheye, " + radial + ", k3: " + number(c.k3) + ", k4: " + number(c.k4) + "}";
  return "{" + radial + ", p1: " + number(c.p1) + ", p2: " + number(c.p2) + ", k3: " + number(c.k3) + "}";
}

// ---- TUM RGB-D; the lists of depth and other truth are with their streams (sim/sequence/streams.h). rgb.txt has a
// header of three lines, as TUM's: ORB-SLAM's mono_tum skips three lines without reading them.

// Truth and velocity; of a camera, or of a rig's body.
std::vector<StreamFile> TumTruth(Frames frames) {
  std::string truth = "# timestamp tx ty tz qx qy qz qw\n", velocity = "# timestamp vx vy vz wx wy wz\n";
  for (const StampedTruth& frame : frames) {
    truth += TruthLine(frame.stamp_ns, frame.truth);
    velocity += VelocityLine(frame.stamp_ns, frame.truth);
  }
  return {TextFile("groundtruth.txt", truth), TextFile("velocity.txt", velocity)};
}

std::vector<StreamFile> TumLists(Frames frames) {
  std::string rgb = "# color images\n# made by vobench\n# timestamp filename\n";
  for (const StampedTruth& frame : frames) {
    rgb.append(base::FormatSeconds(frame.stamp_ns)).append(" ");
    rgb.append(NamesOf(Layout::tum, frame.index, frame.stamp_ns).image).append("\n");
  }
  std::vector<StreamFile> files = {TextFile("rgb.txt", rgb)};
  for (StreamFile& file : TumTruth(frames)) files.push_back(std::move(file));
  return files;
}

std::string RigYaml(const Scenario& scenario) {
  std::string text =
      "# X_B = R(orientation) X_C + position; orientation x y z w. Frame k is at k / rate + "
      "trigger_offset.\ncameras:\n";
  for (const RigCamera& camera : scenario.cameras) {
    text += "  - {name: " + camera.name + ", " + PlaceYaml(camera.T_BC, ", ") +
            ", trigger_offset: " + settings::FormatNumber(camera.trigger_offset_s) + " s}\n";
  }
  return text;
}

// ---- EuRoC

std::string EurocPlace(const Pose& T_BS) {
  const glm::dmat3 R = glm::mat3_cast(T_BS.q_WC);
  std::string text = "T_BS:\n  cols: 4\n  rows: 4\n  data: [";
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) text += FormatDecimal(R[column][row]) + ", ";
    text += FormatDecimal(T_BS.p_WC[row]) + ",\n         ";
  }
  return text + "0.0, 0.0, 0.0, 1.0]\n";
}

// Kalibr's names.
std::string EurocLens(const CameraParams& c) {
  const auto number = settings::FormatNumber;
  const bool fisheye = c.lens == Lens::fisheye;
  return std::string("distortion_model: ") + (fisheye ? "equidistant" : "radial-tangential") +
         "\ndistortion_coefficients: [" + number(c.k1) + ", " + number(c.k2) + ", " + number(fisheye ? c.k3 : c.p1) +
         ", " + number(fisheye ? c.k4 : c.p2) + "]\n";
}

std::string EurocCamera(const std::string& comment, const Scenario& scenario, std::size_t camera) {
  const auto number = settings::FormatNumber;
  const CameraParams& c = scenario.camera;
  return "sensor_type: camera\ncomment: " + comment + "\n" +
         EurocPlace(EurocBody(scenario).OfCamera(scenario, camera)) + "rate_hz: " + number(scenario.time.rate_hz) +
         "\nresolution: [" + std::to_string(c.width) + ", " + std::to_string(c.height) +
         "]\ncamera_model: pinhole\nintrinsics: [" + number(c.fx) + ", " + number(c.fy) + ", " + number(c.cx) + ", " +
         number(c.cy) + "]  # fu, fv, cu, cv\n" + EurocLens(c);
}

std::string EurocImu(const ImuParams& imu) {
  const auto number = settings::FormatNumber;
  return "sensor_type: imu\ncomment: simulated\n" + EurocPlace({}) + "rate_hz: " + number(imu.rate_hz) +
         "\ngyroscope_noise_density: " + number(imu.gyroscope_noise) +
         "  # rad/s/sqrt(Hz)\ngyroscope_random_walk: " + number(imu.gyroscope_walk) +
         "  # rad/s^2/sqrt(Hz)\naccelerometer_noise_density: " + number(imu.accelerometer_noise) +
         "  # m/s^2/sqrt(Hz)\naccelerometer_random_walk: " + number(imu.accelerometer_walk) + "  # m/s^3/sqrt(Hz)\n";
}

std::string EurocTruthLine(const StampedTruth& frame) {
  const Truth& t = frame.truth;
  const glm::dvec3 &w = frame.gyroscope_bias, &a = frame.accelerometer_bias;
  return Line(std::to_string(frame.stamp_ns), ',',
              {t.p_WC.x, t.p_WC.y, t.p_WC.z, t.q_WC.w, t.q_WC.x, t.q_WC.y, t.q_WC.z, t.v_WC.x, t.v_WC.y, t.v_WC.z, w.x,
               w.y, w.z, a.x, a.y, a.z});
}

std::vector<StreamFile> EurocLists(const Scenario& scenario, Frames frames, std::size_t camera) {
  std::string images = "#timestamp [ns],filename\n";
  for (const StampedTruth& frame : frames) {
    const std::string stamp = std::to_string(frame.stamp_ns);
    images.append(stamp).append(",").append(stamp).append(".png\n");
  }
  const std::string k = std::to_string(camera);
  return {
      TextFile("mav0/cam" + k + "/data.csv", images),
      TextFile("mav0/cam" + k + "/sensor.yaml", EurocCamera("simulated camera", scenario, camera)),
      TextFile("mav0/depth" + k + "/data.csv", images),
      TextFile("mav0/depth" + k + "/sensor.yaml",
               EurocCamera("depth of cam" + k + "'s pixels along its optical axis, 16 bits, metres x 5000, 0 = none",
                           scenario, camera))};
}

std::vector<StreamFile> EurocBodyLists(const Scenario& scenario, Frames body) {
  const bool imu = scenario.truth.streams.contains(TruthStream::imu);
  std::string truth =
      "#timestamp,p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z [],v_RS_R_x [m s^-1],"
      "v_RS_R_y [m s^-1],v_RS_R_z [m s^-1],b_w_RS_S_x [rad s^-1],b_w_RS_S_y [rad s^-1],b_w_RS_S_z [rad s^-1],"
      "b_a_RS_S_x [m s^-2],b_a_RS_S_y [m s^-2],b_a_RS_S_z [m s^-2]\n";
  for (const StampedTruth& frame : body) truth += EurocTruthLine(frame);
  const std::string frame = imu ? "the IMU" : scenario.cameras.empty() ? "that of cam0" : "that of the rig";
  std::vector<StreamFile> files = {
      TextFile("mav0/body.yaml", "comment: The body frame is " + frame + ".\n"),
      TextFile("mav0/state_groundtruth_estimate0/data.csv", truth),
      TextFile("mav0/state_groundtruth_estimate0/sensor.yaml",
               std::string("sensor_type: visual-inertial\ncomment: exact; its world has gravity along -") +
                   (imu ? "z" : "y") + "\n" + EurocPlace({}))};
  if (imu) files.push_back(TextFile("mav0/imu0/sensor.yaml", EurocImu(scenario.truth.imu)));
  return files;
}

// ---- ICL-NUIM: the truth belongs to a camera with fy < 0, whose y points up: mirrored in y, S T S with
// S = diag(1, -1, 1).

Truth MirroredInY(Truth truth) {
  truth.p_WC.y = -truth.p_WC.y;
  truth.q_WC.x = -truth.q_WC.x;  // a rotation's axis is a pseudo-vector
  truth.q_WC.z = -truth.q_WC.z;
  return truth;
}

std::vector<StreamFile> IclLists(Frames frames) {
  std::string associations, truth;
  for (const StampedTruth& frame : frames) {
    const std::string index = std::to_string(frame.index);
    const FrameNames names = NamesOf(Layout::icl, frame.index, frame.stamp_ns);
    associations += index + " " + names.depth + " " + index + " " + names.image + "\n";
    const std::string line = TruthLine(0, MirroredInY(frame.truth));
    truth += index + line.substr(line.find(' '));
  }
  return {TextFile("associations.txt", associations), TextFile("traj.gt.freiburg", truth)};
}

}  // namespace

std::string FormatDecimal(double number) {
  const std::string text = base::Fixed(number, 12);
  return text == "-0.000000000000" ? text.substr(1) : text;
}

std::string PlaceYaml(const Pose& T, const std::string& between) {
  const auto number = settings::FormatNumber;
  const auto& [p, q] = T;
  return "position: [" + number(p.x) + ", " + number(p.y) + ", " + number(p.z) + "]" + between + "orientation: [" +
         number(q.x) + ", " + number(q.y) + ", " + number(q.z) + ", " + number(q.w) + "]";
}

std::string TruthLine(std::int64_t stamp_ns, const Truth& t) {
  return Line(base::FormatSeconds(stamp_ns), ' ',
              {t.p_WC.x, t.p_WC.y, t.p_WC.z, t.q_WC.x, t.q_WC.y, t.q_WC.z, t.q_WC.w});
}

std::string ExposureLine(std::int64_t stamp_ns, const ExposureSetting& setting) {
  return Line(base::FormatSeconds(stamp_ns), ' ', {setting.exposure_s, setting.gain});
}

std::string VelocityLine(std::int64_t stamp_ns, const Truth& t) {
  return Line(base::FormatSeconds(stamp_ns), ' ', {t.v_WC.x, t.v_WC.y, t.v_WC.z, t.w_WC_C.x, t.w_WC_C.y, t.w_WC_C.z});
}

std::string AccelerationLine(std::int64_t stamp_ns, const Truth& t) {
  return Line(base::FormatSeconds(stamp_ns), ' ',
              {t.a_WC.x, t.a_WC.y, t.a_WC.z, t.alpha_WC_C.x, t.alpha_WC_C.y, t.alpha_WC_C.z});
}

std::string CameraYaml(const CameraParams& c, std::optional<double> readout_s) {
  const auto number = settings::FormatNumber;
  return "width: " + std::to_string(c.width) + "\nheight: " + std::to_string(c.height) + "\nfx: " + number(c.fx) +
         "\nfy: " + number(c.fy) + "\ncx: " + number(c.cx) + "\ncy: " + number(c.cy) +
         "\ndistortion: " + Distortion(c) + "\n" + (readout_s ? "rolling_shutter: " + number(*readout_s) + " s\n" : "");
}

std::string ToString(Layout layout) {
  return layout == Layout::tum ? "tum" : layout == Layout::euroc ? "euroc" : "icl";
}

std::vector<std::string> Problems(Layout layout, const Scenario& scenario) {
  for (const RigCamera& of : AllCameras(scenario)) {
    if (layout == Layout::euroc && of.camera.lens == Lens::radial_tangential && of.camera.k3 != 0)
      return {"the euroc layout has no place for the camera's k3 = " + settings::FormatNumber(of.camera.k3)};
  }
  if (layout == Layout::icl && scenario.cameras.size() > 1) return {"the icl layout has one camera"};
  if (layout == Layout::icl && scenario.time.rate_hz != 30) {
    return {"the icl layout has no time stamps, its frames are 1/30 s apart: time.rate = " +
            settings::FormatNumber(scenario.time.rate_hz) + " Hz must be 30 Hz"};
  }
  return {};
}

FrameNames NamesOf(Layout layout, std::int64_t index, std::int64_t stamp_ns, std::size_t camera) {
  if (layout == Layout::euroc) {
    const std::string k = std::to_string(camera), name = "/data/" + std::to_string(stamp_ns) + ".png";
    return {"mav0/cam" + k + name, "mav0/depth" + k + name};
  }
  const std::string name = (layout == Layout::tum ? base::FormatSeconds(stamp_ns) : std::to_string(index)) + ".png";
  return {"rgb/" + name, "depth/" + name};
}

EurocBody::EurocBody(const Scenario& scenario) {
  if (!scenario.truth.streams.contains(TruthStream::imu)) return;
  T_BS = scenario.truth.imu.T_CI;
  const glm::dvec3& g = scenario.truth.imu.gravity_W;
  if (glm::length(g) > 0) q_RW = glm::rotation(glm::normalize(g), glm::dvec3(0, 0, -1));
}

Pose EurocBody::OfCamera(const Scenario& scenario, std::size_t camera) const {
  const Pose T_BC = AllCameras(scenario)[camera].T_BC;
  const glm::dquat q_SB = glm::conjugate(T_BS.q_WC);
  return {q_SB * (T_BC.p_WC - T_BS.p_WC), q_SB * T_BC.q_WC};
}

std::vector<StreamFile> Lists(Layout layout, const Scenario& scenario, Frames frames, std::size_t camera) {
  if (layout == Layout::tum) return TumLists(frames);
  return layout == Layout::euroc ? EurocLists(scenario, frames, camera) : IclLists(frames);
}

std::vector<StreamFile> BodyLists(Layout layout, const Scenario& scenario, Frames body) {
  if (layout == Layout::euroc) return EurocBodyLists(scenario, body);
  if (layout == Layout::icl || scenario.cameras.empty()) return {};
  std::vector<StreamFile> files = TumTruth(body);
  files.push_back(TextFile("rig.yaml", RigYaml(scenario)));
  return files;
}

}  // namespace sim
