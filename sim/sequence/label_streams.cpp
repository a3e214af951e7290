// Truth streams of labels: instances, boxes, and their legend.
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
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
  const std::vector<Instance>& instances = simulator.labels().instances;
  const Camera& camera = simulator.camera();
  const cv::Mat picture(camera.height(), camera.width(), CV_16UC1,
                        const_cast<std::uint16_t*>(ids.data()));  // only read
  const std::vector<Pose> objects = simulator.surfaces().ObjectPoses(view.t_s);
  std::string text =
      "#instance,class,u_min [px],v_min [px],u_max [px],v_max [px],pixels,x [m],y [m],z [m],qx [],qy [],qz [],qw [],"
      "size_x [m],size_y [m],size_z [m]\n";
  for (std::size_t k = 0; k < instances.size(); ++k) {
    const cv::Mat mask = picture == static_cast<double>(k + 1);
    const cv::Rect seen = cv::boundingRect(mask);
    if (seen.empty()) continue;
    const Instance& of = instances[k];
    const Pose T_WO = of.object < 0 ? Pose{} : objects[static_cast<std::size_t>(of.object)];
    const glm::dquat q_CW = glm::conjugate(view.pose.q_WC), q = q_CW * T_WO.q_WC * of.box.q_WC;
    const glm::dvec3 p = q_CW * (T_WO.p_WC + T_WO.q_WC * of.box.p_WC - view.pose.p_WC);
    text += std::to_string(k + 1) + "," + std::to_string(simulator.labels().ClassId(of));
    for (const int whole : {seen.x, seen.y, seen.br().x - 1, seen.br().y - 1, cv::countNonZero(mask)})
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
