#include "tools/bench/run/served_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "sim/sensor/develop.h"
#include "sim/sensor/vignetting.h"
#include "sim/sequence/layout.h"
#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/errors.h"
#include "tools/bench/run/calibration.h"
#include "tools/bench/run/euroc_folder.h"
#include "tools/judge/evaluation/text_file.h"
#include "vo/sequence/reader.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

using campaign::SequenceLayout;
constexpr const char* kVersion = "4";  // version of the served content; part of the folders' names

// Pinhole of the largest upright rectangle of rays inside this camera's picture, without a black border; its sides are
// multiples of 16. Of a pinhole the middle of its picture. Throws std::invalid_argument where it includes rays behind
// the camera.
sim::CameraParams RectifiedCamera(const sim::CameraParams& c) {
  const int width = c.width / kSideMultiple * kSideMultiple, height = c.height / kSideMultiple * kSideMultiple;
  if (!IsDistorted(c)) {
    const int x = (c.width - width) / 2, y = (c.height - height) / 2;
    return {width, height, c.fx, c.fy, c.cx - x, c.cy - y};
  }
  const sim::Camera camera(c);
  glm::dvec2 low(-HUGE_VAL), high(HUGE_VAL);
  for (int v = 0; v < c.height; ++v) {
    low.x = std::max(low.x, camera.Undistort({0, v}).x);
    high.x = std::min(high.x, camera.Undistort({c.width - 1, v}).x);
  }
  for (int u = 0; u < c.width; ++u) {
    low.y = std::max(low.y, camera.Undistort({u, 0}).y);
    high.y = std::min(high.y, camera.Undistort({u, c.height - 1}).y);
  }
  const double fx = (width - 1) / (high.x - low.x), fy = (height - 1) / (high.y - low.y);
  return {width, height, fx, fy, -low.x * fx, -low.y * fy};
}

// Pixel of `from` that corresponds to (x, y) of `to`, a pinhole.
glm::dvec2 SamePoint(const sim::CameraParams& to, int x, int y, const sim::Camera& from) {
  return from.Project({(x - to.cx) / to.fx, (y - to.cy) / to.fy, 1});
}

// Whole pixels are copied, others interpolated by cubic convolution.
void WriteRectified(const fs::path& sequence, const fs::path& folder, const sim::CameraParams& from,
                    const sim::CameraParams& to) {
  const sim::Camera camera(from);
  cv::Mat map(to.height, to.width, CV_32FC2);
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      const glm::dvec2 pixel = SamePoint(to, x, y, camera);
      map.at<cv::Vec2f>(y, x) = {static_cast<float>(pixel.x), static_cast<float>(pixel.y)};
    }
  }
  std::string list = "# rectified frames\n# seconds, and the file\n# timestamp filename\n";
  fs::create_directories(folder / "rgb");
  const vo::SequenceReader reader(sequence);
  for (const vo::SequenceReader::Entry& frame : reader.entries()) {
    const std::string name = "rgb/" + base::FormatSeconds(frame.stamp_ns) + ".png";
    const cv::Mat image = cv::imread(frame.image.string(), cv::IMREAD_UNCHANGED);
    if (image.empty()) throw BadInput(frame.image.string() + ": not an image that can be decoded");
    cv::Mat rectified;
    cv::remap(image, rectified, map, {}, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
    if (!cv::imwrite((folder / name).string(), rectified, {cv::IMWRITE_PNG_COMPRESSION, 1}))
      throw std::runtime_error((folder / name).string() + ": cannot be written");
    list += base::FormatSeconds(frame.stamp_ns) + " " + name + "\n";
  }
  base::WriteFile(folder / "rgb.txt", list);
}

// In the format of DSO's monocular dataset. With automatic exposure the time times the gain: there is no field for it.
void WriteTimes(const fs::path& file, const SequenceFrames& frames, const fs::path& exposures,
                const sim::SensorParams* sensor) {
  std::map<std::int64_t, double> chosen;
  if (fs::exists(exposures)) {
    for (const evaluation::Line& line : evaluation::Lines(exposures, ' '))
      chosen[base::ParseSeconds(line.tokens.at(0).text).value()] =
          base::ParseNumber(line.tokens.at(1).text).value() * base::ParseNumber(line.tokens.at(2).text).value();
  }
  std::string times;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    times += fmt::format("{:06} {}", i, base::FormatSeconds(frames[i].stamp_ns));
    const auto at = chosen.find(frames[i].stamp_ns);
    if (sensor) times += fmt::format(" {:.9g}", 1e3 * (at == chosen.end() ? sensor->exposure_s : at->second));
    times += "\n";
  }
  base::WriteFile(file, times);
}

