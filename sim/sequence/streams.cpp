#include "sim/sequence/streams.h"

#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <stdexcept>

#include "sim/render/surface_tracer.h"
#include "sim/sensor/depth_noise.h"
#include "sim/sequence/encode.h"
#include "sim/sequence/flow.h"
#include "sim/sequence/format.h"
#include "sim/sequence/landmarks.h"
#include "sim/sequence/png.h"
#include "tools/base/settings/quantity.h"

namespace sim {
namespace {

using Streams = std::set<TruthStream>;

constexpr char kObjectFolder[] = "objects";

// A stream with one file per frame. frame_step: of the other frame that it needs.
struct ImageStream {
  TruthStream stream;
  std::string folder, extension;
  std::int64_t frame_step;
};
const std::vector<ImageStream>& ImageStreams() {
  static const std::vector<ImageStream> streams = {{TruthStream::depth, "depth", ".png", 0},
                                                   {TruthStream::depth_exr, "depth_exr", ".exr", 0},
                                                   {TruthStream::depth_kinect, "depth_kinect", ".png", 0},
                                                   {TruthStream::distance, "distance", ".exr", 0},
                                                   {TruthStream::normals, "normals", ".exr", 0},
                                                   {TruthStream::surface_id, "surface_id", ".png", 0},
                                                   {TruthStream::moving, "moving", ".png", 0},
                                                   {TruthStream::flow, "flow", ".flo", 1},
                                                   {TruthStream::flow_backward, "flow_backward", ".flo", -1},
                                                   {TruthStream::occlusion, "occlusion", ".png", 1},
                                                   {TruthStream::occlusion, "occlusion_backward", ".png", -1}};
  return streams;
}

bool HasFrame(const Simulator& simulator, std::int64_t index) { return index >= 0 && index < simulator.frame_count(); }

template <class Function>
std::vector<float> Floats(const std::vector<SurfacePoint>& points, const Function& value) {
  std::vector<float> values(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) values[i] = static_cast<float>(value(points[i]));
  return values;
}

// Unit, in C, of the triangle's plane, towards the camera; zero where nothing is seen.
std::vector<float> Normals(const SurfaceTracer& surfaces, const View& view, const std::vector<SurfacePoint>& points) {
  std::vector<float> normals(3 * points.size(), 0.0f);
  const std::vector<Pose> objects = surfaces.ObjectPoses(view.t_s);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].triangle == kNoTriangle) continue;
    glm::dvec3 n = glm::normalize(surfaces.Normal(points[i].triangle));
    if (points[i].object != kWorld) n = objects[static_cast<std::size_t>(points[i].object)].q_WC * n;
    n = glm::conjugate(view.pose.q_WC) * n;
    if (glm::dot(n, points[i].X_C) > 0) n = -n;
    for (int c = 0; c < 3; ++c) normals[3 * i + static_cast<std::size_t>(c)] = static_cast<float>(n[c]);
  }
  return normals;
}

std::vector<std::uint16_t> SurfaceIds(const SurfaceTracer& surfaces, const std::vector<SurfacePoint>& points) {
  std::vector<std::uint16_t> ids(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].triangle == kNoTriangle) continue;
    const std::uint32_t id = surfaces.MeshOf(points[i].triangle) + 1;
    if (id > 65535) throw std::runtime_error("surface_id: the world has more than 65535 meshes");
    ids[i] = static_cast<std::uint16_t>(id);
  }
  return ids;
}

// 255: true.
template <class Function>
std::vector<std::uint8_t> Mask(std::size_t count, const Function& is) {
  std::vector<std::uint8_t> mask(count);
  for (std::size_t i = 0; i < count; ++i) mask[i] = is(i) ? 255 : 0;
  return mask;
}

std::string Numbers(const char* format, const glm::dvec3& v) {
  char text[128];
  std::snprintf(text, sizeof text, format, v.x + 0.0, v.y + 0.0, v.z + 0.0);
  return text;
}

