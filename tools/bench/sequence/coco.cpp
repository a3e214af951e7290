#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "tools/base/files.h"
#include "tools/base/limits/structured_text.h"
#include "tools/bench/sequence/export_files.h"
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

// Lengths of background and instance in turn, down the columns.
std::vector<int> RunLengths(const cv::Mat& mask) {
  std::vector<int> lengths{0};
  const cv::Mat_<std::uint8_t> columns(cv::Mat(mask.t()));
  for (const std::uint8_t is : columns) {
    if ((lengths.size() % 2 == 0) != (is != 0)) lengths.push_back(0);
    ++lengths.back();
  }
  return lengths;
}

}  // namespace

std::string CocoJson(const fs::path& sequence) {
  const fs::path truth = fs::exists(sequence / "labels.json") ? sequence : sequence / "truth",
                 legend = truth / "labels.json", list = truth / "instance.txt";
  for (const fs::path& needed : {legend, list}) {
    if (fs::exists(needed)) continue;
    throw std::runtime_error(needed.string() +
                             ": is not there; render with --truth instance to have what COCO's file is made of");
  }
  const bool euroc = fs::exists(sequence / "mav0/cam0/data.csv");
  const char* pictures_list = fs::exists(sequence / "rgb.txt") ? "rgb.txt" : "associations.txt";
  const std::vector<std::string> pictures = euroc ? Listed(sequence / "mav0/cam0/data.csv", ',', "mav0/cam0/data/")
                                                  : Listed(sequence / pictures_list, ' ', ""),
                                 instances = Listed(list, ' ', "");
  if (pictures.size() != instances.size())
    throw std::runtime_error(list.string() + ": has not as many frames as the sequence");
  const std::string text = base::ReadFile(legend).value_or("");
  if (const std::string problem = limits::JsonProblem(text); !problem.empty())
    throw std::runtime_error(legend.string() + ": " + problem);
  try {
    const Json labels = Json::parse(text);
    Json images = Json::array(), annotations = Json::array();
    for (std::size_t k = 0; k < pictures.size(); ++k) {
      const cv::Mat ids = verification::ReadPicture(truth / instances[k]);
      if (ids.type() != CV_16UC1) throw std::runtime_error((truth / instances[k]).string() + ": is not of 16 bits");
      images.push_back({{"id", k + 1}, {"width", ids.cols}, {"height", ids.rows}, {"file_name", pictures[k]}});
      for (const Json& instance : labels.at("instances")) {
        const cv::Mat mask = ids == instance.at("id").get<int>();
        const cv::Rect box = cv::boundingRect(mask);
        if (box.empty()) continue;
        annotations.push_back({{"id", annotations.size() + 1},
                               {"image_id", k + 1},
                               {"category_id", instance.at("class_id")},
                               {"instance", instance.at("id")},
                               {"name", instance.at("name")},
                               {"iscrowd", 0},
                               {"area", cv::countNonZero(mask)},
                               {"bbox", {box.x, box.y, box.width, box.height}},
                               {"segmentation", {{"size", {ids.rows, ids.cols}}, {"counts", RunLengths(mask)}}}});
      }
    }
    return Json({{"info", {{"description", "made by vobench"}}},
                 {"images", images},
                 {"annotations", annotations},
                 {"categories", labels.at("classes")}})
               .dump() +
           "\n";
  } catch (const Json::exception& error) {
    throw std::runtime_error(legend.string() + ": " + error.what());
  }
}

}  // namespace vobench
