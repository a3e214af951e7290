#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "tools/base/files.h"
#include "tools/base/limits/structured_text.h"
#include "tools/judge/evaluation/text_file.h"
#include "tools/judge/verification/comparisons.h"

namespace verification {
namespace {

using Eigen::Vector3d;

enum Row { kLegend, kTight, kInside };

// A line of boxes/STAMP.csv: instance, class, u_min, v_min, u_max, v_max, pixels, then T_CX and the size.
std::vector<std::vector<double>> ReadBoxes(const std::filesystem::path& file) {
  std::vector<std::vector<double>> rows;
  for (const evaluation::Line& line : evaluation::Lines(file, ',')) {
    std::vector<double>& row = rows.emplace_back();
    for (const evaluation::Token& token : line.tokens)
      row.push_back(evaluation::ParseNumber(token.text).value_or(std::nan("")));
    if (row.size() != 17) throw std::runtime_error(file.filename().string() + ": a box has 17 numbers");
  }
  return rows;
}

}  // namespace

std::vector<int> ReadLegend(const std::filesystem::path& file) {
  const std::string text = base::ReadFile(file).value_or(""), problem = limits::JsonProblem(text);
  std::vector<int> classes{0};
  try {
    if (!problem.empty()) throw std::runtime_error(problem);
    const nlohmann::json legend = nlohmann::json::parse(text);
    for (const nlohmann::json& instance : legend.at("instances")) {
      const nlohmann::json& named = legend.at("classes").at(instance.at("class_id").get<std::size_t>() - 1);
      if (instance.at("id") != classes.size() || named.at("name") != instance.at("class"))
        throw std::runtime_error("ids have gaps, or another class has an instance's class_id");
      classes.push_back(instance.at("class_id"));
    }
  } catch (const std::exception& error) {
    throw std::runtime_error(std::string("labels.json: ") + error.what());
  }
  return classes;
}

std::vector<Check> LabelChecks(const Sequence& sequence) {
  if (sequence.classes.empty()) return {};
  return {{"labels: where there is depth, as the legend", ""},
          {"boxes against the instances", "px"},
          {"what is seen lies in its instance's box", "m"}};
}

void CompareLabels(Frames& frames, std::size_t frame, std::vector<Check>& checks) {
  const Sequence& s = frames.sequence();
  if (s.classes.empty()) return;
  const cv::Mat ids = frames.Picture("instance", frame), classes = frames.Picture("semantic", frame),
                depth = frames.Depth(frame);
  if (ids.empty()) return;
  std::size_t wrong = 0;
  for (int i = 0; i < static_cast<int>(ids.total()); ++i) {
    const std::uint16_t id = ids.at<std::uint16_t>(i);
    wrong += id >= s.classes.size() || (id == 0 && !depth.empty() && depth.at<float>(i) > 0) ||
             (!classes.empty() && classes.at<std::uint8_t>(i) != s.classes[id]);
  }
  checks[kLegend].Add(static_cast<double>(wrong), 0.5, "instance " + frames.Stamp(frame));
  const std::string file = s.FileAt("boxes", frame);
  if (file.empty()) return;
  std::vector<const std::vector<double>*> box_of(s.classes.size(), nullptr);
  std::vector<std::vector<double>> boxes;
  try {
    boxes = ReadBoxes(s.folder / file);
    for (const std::vector<double>& box : boxes) {
      const auto id = static_cast<std::size_t>(box[0] >= 1 ? box[0] : 0);
      if (id == 0 || id >= box_of.size() || box[1] != s.classes[id])
        throw std::runtime_error(file + ": an instance or class that the legend has not");
      box_of[id] = &box;
    }
  } catch (const std::exception& error) {
    return checks[kTight].Fail(error.what());
  }
  // Corners of meshes are floats in W.
  const double reach = s.poses[frame].p_WC.norm();
  for (std::size_t id = 1; id < box_of.size(); ++id) {
    const cv::Mat mask = ids == static_cast<double>(id);
    const cv::Rect seen = cv::boundingRect(mask);
    const std::string where = file + " instance " + std::to_string(id);
    if ((box_of[id] != nullptr) == seen.empty()) checks[kTight].Fail(where + ": in one of picture and boxes");
    if (box_of[id] == nullptr || seen.empty()) continue;
    const std::vector<double>& b = *box_of[id];
    const int counted[5] = {seen.x, seen.y, seen.br().x - 1, seen.br().y - 1, cv::countNonZero(mask)};
    for (std::size_t k = 0; k < 5; ++k) checks[kTight].Add(std::abs(b[2 + k] - counted[k]), 0.5, where);
    const Vector3d middle(b[7], b[8], b[9]), half = 0.5 * Vector3d(b[14], b[15], b[16]);
    const Eigen::Quaterniond q(b[13], b[10], b[11], b[12]);
    LargestRatio inside;
    for (std::size_t i = 0; i < ids.total() && !depth.empty(); ++i) {
      const double Z = static_cast<double>(depth.at<float>(static_cast<int>(i)));
      if (Z == 0 || mask.data[i] == 0) continue;
      const Vector3d X = Z * frames.rays()[i];
      const double beyond = ((q.conjugate() * (X - middle)).cwiseAbs() - half).maxCoeff();
      inside.Add(std::max(0.0, beyond),
                 frames.rays()[i].norm() * frames.DepthError(Z) + 1e-6 * (reach + X.norm() + half.norm()));
    }
    checks[kInside].Add(inside, where);
  }
}

}  // namespace verification
