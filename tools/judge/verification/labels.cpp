#include <nlohmann/json.hpp>
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

// Of an instance's pixels, as columns 2 to 6 of its row.
struct Seen {
  int left = 1 << 30, top = 1 << 30, right = -1, bottom = -1, pixels = 0;
};

}  // namespace

std::vector<int> ReadLegend(const std::filesystem::path& file) {
  const std::string text = base::ReadFile(file).value_or("");
  if (const std::string problem = limits::JsonProblem(text); !problem.empty())
    throw std::runtime_error("labels.json: " + problem);
  std::vector<int> classes{0};
  try {
    const nlohmann::json legend = nlohmann::json::parse(text);
    for (const nlohmann::json& instance : legend.at("instances")) {
      if (instance.at("id").get<std::size_t>() != classes.size())
        throw std::runtime_error("labels.json: ids have gaps");
      const nlohmann::json& named = legend.at("classes").at(instance.at("class_id").get<std::size_t>() - 1);
      if (named.at("name") != instance.at("class"))
        throw std::runtime_error("labels.json: another class has this class_id");
      classes.push_back(instance.at("class_id"));
    }
  } catch (const nlohmann::json::exception& error) {
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
  std::vector<Seen> seen(s.classes.size());
  std::size_t wrong = 0;
  for (int y = 0; y < ids.rows; ++y) {
    for (int x = 0; x < ids.cols; ++x) {
      const std::uint16_t id = ids.at<std::uint16_t>(y, x);
      if (id >= s.classes.size()) {
        ++wrong;
        continue;
      }
      wrong += !depth.empty() && depth.at<float>(y, x) > 0 && id == 0;
      wrong += !classes.empty() && classes.at<std::uint8_t>(y, x) != s.classes[id];
      Seen& of = seen[id];
      of = {std::min(of.left, x), std::min(of.top, y), std::max(of.right, x), y, of.pixels + 1};
    }
  }
  checks[kLegend].Add(static_cast<double>(wrong), 0.5, "instance " + frames.Stamp(frame));

  const std::string file = s.FileAt("boxes", frame);
  if (file.empty()) return;
  std::vector<std::vector<double>> boxes;
  try {
    boxes = ReadBoxes(s.folder / file);
  } catch (const std::exception& error) {
    checks[kTight].Fail(error.what());
    return;
  }
  std::vector<const std::vector<double>*> of_id(s.classes.size(), nullptr);
  for (const std::vector<double>& box : boxes) {
    if (!(box[0] >= 1 && box[0] < static_cast<double>(of_id.size()) &&
          box[1] == s.classes[static_cast<std::size_t>(box[0])])) {
      checks[kTight].Fail(file + ": an instance or class that the legend has not");
      return;
    }
    of_id[static_cast<std::size_t>(box[0])] = &box;
  }
  Worst inside;
  for (std::size_t id = 1; id < seen.size(); ++id) {
    const std::string where = file + " instance " + std::to_string(id);
    if ((of_id[id] != nullptr) != (seen[id].pixels > 0)) checks[kTight].Fail(where + ": in one of picture and boxes");
    if (of_id[id] == nullptr || seen[id].pixels == 0) continue;
    const double counted[5] = {double(seen[id].left), double(seen[id].top), double(seen[id].right),
                               double(seen[id].bottom), double(seen[id].pixels)};
    for (std::size_t k = 0; k < 5; ++k) checks[kTight].Add(std::abs((*of_id[id])[2 + k] - counted[k]), 0.5, where);
  }
  if (depth.empty() || checks[kTight].failed()) return;
  for (std::size_t i = 0; i < ids.total(); ++i) {
    const std::uint16_t id = ids.at<std::uint16_t>(static_cast<int>(i));
    const double Z = static_cast<double>(depth.at<float>(static_cast<int>(i)));
    if (Z == 0 || id == 0 || id >= seen.size()) continue;
    const std::vector<double>& b = *of_id[id];
    const Vector3d X = Z * frames.rays()[i], middle(b[7], b[8], b[9]), half = 0.5 * Vector3d(b[14], b[15], b[16]);
    const Eigen::Quaterniond q(b[13], b[10], b[11], b[12]);
    const double beyond = ((q.conjugate() * (X - middle)).cwiseAbs() - half).maxCoeff();
    // Corners are floats in W.
    const double coordinate = s.poses[frame].p_WC.norm() + X.norm() + half.norm();
    inside.Add(std::max(0.0, beyond), frames.rays()[i].norm() * frames.DepthError(Z) + 1e-6 * coordinate);
  }
  checks[kInside].Add(inside, file);
}

}  // namespace verification
