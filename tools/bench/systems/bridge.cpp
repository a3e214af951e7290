#include "tools/bench/systems/bridge.h"

#include <fmt/format.h>

#include <opencv2/imgproc.hpp>

namespace vobench {

vo::Camera ToOdometry(const sim::CameraParams& camera) {
  const auto& [width, height, fx, fy, cx, cy, k1, k2, p1, p2, k3, k4, lens] = camera;
  const bool fisheye = lens == sim::Lens::fisheye;
  return {
      width, height, fx, fy, cx, cy, k1, k2, p1, p2, k3, k4, fisheye ? vo::Lens::fisheye : vo::Lens::radial_tangential};
}

sim::CameraParams ToSimulator(const vo::Camera& c) {
  sim::CameraParams to{c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.k1, c.k2, c.p1, c.p2, c.k3, c.k4};
  if (c.lens == vo::Lens::fisheye) to.lens = sim::Lens::fisheye;
  return to;
}

vo::Camera CameraOf(const sim::Scenario& scenario) {
  vo::Camera camera = ToOdometry(scenario.camera);
  camera.readout_s = scenario.sensor.readout_s;
  return camera;
}

vo::Frame ToOdometry(const sim::Frame& frame) {
  const sim::Image& image = frame.image;
  // OpenCV's headers over pixels that it only reads.
  cv::Mat pixels;
  if (image.bits == 8) {
    pixels = {image.height, image.width, CV_8UC(image.channels), const_cast<std::uint8_t*>(image.data.data())};
  } else {  // the odometry takes bytes
    const cv::Mat wide(image.height, image.width, CV_16UC(image.channels),
                       const_cast<std::uint16_t*>(image.wide.data()));
    wide.convertTo(pixels, CV_8U, 255.0 / 65535 * (1 << (16 - image.bits)));  // as the file's 16 bits are read
  }
  vo::Frame out{frame.stamp_ns, {}};
  image.channels == 1 ? pixels.copyTo(out.image) : cv::cvtColor(pixels, out.image, cv::COLOR_RGB2BGR);
  return out;
}

vo::PointFrame ToOdometry(const sim::PointFrame& frame) {
  vo::PointFrame out{frame.stamp_ns, {}};
  for (const sim::PointObservation& o : frame.observations) out.observations.push_back({o.id, {o.x_px, o.y_px}});
  return out;
}

Truth TruthOf(const sim::Simulator& simulator, std::int64_t first, std::int64_t frames) {
  Truth truth;
  for (std::int64_t k = first; k < first + frames; ++k) Append(simulator.StampNs(k), simulator.TruthAt(k), truth);
  return truth;
}

void PrintWarnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) fmt::print(stderr, "vobench: warning: {}\n", warning);
}

}  // namespace vobench
