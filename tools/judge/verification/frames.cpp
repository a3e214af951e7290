#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "tools/base/text.h"
#include "tools/judge/evaluation/text_file.h"
#include "tools/judge/verification/comparisons.h"

namespace verification {
namespace {

const std::map<std::string, std::vector<int>>& Types() {
  static const std::map<std::string, std::vector<int>> types = {{"rgb", {CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3}},
                                                                {"depth", {CV_16UC1}},
                                                                {"depth_exr", {CV_32FC1}},
                                                                {"distance", {CV_32FC1}},
                                                                {"normals", {CV_32FC3}},
                                                                {"surface_id", {CV_16UC1}},
                                                                {"flow", {CV_32FC2}},
                                                                {"flow_backward", {CV_32FC2}},
                                                                {"occlusion", {CV_8UC1}},
                                                                {"occlusion_backward", {CV_8UC1}},
                                                                {"moving", {CV_8UC1}},
                                                                {"instance", {CV_16UC1}},
                                                                {"semantic", {CV_8UC1}},
                                                                {"disparity", {CV_32FC1}},
                                                                {"disparity_occlusion", {CV_8UC1}}};
  return types;
}

}  // namespace

Frames::Frames(const Sequence& sequence, Check& files)
    : sequence_(sequence), files_(files), exact_(sequence.images.contains("depth_exr")) {
  for (int v = 0; v < sequence.camera.height; ++v) {
    for (int u = 0; u < sequence.camera.width; ++u) {
      const Eigen::Vector2d xy = sequence.camera.Undistort(Eigen::Vector2d(u, v));
      rays_.emplace_back(xy.x(), xy.y(), 1.0);
    }
  }
}

std::string Frames::Stamp(std::size_t frame) const { return base::FormatSeconds(sequence_.stamps[frame]); }

cv::Mat Frames::Picture(const std::string& stream, std::size_t frame) {
  while (!pictures_.empty() && pictures_.begin()->first + 5 < frame) pictures_.erase(pictures_.begin());
  const auto [at, is_new] = pictures_[frame].try_emplace(stream);
  if (!is_new) return at->second;
  const std::string file = sequence_.FileAt(stream, frame);
  if (file.empty()) return at->second;
  try {
    const cv::Mat picture = ReadPicture(sequence_.folder / file);
    const std::vector<int>& types = Types().at(stream);
    if (picture.cols != sequence_.camera.width || picture.rows != sequence_.camera.height) {
      throw std::runtime_error(file + ": is " + std::to_string(picture.cols) + " x " + std::to_string(picture.rows) +
                               ", the camera is not");
    }
    if (std::find(types.begin(), types.end(), picture.type()) == types.end()) {
      throw std::runtime_error(file + ": has other numbers in it than its stream has");
    }
    if (complained_.insert(file).second) files_.Add(0, 0.5, file);
    at->second = picture;
  } catch (const std::exception& error) {
    if (complained_.insert(file).second) files_.Fail(error.what());
  }
  return at->second;
}

cv::Mat Frames::Depth(std::size_t frame) {
  if (exact_) return Picture("depth_exr", frame);
  const cv::Mat coded = Picture("depth", frame);
  const auto [at, is_new] = pictures_[frame].try_emplace("depth in metres");
  if (is_new && !coded.empty()) coded.convertTo(at->second, CV_32F, 1.0 / 5000);
  return at->second;
}

cv::Mat Frames::Smooth(std::size_t frame) {
  const cv::Mat picture = Picture("rgb", frame);
  const auto [at, is_new] = pictures_[frame].try_emplace("smooth");
  if (!is_new || picture.empty()) return at->second;
  cv::Mat grey = picture;
  if (picture.channels() == 3) cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  grey.convertTo(grey, CV_32F, picture.depth() == CV_16U ? 1.0 / 257 : 1.0);
  cv::GaussianBlur(grey, at->second, cv::Size(9, 9), 1.5);
  return at->second;
}

Relative Between(const vo::Pose& a, const vo::Pose& b) {
  return {(b.q_WC.conjugate() * a.q_WC).toRotationMatrix(), b.q_WC.conjugate() * (a.p_WC - b.p_WC)};
}

std::optional<Relative> Between(const Sequence& s, std::size_t from, std::size_t to) {
  if (!s.has_pose[from] || !s.has_pose[to]) return std::nullopt;
  return Between(s.poses[from], s.poses[to]);
}

PixelMotions::PixelMotions(Frames& frames, std::size_t from, std::size_t to) : mask_(frames.Picture("moving", from)) {
  const Sequence& s = frames.sequence();
  const std::optional<Relative> world = Between(s, from, to);
  if (!world) return;
  motions_.push_back(*world);
  for (const Object& object : s.objects) {
    if (!object.has_pose[from] || !object.has_pose[to]) continue;
    // C of `from` to O, which is fixed; O to C of `to`.
    const vo::Pose &camera = s.poses[from], &other = s.poses[to], &now = object.poses[from], &then = object.poses[to];
    const Eigen::Quaterniond q_OC = now.q_WC.conjugate() * camera.q_WC, q_CO = other.q_WC.conjugate() * then.q_WC;
    const Eigen::Vector3d p_OC = now.q_WC.conjugate() * (camera.p_WC - now.p_WC),
                          p_CO = other.q_WC.conjugate() * (then.p_WC - other.p_WC);
    motions_.push_back({(q_CO * q_OC).toRotationMatrix(), q_CO * p_OC + p_CO});
  }
}

std::span<const Relative> PixelMotions::Of(std::size_t pixel) const {
  const std::span<const Relative> all(motions_);
  if (mask_.empty() || all.empty()) return all;
  return IsMoving(pixel) ? all.subspan(1) : all.first(1);
}

std::span<const Relative> PixelMotions::Others(std::size_t pixel) const {
  const std::span<const Relative> all(motions_);
  if (mask_.empty() || all.empty()) return {};
  return IsMoving(pixel) ? all.first(1) : all.subspan(1);
}

std::optional<Corners> CornersAt(const cv::Mat& picture, double x, double y) {
  if (!(x >= 0 && y >= 0 && x < picture.cols - 1 && y < picture.rows - 1)) return std::nullopt;
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  return Corners{i, j, static_cast<float>(x - i), static_cast<float>(y - j)};
}

std::vector<std::size_t> Partners(std::size_t frame, std::size_t count) {
  std::vector<std::size_t> partners;
  if (frame > 0) partners.push_back(frame - 1);
  if (frame + 1 < count) partners.push_back(frame + 1);
  if (partners.size() == 1 && count > 2) partners.push_back(frame == 0 ? 2 : frame - 2);
  return partners;
}

}  // namespace verification
