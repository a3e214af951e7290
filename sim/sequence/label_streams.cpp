// Truth streams of labels: instances, boxes, and their legend.
#include <algorithm>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sim/sequence/layout.h"
#include "sim/sequence/streams.h"

namespace sim {

std::vector<std::uint16_t> InstanceIds(const Simulator& simulator, const std::vector<SurfacePoint>& points) {
  const Labels& labels = simulator.labels();
  if (labels.instances.size() > 65535) throw std::runtime_error("instance: the world has more than 65535");
  std::vector<std::uint16_t> ids(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].triangle == kNoTriangle) continue;
    ids[i] = static_cast<std::uint16_t>(labels.of_mesh[simulator.surfaces().MeshOf(points[i].triangle)] + 1);
  }
  return ids;
}

std::string Boxes(const Simulator& simulator, const View& view, const std::vector<std::uint16_t>& ids) {
  struct Seen {
    int left = 1 << 30, top = 1 << 30, right = -1, bottom = -1, pixels = 0;
  };
  const std::vector<Instance>& instances = simulator.labels().instances;
  std::vector<Seen> seen(instances.size());
  const int width = simulator.camera().width();
  for (int i = 0; i < static_cast<int>(ids.size()); ++i) {
    if (ids[static_cast<std::size_t>(i)] == 0) continue;
    Seen& of = seen[ids[static_cast<std::size_t>(i)] - 1U];
    const int x = i % width, y = i / width;
    of = {std::min(of.left, x), std::min(of.top, y), std::max(of.right, x), y, of.pixels + 1};
  }
  const std::vector<Pose> objects = simulator.surfaces().ObjectPoses(view.t_s);
  std::string text =
      "#instance,class,u_min [px],v_min [px],u_max [px],v_max [px],pixels,x [m],y [m],z [m],qx [],qy [],qz [],qw [],"
      "size_x [m],size_y [m],size_z [m]\n";
  for (std::size_t k = 0; k < instances.size(); ++k) {
    if (seen[k].pixels == 0) continue;
    const Instance& of = instances[k];
    const Pose T_WO = of.object < 0 ? Pose{} : objects[static_cast<std::size_t>(of.object)];
    const glm::dquat q_CW = glm::conjugate(view.pose.q_WC), q = q_CW * T_WO.q_WC * of.box.q_WC;
    const glm::dvec3 p = q_CW * (T_WO.p_WC + T_WO.q_WC * of.box.p_WC - view.pose.p_WC);
    text += std::to_string(k + 1) + "," + std::to_string(simulator.labels().ClassId(of));
    for (const int whole : {seen[k].left, seen[k].top, seen[k].right, seen[k].bottom, seen[k].pixels})
      text += "," + std::to_string(whole);
    for (const double number : {p.x, p.y, p.z, q.x, q.y, q.z, q.w, of.size.x, of.size.y, of.size.z})
      text += "," + FormatDecimal(number);
    text += "\n";
  }
  return text;
}

std::string LabelsJson(const Labels& labels) {
  using Json = nlohmann::ordered_json;
  Json json = {{"instances", Json::array()}, {"classes", Json::array()}};
  for (const Instance& instance : labels.instances) {
    json["instances"].push_back({{"id", json["instances"].size() + 1},
                                 {"name", instance.name},
                                 {"class", instance.category},
                                 {"class_id", labels.ClassId(instance)},
                                 {"scenario", instance.entry}});
  }
  for (const std::string& name : labels.classes)
    json["classes"].push_back({{"id", json["classes"].size() + 1}, {"name", name}});
  return json.dump(2) + "\n";
}

}  // namespace sim
