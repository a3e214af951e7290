#include "vo/features/brisk_field.h"

#include <cstring>

namespace vo {

BriskField::BriskField(double size_px) : size_px_(static_cast<float>(size_px)), brisk_(cv::BRISK::create()) {
  // OpenCV drops keypoints whose pattern leaves the image but does not tell how large the pattern is: ask it.
  constexpr int kSide = 401;
  const cv::Mat blank = cv::Mat::zeros(kSide, kSide, CV_8UC1);
  std::vector<cv::KeyPoint> keypoints;
  for (int x = 0; x < kSide / 2; ++x)
    keypoints.emplace_back(static_cast<float>(x), static_cast<float>(kSide / 2), size_px_, -1.f, 0.f, 0, x);
  cv::Mat descriptors;
  brisk_->compute(blank, keypoints, descriptors);
  border_px_ = keypoints.empty() ? kSide : keypoints.front().class_id;
}

void BriskField::SetImage(const cv::Mat& grey) {
  grey_ = grey;
  index_.create(grey.size(), CV_32S);
  index_ = cv::Scalar(-1);
  descriptors_.clear();
}

void BriskField::Compute(const std::vector<Eigen::Vector2i>& pixels) {
  constexpr int kPending = -2;
  std::vector<cv::KeyPoint> keypoints;
  for (const Eigen::Vector2i& p : pixels) {
    if (p.x() < border_px_ || p.y() < border_px_ || p.x() >= grey_.cols - border_px_ || p.y() >= grey_.rows - border_px_) continue;
    int& index = index_.at<int>(p.y(), p.x());
    if (index != -1) continue;
    index = kPending;
    keypoints.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), size_px_);
  }
  if (keypoints.empty()) return;
  cv::Mat rows;
  brisk_->compute(grey_, keypoints, rows);
  for (int i = 0; i < rows.rows; ++i) {
    index_.at<int>(static_cast<int>(keypoints[i].pt.y), static_cast<int>(keypoints[i].pt.x)) =
        static_cast<int>(descriptors_.size());
    std::memcpy(descriptors_.emplace_back().data(), rows.ptr(i), sizeof(Descriptor));
  }
}

const Descriptor* BriskField::At(const Eigen::Vector2i& pixel) const {
  if (pixel.x() < 0 || pixel.y() < 0 || pixel.x() >= grey_.cols || pixel.y() >= grey_.rows) return nullptr;
  const int index = index_.at<int>(pixel.y(), pixel.x());
  return index < 0 ? nullptr : &descriptors_[index];
}

}  // namespace vo