std::string ImuYaml(const ImuParams& imu) {
  const auto number = settings::FormatNumber;
  const glm::dvec3 &p = imu.T_CI.p_WC, &g = imu.gravity_W;
  const glm::dquat& q = imu.T_CI.q_WC;
  return "# X_C = R(orientation) X_I + position; orientation x y z w. Gravity in W [m/s^2].\nrate: " +
         number(imu.rate_hz) + "\nposition: [" + number(p.x) + ", " + number(p.y) + ", " + number(p.z) +
         "]\norientation: [" + number(q.x) + ", " + number(q.y) + ", " + number(q.z) + ", " + number(q.w) +
         "]\ngravity: [" + number(g.x) + ", " + number(g.y) + ", " + number(g.z) +
         "]\nreading: " + (imu.reading == ImuReading::mean ? "mean" : "instant") +
         "\n# Continuous-time densities: rad/s/sqrt(Hz), m/s^2/sqrt(Hz), rad/s^2/sqrt(Hz), m/s^3/sqrt(Hz)\n" +
         "gyroscope_noise: " + number(imu.gyroscope_noise) +
         "\naccelerometer_noise: " + number(imu.accelerometer_noise) +
         "\ngyroscope_walk: " + number(imu.gyroscope_walk) + "\naccelerometer_walk: " + number(imu.accelerometer_walk) +
         "\n";
}

void AppendImu(const Simulator& simulator, std::int64_t first, std::int64_t last, std::vector<StreamFile>& files) {
  const ImuParams& imu = simulator.scenario().truth.imu;
  std::string data =
      "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],a_RS_S_y [m "
      "s^-2],a_RS_S_z [m s^-2]\n";
  std::string bias =
      "#timestamp [ns],b_w_RS_S_x [rad s^-1],b_w_RS_S_y [rad s^-1],b_w_RS_S_z [rad s^-1],b_a_RS_S_x [m "
      "s^-2],b_a_RS_S_y [m s^-2],b_a_RS_S_z [m s^-2]\n";
  const std::int64_t first_ns = simulator.StampNs(first),
                     last_ns = last > first ? simulator.StampNs(last - 1) : first_ns - 1;  // of no frame, no reading
  for (const ImuSample& sample :
       ImuReadings(simulator.trajectory(), imu, simulator.scenario().seed, first_ns, last_ns)) {
    const std::string stamp = std::to_string(sample.stamp_ns);
    constexpr const char* kFormat = ",%.12f,%.12f,%.12f";
    data += stamp + Numbers(kFormat, sample.w_I) + Numbers(kFormat, sample.f_I) + "\n";
    bias += stamp + Numbers(kFormat, sample.gyroscope_bias) + Numbers(kFormat, sample.accelerometer_bias) + "\n";
  }
  files.push_back(TextFile("imu0/data.csv", data));
  files.push_back(TextFile("imu0/bias.csv", bias));
  files.push_back(TextFile(kImuYaml, ImuYaml(imu)));
}

void AppendLandmarks(const Simulator& simulator, std::int64_t first, std::int64_t last,
                     std::vector<StreamFile>& files) {
  const std::vector<SurfaceLandmark> landmarks = SpreadLandmarks(simulator, simulator.scenario().truth.landmarks);
  std::string places = "# id x y z surface_id\n", tracks = "# timestamp id u v visible\n";
  for (std::size_t id = 0; id < landmarks.size(); ++id) {
    places += std::to_string(id) + Numbers(" %.12f %.12f %.12f ", landmarks[id].X_W) +
              std::to_string(landmarks[id].mesh + 1) + "\n";
  }
  for (std::int64_t index = first; index < last; ++index) {
    const std::string stamp = FormatStamp(simulator.StampNs(index));
    for (const LandmarkView& view : ViewsOf(simulator, landmarks, index)) {
      char text[96];
      std::snprintf(text, sizeof text, " %u %.9f %.9f %d\n", view.id, view.pixel.x, view.pixel.y, view.visible ? 1 : 0);
      tracks += stamp + text;
    }
  }
  files.push_back(TextFile("landmarks.txt", places));
  files.push_back(TextFile("landmark_tracks.txt", tracks));
}

}  // namespace