// pcalib.txt: the irradiance, 0 to 255, of each code of 8 bits; vignette.png: 16 bits, the largest factor is 65535. Not
// where pictures are processed after the response.
void WritePhotometricCalibration(const fs::path& folder, const sim::Scenario& scenario,
                                 const sim::CameraParams& served) {
  if (scenario.sensor.processing.on()) return;
  std::string response;
  for (int code = 0; code < 256; ++code)
    response += fmt::format("{:.9g} ", 255 * sim::DecodeResponse(scenario.sensor, code / 255.0));
  base::WriteFile(folder / "pcalib.txt", response + "\n");
  const sim::Camera camera(scenario.camera);
  const sim::Vignetting vignetting(scenario.sensor.optics, camera);
  const bool same = served.fx == scenario.camera.fx && served.cx == scenario.camera.cx;  // not rectified
  cv::Mat factor(served.height, served.width, CV_64F), picture;
  for (int y = 0; y < served.height; ++y) {
    for (int x = 0; x < served.width; ++x) {
      const glm::dvec2 at = same ? glm::dvec2(x, y) : SamePoint(served, x, y, camera);
      factor.at<double>(y, x) = vignetting.Factor(at.x, at.y);
    }
  }
  double largest = 0;
  cv::minMaxIdx(factor, nullptr, &largest);
  factor.convertTo(picture, CV_16U, 65535 / largest);
  if (!cv::imwrite((folder / "vignette.png").string(), picture))
    throw std::runtime_error((folder / "vignette.png").string() + ": cannot be written");
}

// Makes `folder` where it is not there.
void MakeOnce(const campaign::SequenceCache& cache, const std::string& key, const fs::path& folder,
              const std::function<void(const fs::path& partial)>& make) {
  const campaign::FileLock lock = cache.Take(key);
  if (fs::exists(folder)) return;
  const fs::path partial = folder.string() + ".partial";
  fs::remove_all(partial);
  fs::create_directories(partial);
  make(partial);
  base::ReplaceFolder(partial, folder);
}

}  // namespace

ServedSequence Serve(const campaign::SequenceCache& cache, const std::string& key, const sim::Scenario& scenario,
                     bool rendered, const campaign::ExternalSystem& system, double focal_error) {
  const fs::path original = fs::absolute(cache.PathOf(key));
  const sim::CameraParams& camera = scenario.camera;
  ServedSequence served{original, system.rectified ? RectifiedCamera(camera) : camera, {}};
  if (system.rectified &&
      (IsDistorted(camera) || served.camera.width != camera.width || served.camera.height != camera.height)) {
    served.folder += std::string(".rectified") + kVersion;
    MakeOnce(cache, key, served.folder, [&](const fs::path& partial) {
      WriteRectified(original, partial, camera, served.camera);
      base::WriteFile(partial / "camera.yaml", sim::CameraYaml(served.camera, std::nullopt));  // its rows are others
    });
  }
  const vo::SequenceReader reader(served.folder);
  const SequenceFrames& frames = reader.entries();
  for (const vo::SequenceReader::Entry& frame : frames) served.stamps_ns.push_back(frame.stamp_ns);
  const fs::path tum = served.folder;
  const sim::CameraParams exact = served.camera;
  served.camera.fx *= 1 + focal_error;
  served.camera.fy *= 1 + focal_error;
  const campaign::Sensors& sensors = system.sensors;
  served.folder += "." + campaign::Name(system.layout) + (sensors.metric() ? "_" + campaign::Name(sensors) : "") +
                   kVersion + (focal_error != 0 ? fmt::format(".focal{:+}", focal_error) : "");
  MakeOnce(cache, key, served.folder, [&](const fs::path& partial) {
    const auto link = [&](const fs::path& what) {  // a folder, to where it is there
      fs::create_directories((partial / what).parent_path());
      fs::create_directory_symlink(fs::relative(tum / what, (partial / what).parent_path()), partial / what);
    };
    if (sensors.metric()) {
      link("mav0/cam0");
      if (sensors.stereo) link("mav0/cam1");
      if (sensors.imu) link("mav0/imu0");
    } else if (system.layout == SequenceLayout::euroc) {
      sim::Scenario one;  // a camera alone
      one.time = scenario.time;
      one.camera = served.camera;
      WriteEurocCamera(partial, one, frames, 0);
    } else if (system.layout == SequenceLayout::tum) {  // without the truth
      link("rgb");
      for (const char* file : {"rgb.txt", "exposure.txt"})
        if (fs::exists(tum / file)) fs::copy_file(tum / file, partial / file);
    } else {
      fs::create_directory(partial / "images");
      for (std::size_t i = 0; i < frames.size(); ++i) {
        const fs::path& image = frames[i].image;
        fs::create_symlink(fs::relative(image.parent_path(), partial / "images") / image.filename(),
                           partial / fmt::format("images/{:06}.png", i));
      }
      WriteTimes(partial / "times.txt", frames, original / "exposure.txt", rendered ? &scenario.sensor : nullptr);
      if (rendered) WritePhotometricCalibration(partial, scenario, exact);
    }
    // Ours is not given the shutter's time of a rendered sequence either where it has the images alone.
    const bool with_shutter =
        !rendered && base::ReadFile(tum / "camera.yaml").value_or("").find("rolling_shutter") != std::string::npos;
    const auto readout_s = with_shutter ? std::optional(scenario.sensor.readout_s) : std::nullopt;
    base::WriteFile(partial / "camera.yaml", sim::CameraYaml(served.camera, readout_s));
  });
  return served;
}

}  // namespace vobench
