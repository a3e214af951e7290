// Kept pictures of a run with the features of the odometry, and pictures.json.
// Source: docs/result_folder.md.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace vobench {

// A feature in a picture [px]; the centre of the first pixel is (0, 0).
struct FeatureMark {
  enum class Status { matched, missed, rejected, fresh };
  Status status = Status::missed;
  Eigen::Vector2d predicted = Eigen::Vector2d::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();       // of the match
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // of the innovation [px^2]; 0: none
};

struct KeptPicture {
  std::int64_t stamp_ns = 0;
  std::vector<FeatureMark> features;
};

struct KeptPictures {
  int width = 0, height = 0;  // of the camera's image, in whose pixels features are
  std::vector<KeptPicture> pictures;
};

// Where the picture of a frame is, beside pictures.json.
std::filesystem::path PicturePath(std::int64_t stamp_ns);

// Features with non-finite or very large numbers are left out. Throws std::runtime_error.
void WritePictures(const std::filesystem::path& run_folder, const KeptPictures& pictures);

// None where there is no pictures.json. Throws evaluation::InputError naming the file.
KeptPictures ReadPictures(const std::filesystem::path& run_folder);

// OUT/truth/: depth and optical flow as colour for frames of a rendered run; scale of the colours.
struct TruthScale {
  double nearest_m = 0, farthest_m = 0;  // depth
  double largest_flow_px = 0;            // to the next frame
};
void WriteTruthScale(const std::filesystem::path& out, const TruthScale& scale);
// Zeros where there is none. Throws evaluation::InputError.
TruthScale ReadTruthScale(const std::filesystem::path& out);
std::filesystem::path DepthPath(std::int64_t stamp_ns);
std::filesystem::path FlowPath(std::int64_t stamp_ns);

}  // namespace vobench