std::vector<StreamFile> FrameStreams(const Simulator& simulator, std::int64_t index, const Streams& streams) {
  const SurfaceTracer& surfaces = simulator.surfaces();
  const Camera& camera = simulator.camera();
  const int width = camera.width(), height = camera.height();
  const View view = simulator.ViewAt(index);
  std::vector<SurfacePoint> points;
  FlowImage flow[2];  // to the next frame, to the one before
  std::vector<StreamFile> files;
  for (const auto& [stream, folder, extension, frame_step] : ImageStreams()) {
    if (!streams.contains(stream) || !HasFrame(simulator, index + frame_step)) continue;
    if (points.empty()) surfaces.Trace(camera, view, points);
    FlowImage& to = flow[frame_step < 0];
    if (frame_step != 0 && to.uv.empty()) {
      to = FlowBetween(surfaces, camera, points, view, simulator.ViewAt(index + frame_step));
    }
    StreamFile& file = files.emplace_back();
    file.path = folder + "/" + FormatStamp(simulator.StampNs(index)) + extension;
    const auto depth = [](const SurfacePoint& point) { return point.depth; };
    const auto distance = [](const SurfacePoint& point) { return glm::length(point.X_C); };
    switch (stream) {
      case TruthStream::depth:
        file.bytes = EncodeDepthPng(Floats(points, depth), width, height);
        break;
      case TruthStream::depth_exr:
        file.bytes = EncodeExr(Floats(points, depth), width, height, 1, false);
        break;
      case TruthStream::depth_kinect:
        file.bytes = EncodeDepthPng(
            WithKinectNoise(Floats(points, depth), width, height, simulator.scenario().seed, index), width, height);
        break;
      case TruthStream::distance:
        file.bytes = EncodeExr(Floats(points, distance), width, height, 1, false);
        break;
      case TruthStream::normals:
        file.bytes = EncodeExr(Normals(surfaces, view, points), width, height, 3, true);
        break;
      case TruthStream::surface_id:
        file.bytes = EncodePng(width, height, 1, SurfaceIds(surfaces, points));
        break;
      case TruthStream::flow:
      case TruthStream::flow_backward:
        file.bytes = EncodeFlo(to.uv, width, height);
        break;
      case TruthStream::moving:
        file.bytes =
            EncodePng(width, height, 1, Mask(points.size(), [&](std::size_t i) { return points[i].object != kWorld; }));
        break;
      case TruthStream::occlusion:
        file.bytes =
            EncodePng(width, height, 1, Mask(to.occluded.size(), [&](std::size_t i) { return to.occluded[i] != 0; }));
        break;
      case TruthStream::landmarks:
      case TruthStream::acceleration:
      case TruthStream::imu:
        throw std::logic_error("FrameStreams: not a stream of images");
    }
  }
  return files;
}

std::vector<StreamFile> SequenceStreams(const Simulator& simulator, std::int64_t first, std::int64_t last,
                                        const Streams& streams) {
  std::vector<StreamFile> files;
  for (const auto& [stream, folder, extension, frame_step] : ImageStreams()) {
    if (!streams.contains(stream)) continue;
    std::string list = "# timestamp filename\n";
    for (std::int64_t index = first; index < last; ++index) {
      if (!HasFrame(simulator, index + frame_step)) continue;
      const std::string stamp = FormatStamp(simulator.StampNs(index));
      list.append(stamp).append(" ").append(folder).append("/").append(stamp).append(extension).append("\n");
    }
    files.push_back(TextFile(folder + ".txt", list));
  }
  for (std::size_t k = 0; k < simulator.object_names().size(); ++k) {
    std::string poses = "# timestamp tx ty tz qx qy qz qw\n";
    for (std::int64_t index = first; index < last; ++index) {
      poses += TruthLine(simulator.StampNs(index), simulator.ObjectTruthAt(k, index));
    }
    files.push_back(TextFile(kObjectFolder + ("/" + simulator.object_names()[k]) + ".txt", poses));
  }
  if (streams.contains(TruthStream::surface_id)) {
    std::string legend = "# id mesh; 0: nothing\n";
    for (std::size_t i = 0; i < simulator.mesh_names().size(); ++i) {
      legend += std::to_string(i + 1) + " " + simulator.mesh_names()[i] + "\n";
    }
    files.push_back(TextFile("surfaces.txt", legend));
  }
  if (streams.contains(TruthStream::acceleration)) {
    std::string acceleration = "# timestamp ax ay az alphax alphay alphaz\n";
    for (std::int64_t index = first; index < last; ++index) {
      acceleration += AccelerationLine(simulator.StampNs(index), simulator.TruthAt(index));
    }
    files.push_back(TextFile("acceleration.txt", acceleration));
  }
  if (streams.contains(TruthStream::landmarks)) AppendLandmarks(simulator, first, last, files);
  if (streams.contains(TruthStream::imu)) AppendImu(simulator, first, last, files);
  return files;
}

std::set<std::string> StreamNames() {
  std::set<std::string> names = {"surfaces.txt", "acceleration.txt", "landmarks.txt", "landmark_tracks.txt",
                                 "imu0",         kObjectFolder};
  for (const ImageStream& stream : ImageStreams()) {
    names.insert(stream.folder);
    names.insert(stream.folder + ".txt");
  }
  return names;
}

}  // namespace sim
