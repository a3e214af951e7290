#include "sim/sequence/streams.h"

#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <stdexcept>
#include <string_view>

#include "sim/sensor/depth_noise.h"
#include "sim/sequence/flow.h"
#include "sim/sequence/landmarks.h"
#include "sim/sequence/layout.h"
#include "tools/base/settings/quantity.h"
#include "tools/base/text.h"

namespace sim {
namespace {

using Streams = std::set<TruthStream>;

constexpr char kObjectFolder[] = "objects";

// A stream with one file per frame. frame_step: of the other frame that it needs.
struct ImageStream {
  TruthStream stream;
  const char *folder, *extension;
  std::int64_t frame_step;
};
constexpr ImageStream kImageStreams[] = {{TruthStream::depth, "depth", ".png", 0},
                                         {TruthStream::depth_exr, "depth_exr", ".exr", 0},
                                         {TruthStream::depth_kinect, "depth_kinect", ".png", 0},
                                         {TruthStream::distance, "distance", ".exr", 0},
                                         {TruthStream::normals, "normals", ".exr", 0},
                                         {TruthStream::surface_id, "surface_id", ".png", 0},
                                         {TruthStream::moving, "moving", ".png", 0},
                                         {TruthStream::instance, "instance", ".png", 0},
                                         {TruthStream::semantic, "semantic", ".png", 0},
                                         {TruthStream::boxes, "boxes", ".csv", 0},
                                         {TruthStream::disparity, "disparity", ".exr", 0},
                                         {TruthStream::disparity, "disparity_occlusion", ".png", 0},
                                         {TruthStream::flow, "flow", ".flo", 1},
                                         {TruthStream::flow_backward, "flow_backward", ".flo", -1},
                                         {TruthStream::occlusion, "occlusion", ".png", 1},
                                         {TruthStream::occlusion, "occlusion_backward", ".png", -1}};

std::string PathIn(const ImageStream& of, const std::string& stamp) {
  return std::string(of.folder) + "/" + stamp + of.extension;
}

bool HasFrame(const Simulator& simulator, std::int64_t index) { return index >= 0 && index < simulator.frame_count(); }

// Disparity is the first camera's, to the second.
bool IsWanted(const Simulator& simulator, const ImageStream& of, const Streams& streams) {
  return streams.contains(of.stream) && (of.stream != TruthStream::disparity || simulator.camera_index() == 0);
}

// value(p) of each pixel's p.
template <class T, class P, class Function>
std::vector<T> Each(const std::vector<P>& pixels, const Function& value) {
  std::vector<T> values(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) values[i] = static_cast<T>(value(pixels[i]));
  return values;
}

// To the left in the other picture; 0: nothing is seen.
std::vector<float> Disparity(const std::vector<float>& uv) {
  std::vector<float> disparity(uv.size() / 2);
  for (std::size_t i = 0; i < disparity.size(); ++i) disparity[i] = uv[2 * i] == kUnknownFlow ? 0 : -uv[2 * i];
  return disparity;
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

std::string Numbers(const char* format, const glm::dvec3& v) {
  char text[128];
  std::snprintf(text, sizeof text, format, v.x + 0.0, v.y + 0.0, v.z + 0.0);
  return text;
}

std::string ImuYaml(const Scenario& scenario) {
  const ImuParams& imu = scenario.truth.imu;
  const auto number = settings::FormatNumber;
  const glm::dvec3& g = imu.gravity_W;
  return "# X_" + std::string(1, scenario.cameras.empty() ? 'C' : 'B') +
         " = R(orientation) X_I + position; orientation x y z w. Gravity in W [m/s^2].\nrate: " + number(imu.rate_hz) +
         "\n" + PlaceYaml(imu.T_CI, "\n") + "\ngravity: [" + number(g.x) + ", " + number(g.y) + ", " + number(g.z) +
         "]\nreading: " + (imu.reading == ImuReading::mean ? "mean" : "instant") +
         "\n# Continuous-time densities: rad/s/sqrt(Hz), m/s^2/sqrt(Hz), rad/s^2/sqrt(Hz), m/s^3/sqrt(Hz)\n" +
         "gyroscope_noise: " + number(imu.gyroscope_noise) +
         "\naccelerometer_noise: " + number(imu.accelerometer_noise) +
         "\ngyroscope_walk: " + number(imu.gyroscope_walk) + "\naccelerometer_walk: " + number(imu.accelerometer_walk) +
         "\n";
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
    const std::string stamp = base::FormatSeconds(simulator.StampNs(index));
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
  FlowImage flow[2], across;  // to the next frame, to the one before; to the second camera
  std::vector<StreamFile> files;
  constexpr TruthStream kDepths[] = {TruthStream::depth, TruthStream::depth_exr, TruthStream::depth_kinect};
  const bool depth_alone = std::ranges::none_of(kImageStreams, [&](const ImageStream& of) {
    return streams.contains(of.stream) && std::ranges::find(kDepths, of.stream) == std::end(kDepths);
  });
  const auto depth = [&] {
    return depth_alone ? simulator.Depth(index)
                       : Each<float>(points, [](const SurfacePoint& point) { return point.depth; });
  };
  for (const ImageStream& of : kImageStreams) {
    if (!IsWanted(simulator, of, streams) || !HasFrame(simulator, index + of.frame_step)) continue;
    if (points.empty() && !depth_alone) surfaces.Trace(camera, view, points);
    FlowImage& to = flow[of.frame_step < 0];
    if (of.frame_step != 0 && to.uv.empty()) {
      to = FlowBetween(surfaces, camera, points, view, simulator.ViewAt(index + of.frame_step));
    }
    if (of.stream == TruthStream::disparity && across.uv.empty())
      across = FlowBetween(surfaces, camera, points, view, simulator.Cameras()[1].ViewAt(index));
    StreamFile& file = files.emplace_back();
    file.path = PathIn(of, base::FormatSeconds(simulator.StampNs(index)));
    const auto distance = [](const SurfacePoint& point) { return glm::length(point.X_C); };
    const auto moves = [](const SurfacePoint& point) { return point.object != kWorld ? 255 : 0; };
    const auto white = [](int is) { return is != 0 ? 255 : 0; };
    const auto surface_id = [&](const SurfacePoint& point) {
      return point.triangle == kNoTriangle ? 0 : surfaces.MeshOf(point.triangle) + 1;
    };
    const auto class_id = [&](std::uint32_t id) {
      return id == 0 ? 0 : simulator.labels().ClassId(simulator.labels().instances[id - 1]);
    };
    switch (of.stream) {
      case TruthStream::depth:
        file.bytes = EncodeDepthPng(depth(), width, height);
        break;
      case TruthStream::depth_exr:
        file.bytes = EncodeExr(depth(), width, height, 1, false);
        break;
      case TruthStream::depth_kinect:
        file.bytes =
            EncodeDepthPng(WithKinectNoise(depth(), width, height, simulator.scenario().seed, index), width, height);
        break;
      case TruthStream::distance:
        file.bytes = EncodeExr(Each<float>(points, distance), width, height, 1, false);
        break;
      case TruthStream::normals:
        file.bytes = EncodeExr(Normals(surfaces, view, points), width, height, 3, true);
        break;
      case TruthStream::surface_id:
        if (simulator.mesh_names().size() > 65535) throw std::runtime_error("surface_id: more than 65535 meshes");
        file.bytes = EncodePng(width, height, 1, Each<std::uint16_t>(points, surface_id));
        break;
      case TruthStream::instance:
        file.bytes = EncodePng(width, height, 1, InstanceIds(simulator, points));
        break;
      case TruthStream::semantic:
        if (simulator.labels().classes.size() > 255) throw std::runtime_error("semantic: more than 255 classes");
        file.bytes = EncodePng(width, height, 1, Each<std::uint8_t>(InstanceIds(simulator, points), class_id));
        break;
      case TruthStream::boxes:
        file = TextFile(file.path, Boxes(simulator, view, InstanceIds(simulator, points)));
        break;
      case TruthStream::flow:
      case TruthStream::flow_backward:
        file.bytes = EncodeFlo(to.uv, width, height);
        break;
      case TruthStream::moving:
        file.bytes = EncodePng(width, height, 1, Each<std::uint8_t>(points, moves));
        break;
      case TruthStream::occlusion:
        file.bytes = EncodePng(width, height, 1, Each<std::uint8_t>(to.occluded, white));
        break;
      case TruthStream::disparity:
        file.bytes = of.extension == std::string_view(".exr")
                         ? EncodeExr(Disparity(across.uv), width, height, 1, false)
                         : EncodePng(width, height, 1, Each<std::uint8_t>(across.occluded, white));
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
  // A header, and a line of each frame.
  const auto append = [&](const std::string& path, std::string text, const auto& line) {
    for (std::int64_t index = first; index < last; ++index) text += line(index);
    files.push_back(TextFile(path, text));
  };
  for (const ImageStream& of : kImageStreams) {
    if (!IsWanted(simulator, of, streams)) continue;
    append(std::string(of.folder) + ".txt", "# timestamp filename\n", [&](std::int64_t index) {
      const std::string stamp = base::FormatSeconds(simulator.StampNs(index));
      return HasFrame(simulator, index + of.frame_step) ? stamp + " " + PathIn(of, stamp) + "\n" : "";
    });
  }
  for (std::size_t k = 0; k < simulator.object_names().size(); ++k) {
    append(kObjectFolder + ("/" + simulator.object_names()[k]) + ".txt", "# timestamp tx ty tz qx qy qz qw\n",
           [&](std::int64_t index) { return TruthLine(simulator.StampNs(index), simulator.ObjectTruthAt(k, index)); });
  }
  if (streams.contains(TruthStream::surface_id)) {
    std::string legend = "# id mesh; 0: nothing\n";
    for (std::size_t i = 0; i < simulator.mesh_names().size(); ++i) {
      legend += std::to_string(i + 1) + " " + simulator.mesh_names()[i] + "\n";
    }
    files.push_back(TextFile("surfaces.txt", legend));
  }
  using enum TruthStream;
  if (streams.contains(instance) || streams.contains(semantic) || streams.contains(boxes))
    files.push_back(TextFile("labels.json", LabelsJson(simulator.labels())));
  if (streams.contains(TruthStream::acceleration)) {
    append("acceleration.txt", "# timestamp ax ay az alphax alphay alphaz\n",
           [&](std::int64_t index) { return AccelerationLine(simulator.StampNs(index), simulator.TruthAt(index)); });
  }
  if (streams.contains(TruthStream::landmarks)) AppendLandmarks(simulator, first, last, files);
  if (streams.contains(TruthStream::imu)) {
    for (StreamFile& file : ImuStreams(simulator, simulator.StampNs(first),
                                       last > first ? simulator.StampNs(last - 1) : -1))  // of no frame, no reading
      files.push_back(std::move(file));
  }
  return files;
}

std::vector<StreamFile> ImuStreams(const Simulator& simulator, std::int64_t first_ns, std::int64_t last_ns) {
  const ImuParams& imu = simulator.scenario().truth.imu;
  std::string data =
      "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],a_RS_S_y [m "
      "s^-2],a_RS_S_z [m s^-2]\n";
  std::string bias =
      "#timestamp [ns],b_w_RS_S_x [rad s^-1],b_w_RS_S_y [rad s^-1],b_w_RS_S_z [rad s^-1],b_a_RS_S_x [m "
      "s^-2],b_a_RS_S_y [m s^-2],b_a_RS_S_z [m s^-2]\n";
  for (const ImuSample& sample : ImuReadings(*simulator.body(), imu, simulator.scenario().seed, first_ns, last_ns)) {
    const std::string stamp = std::to_string(sample.stamp_ns);
    constexpr const char* kFormat = ",%.12f,%.12f,%.12f";
    data += stamp + Numbers(kFormat, sample.w_I) + Numbers(kFormat, sample.f_I) + "\n";
    bias += stamp + Numbers(kFormat, sample.gyroscope_bias) + Numbers(kFormat, sample.accelerometer_bias) + "\n";
  }
  return {TextFile("imu0/data.csv", data), TextFile("imu0/bias.csv", bias),
          TextFile(kImuYaml, ImuYaml(simulator.scenario()))};
}

std::set<std::string> StreamNames() {
  std::set<std::string> names = {"surfaces.txt",        "labels.json", "acceleration.txt", "landmarks.txt",
                                 "landmark_tracks.txt", "imu0",        kObjectFolder};
  for (const ImageStream& stream : kImageStreams) {
    names.insert(stream.folder);
    names.insert(std::string(stream.folder) + ".txt");
  }
  return names;
}

}  // namespace sim
