// Purpose: BRISK descriptors at any pixel of the present image, each computed at most once per frame.
// Source:  algorithm, section 7; Leutenegger et al., "BRISK" (OpenCV's implementation, 512 bits).
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>

namespace vo {

using Descriptor = std::array<std::uint64_t, 8>;

inline int HammingDistance(const Descriptor& a, const Descriptor& b) {
  int distance = 0;
  for (std::size_t i = 0; i < a.size(); ++i) distance += std::popcount(a[i] ^ b[i]);
  return distance;
}

class BriskField {
 public:
  explicit BriskField(double size_px);

  // Forgets the descriptors of the image before. `grey` is CV_8UC1 and is kept, not copied.
  void SetImage(const cv::Mat& grey);
  // Makes the descriptors of these pixels available; pixels outside the image or too near its edge are left out.
  void Compute(const std::vector<Eigen::Vector2i>& pixels);
  // Null where none was computed.
  const Descriptor* At(const Eigen::Vector2i& pixel) const;
  // Pixels nearer to the edge than this have no descriptor.
  int border_px() const { return border_px_; }

 private:
  float size_px_;
  int border_px_ = 0;
  cv::Ptr<cv::BRISK> brisk_;
  cv::Mat grey_;
  cv::Mat index_;  // CV_32S: position in descriptors_, or -1
  std::vector<Descriptor> descriptors_;
};

}  // namespace vo
