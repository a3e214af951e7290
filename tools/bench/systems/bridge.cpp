#include "tools/bench/systems/bridge.h"

#include <fmt/format.h>

#include <opencv2/imgproc.hpp>

namespace vobench {
vo::Camera ToOdometry(const sim::CameraParams& camera) {
  vo::Camera out;
  out.width = camera.width;
  out.height = camera.height;
  out.fx = camera.fx;
  out.fy = camera.fy;
  out.cx = camera.cx;
  out.cy = camera.cy;
  out.k1 = camera.k1;
  out.k2 = camera.k2;
  out.p1 = camera.p1;
  out.p2 = camera.p2;
  out.k3 = camera.k3;
  out.k4 = camera.k4;
  out.lens = camera.lens == sim::Lens::fisheye ? vo::Lens::fisheye : vo::Lens::radial_tangential;
  return out;
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
  vo::Frame out;
  out.stamp_ns = frame.stamp_ns;
  if (image.channels == 1) {
    out.image = pixels.clone();
  } else {
    cv::cvtColor(pixels, out.image, cv::COLOR_RGB2BGR);
  }
  return out;
}

vo::PointFrame ToOdometry(const sim::PointFrame& frame) {
  vo::PointFrame out;
  out.stamp_ns = frame.stamp_ns;
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
