#include "tools/vobench/picture.h"

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "tools/evaluation/text_file.h"

namespace vobench {
namespace {

// Blue, green, red. The hues of Okabe and Ito, which colour-blind readers can tell apart.
const cv::Scalar kMatched(115, 158, 0), kMissed(0, 159, 230), kRejected(0, 94, 213), kFresh(233, 180, 86);
constexpr int kShift = 4;  // coordinates in sixteenths of a pixel

// None where the prediction lies so far outside (or is so undefined) that it cannot be drawn.
bool Drawable(const Eigen::Vector2d& pixel) { return pixel.allFinite() && pixel.cwiseAbs().maxCoeff() < 1e5; }

cv::Point Fixed(const Eigen::Vector2d& pixel) {
  return {static_cast<int>(std::lround(pixel.x() * (1 << kShift))),
          static_cast<int>(std::lround(pixel.y() * (1 << kShift)))};
}

void Ring(cv::Mat& picture, const Eigen::Vector2d& pixel, double radius_px, const cv::Scalar& colour) {
  cv::circle(picture, Fixed(pixel), static_cast<int>(radius_px * (1 << kShift)), colour, 1, cv::LINE_AA, kShift);
}

void Line(cv::Mat& picture, const Eigen::Vector2d& a, const Eigen::Vector2d& b, const cv::Scalar& colour) {
  cv::line(picture, Fixed(a), Fixed(b), colour, 1, cv::LINE_AA, kShift);
}

void Draw(cv::Mat& picture, const vo::FeatureView& feature) {
  const Eigen::Vector2d& p = feature.pixel;
  if (!Drawable(p)) return;
  switch (feature.status) {
    case vo::FeatureView::Status::matched:
      if (Drawable(feature.predicted)) Line(picture, feature.predicted, p, kMatched);
      Ring(picture, p, 4, kMatched);
      break;
    case vo::FeatureView::Status::missed:
      Line(picture, p + Eigen::Vector2d(-3, -3), p + Eigen::Vector2d(3, 3), kMissed);
      Line(picture, p + Eigen::Vector2d(-3, 3), p + Eigen::Vector2d(3, -3), kMissed);
      break;
    case vo::FeatureView::Status::rejected:
      Ring(picture, p, 4, kRejected);
      break;
    case vo::FeatureView::Status::fresh:
      cv::rectangle(picture, Fixed(p + Eigen::Vector2d(-2, -2)), Fixed(p + Eigen::Vector2d(2, 2)), kFresh, 1,
                    cv::LINE_AA, kShift);
      break;
  }
}

}  // namespace

void WritePicture(const std::filesystem::path& file, const cv::Mat& image,
                  const std::vector<vo::FeatureView>& features) {
  cv::Mat picture;
  if (image.channels() == 1) {
    cv::cvtColor(image, picture, cv::COLOR_GRAY2BGR);
  } else {
    picture = image.clone();
  }
  for (const vo::FeatureView& feature : features) Draw(picture, feature);
  std::vector<unsigned char> jpeg;
  if (!cv::imencode(".jpg", picture, jpeg, {cv::IMWRITE_JPEG_QUALITY, 85})) {
    throw std::runtime_error(file.string() + ": cannot encode this picture");
  }
  evaluation::WriteWhole(file, std::string(jpeg.begin(), jpeg.end()));
}

}  // namespace vobench
