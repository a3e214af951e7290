#include "tools/bench/sequence/coco.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "tools/base/files.h"
#include "tools/base/limits/structured_text.h"
#include "tools/judge/evaluation/text_file.h"
#include "tools/judge/verification/files.h"

namespace vobench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// The last word of each line, below `folder`.
std::vector<std::string> Listed(const fs::path& list, char separator, const std::string& folder) {
  std::vector<std::string> files;
  for (const evaluation::Line& line : evaluation::Lines(list, separator))
    files.push_back(folder + line.tokens.back().text);
  return files;
}

struct Mask {
  std::vector<int> counts{0};  // of background and instance in turn, down the columns
  int left = 1 << 30, top = 1 << 30, right = -1, bottom = -1, area = 0;
  std::size_t end = 0;  // of the last run

  void Add(int x, int y, std::size_t at) {
    if (counts.size() % 2 == 1 || at > end) {  // the first pixel of a run
      if (counts.size() % 2 == 0) counts.push_back(0);
      counts.back() += static_cast<int>(at - end);
      counts.push_back(0);
    }
    ++counts.back();
    end = at + 1;
    left = std::min(left, x), top = std::min(top, y), right = std::max(right, x), bottom = std::max(bottom, y), ++area;
  }
};

std::map<int, Mask> MasksOf(const cv::Mat& ids) {
  std::map<int, Mask> masks;
  std::size_t at = 0;
  for (int x = 0; x < ids.cols; ++x) {
    for (int y = 0; y < ids.rows; ++y, ++at) {
      if (const int id = ids.at<std::uint16_t>(y, x); id != 0) masks[id].Add(x, y, at);
    }
  }
  for (auto& [id, mask] : masks) {
    if (at > mask.end) mask.counts.push_back(static_cast<int>(at - mask.end));
  }
  return masks;
}

}  // namespace

std::string CocoJson(const fs::path& sequence) {
  const fs::path truth = fs::exists(sequence / "labels.json") ? sequence : sequence / "truth",
                 legend = truth / "labels.json";
  const fs::path list = truth / "instance.txt";
  for (const fs::path& needed : {legend, list}) {
    if (!fs::exists(needed)) {
      throw std::runtime_error(needed.string() +
                               ": is not there; render with --truth instance to have what COCO's file is made of");
    }
  }
  const bool euroc = fs::exists(sequence / "mav0/cam0/data.csv");
  const std::vector<std::string> pictures =
                                     euroc ? Listed(sequence / "mav0/cam0/data.csv", ',', "mav0/cam0/data/")
                                           : Listed(sequence / (fs::exists(sequence / "rgb.txt") ? "rgb.txt"
                                                                                                 : "associations.txt"),
                                                    ' ', ""),
                                 instances = Listed(list, ' ', "");
  if (pictures.size() != instances.size())
    throw std::runtime_error(list.string() + ": has not as many frames as the sequence");
  const std::string text = base::ReadFile(legend).value_or("");
  if (const std::string problem = limits::JsonProblem(text); !problem.empty())
    throw std::runtime_error(legend.string() + ": " + problem);
  try {
    const Json labels = Json::parse(text);
    Json coco = {{"info", {{"description", "made by vobench"}}},
                 {"images", Json::array()},
                 {"annotations", Json::array()},
                 {"categories", Json::array()}};
    for (const Json& of : labels.at("classes"))
      coco["categories"].push_back({{"id", of.at("id")}, {"name", of.at("name")}, {"supercategory", ""}});
    for (std::size_t k = 0; k < pictures.size(); ++k) {
      const cv::Mat ids = verification::ReadPicture(truth / instances[k]);
      if (ids.type() != CV_16UC1) throw std::runtime_error((truth / instances[k]).string() + ": is not of 16 bits");
      coco["images"].push_back({{"id", k + 1}, {"width", ids.cols}, {"height", ids.rows}, {"file_name", pictures[k]}});
      for (const auto& [id, m] : MasksOf(ids)) {
        const Json& instance = labels.at("instances").at(static_cast<std::size_t>(id - 1));
        coco["annotations"].push_back({{"id", coco["annotations"].size() + 1},
                                       {"image_id", k + 1},
                                       {"category_id", instance.at("class_id")},
                                       {"instance", id},
                                       {"name", instance.at("name")},
                                       {"iscrowd", 0},
                                       {"area", m.area},
                                       {"bbox", {m.left, m.top, m.right - m.left + 1, m.bottom - m.top + 1}},
                                       {"segmentation", {{"size", {ids.rows, ids.cols}}, {"counts", m.counts}}}});
      }
    }
    return coco.dump() + "\n";
  } catch (const Json::exception& error) {
    throw std::runtime_error(legend.string() + ": " + error.what());
  }
}

}  // namespace vobench
