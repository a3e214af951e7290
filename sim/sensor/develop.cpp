#include "sim/sensor/develop.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "tools/base/text.h"

namespace sim {
namespace {

// A header over pixels that OpenCV only reads.
cv::Mat View(const Image& image) {
  if (image.bits == 8) {
    return {image.height, image.width, CV_8UC(image.channels), const_cast<std::uint8_t*>(image.data.data())};
  }
  return {image.height, image.width, CV_16UC(image.channels), const_cast<std::uint16_t*>(image.wide.data())};
}

Image ToImage(const cv::Mat& mat, int bits) {
  Image image{mat.cols, mat.rows, mat.channels(), {}, bits, {}};
  const std::size_t n = mat.total() * static_cast<std::size_t>(mat.channels());
  if (bits == 8) {
    image.data.assign(mat.ptr<std::uint8_t>(), mat.ptr<std::uint8_t>() + n);
  } else {
    image.wide.assign(mat.ptr<std::uint16_t>(), mat.ptr<std::uint16_t>() + n);
  }
  return image;
}

}  // namespace

double EncodeResponse(const SensorParams& params, double x) {
  const std::vector<double>& light = params.light_of_code;
  if (!light.empty()) {
    const auto above = std::ranges::upper_bound(light, x);
    if (above == light.begin() || above == light.end()) return above == light.end() ? 1 : 0;
    const double below = *(above - 1), code = static_cast<double>(above - 1 - light.begin());
    return (code + (x - below) / (*above - below)) / static_cast<double>(light.size() - 1);
  }
  if (params.response == Response::linear) return x;
  // Where the two pieces of the inverse meet: the standard's own threshold, 0.0031308, is rounded.
  return x <= 0.04045 / 12.92 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

double DecodeResponse(const SensorParams& params, double code) {
  const std::vector<double>& light = params.light_of_code;
  if (!light.empty()) {
    const double at = code * static_cast<double>(light.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(at), light.size() - 2);
    return light[i] + (at - static_cast<double>(i)) * (light[i + 1] - light[i]);
  }
  if (params.response == Response::linear) return code;
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

std::vector<double> ReadResponse(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be read");
  std::vector<double> light;
  std::vector<std::string> problems;
  const auto add = [&](const std::string& place, const std::string& problem) {
    problems.push_back(file.string() + place + ": " + problem);
  };
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    for (const base::Word& word : base::SplitWords(number == 1 ? base::WithoutMark(line) : line)) {
      if (base::IsComment(word.text)) break;
      const std::optional<double> value = base::ParseNumber(base::WithoutPlus(word.text));
      const std::string place = ":" + std::to_string(number) + ":" + std::to_string(word.column);
      if (!value || !std::isfinite(*value) || *value < 0) {
        add(place, "'" + std::string(word.text) + "' is not an amount of light");
      } else if (!light.empty() && *value < light.back()) {
        add(place, std::string(word.text) + " is less than the light of the code below it");
      } else {
        light.push_back(*value);
      }
    }
  }
  if (problems.empty() && (light.size() < 2 || light.front() >= light.back()))
    add("", "holds no increasing light of codes");
  if (!problems.empty()) throw std::runtime_error(base::JoinProblems(std::move(problems)));
  const double most = light.back();
  for (double& value : light) value /= most;
  return light;
}

ResponseCurve::ResponseCurve(Response response) {
  SensorParams params;
  params.response = response;
  for (std::size_t i = 0; i < threshold_.size(); ++i)
    threshold_[i] = static_cast<float>(DecodeResponse(params, (static_cast<double>(i) + 0.5) / 255));
  for (std::size_t i = 0; i < guess_.size(); ++i) {
    const float x = static_cast<float>(i) / kCells;
    guess_[i] =
        static_cast<std::uint8_t>(std::upper_bound(threshold_.begin(), threshold_.end(), x) - threshold_.begin());
  }
}

Image Demosaic(const Image& mosaic, bool edge_aware) {
  // OpenCV leaves pictures narrower than 3 pixels black. Mirrored about the first and last pixels they keep the
  // pattern.
  const int margin = std::min(mosaic.width, mosaic.height) < 3 ? 2 : 0;
  cv::Mat wide = View(mosaic), rgb;
  if (margin > 0) cv::copyMakeBorder(wide, wide, margin, margin, margin, margin, cv::BORDER_REFLECT_101);
  // OpenCV names a pattern after its second row's second and third pixels: its BG has red at (0, 0).
  cv::cvtColor(wide, rgb, edge_aware ? cv::COLOR_BayerBG2RGB_EA : cv::COLOR_BayerBG2RGB);
  if (margin > 0) rgb = rgb(cv::Rect(margin, margin, mosaic.width, mosaic.height)).clone();
  return ToImage(rgb, mosaic.bits);
}

Image ThroughJpeg(const Image& image, int quality) {
  cv::Mat bgr = View(image);
  if (image.channels == 3) cv::cvtColor(View(image), bgr, cv::COLOR_RGB2BGR);
  std::vector<std::uint8_t> file;
  if (!cv::imencode(".jpg", bgr, file, {cv::IMWRITE_JPEG_QUALITY, quality}))
    throw std::runtime_error("OpenCV cannot encode a JPEG picture");
  cv::Mat back = cv::imdecode(file, image.channels == 3 ? cv::IMREAD_COLOR : cv::IMREAD_GRAYSCALE);
  if (image.channels == 3) cv::cvtColor(back, back, cv::COLOR_BGR2RGB);
  return ToImage(back, 8);
}

}  // namespace sim
