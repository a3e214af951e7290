#include "tools/bench/run/served_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "sim/sensor/develop.h"
#include "sim/sensor/vignetting.h"
#include "sim/sequence/layout.h"
#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/errors.h"
#include "tools/bench/run/calibration.h"
#include "vo/sequence/reader.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

using campaign::SequenceLayout;
using Frames = std::vector<vo::SequenceReader::Entry>;

// The pixel of `from` that shows what (x, y) of `to`, a pinhole, does.
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

// Exposure of each frame [ms]; with automatic exposure times the gain, as the program knows no other. Empty: not known.
std::map<std::int64_t, double> Exposures_ms(const fs::path& sequence, const Frames& frames,
                                            const std::optional<sim::SensorParams>& sensor) {
  std::map<std::int64_t, double> exposures;
  if (!sensor) return exposures;
  for (const vo::SequenceReader::Entry& frame : frames) exposures[frame.stamp_ns] = 1e3 * sensor->exposure_s;
  std::istringstream lines(base::ReadFile(sequence / "exposure.txt").value_or(""));
  for (std::string line; std::getline(lines, line);) {
    const std::vector<base::Word> words = base::SplitWords(line);
    if (words.size() != 3 || words[0].text.starts_with('#')) continue;
    exposures[base::ParseSeconds(words[0].text).value()] =
        1e3 * base::ParseNumber(words[1].text).value() * base::ParseNumber(words[2].text).value();
  }
  return exposures;
}

// 16 bits, the largest factor is 65535.
void WriteVignette(const fs::path& file, const sim::SensorParams& sensor, const sim::CameraParams& rendered,
                   const sim::CameraParams& served) {
  const sim::Camera camera(rendered);
  const sim::Vignetting vignetting(sensor.optics, camera);
  cv::Mat factor(served.height, served.width, CV_64F), picture;
  const bool same = served.width == rendered.width && served.fx == rendered.fx && served.cx == rendered.cx;
  for (int y = 0; y < served.height; ++y) {
    for (int x = 0; x < served.width; ++x) {
      const glm::dvec2 at = same ? glm::dvec2(x, y) : SamePoint(served, x, y, camera);
      factor.at<double>(y, x) = vignetting.Factor(at.x, at.y);
    }
  }
  double largest = 0;
  cv::minMaxIdx(factor, nullptr, &largest);
  factor.convertTo(picture, CV_16U, 65535 / largest);
  if (!cv::imwrite(file.string(), picture)) throw std::runtime_error(file.string() + ": cannot be written");
}

void WriteImages(const fs::path& sequence, const fs::path& folder, const Frames& frames,
                 const PicturesOfSequence& pictures, const sim::CameraParams& served) {
  const auto exposures = Exposures_ms(sequence, frames, pictures.sensor);
  std::string times;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    times += fmt::format("{:06} {}", i, base::FormatSeconds(frames[i].stamp_ns));
    times += exposures.empty() ? "\n" : fmt::format(" {:.9g}\n", exposures.at(frames[i].stamp_ns));
  }
  base::WriteFile(folder / "times.txt", times);
  const std::string response = pictures.sensor ? InverseResponse(*pictures.sensor) : "";
  if (response.empty()) return;
  base::WriteFile(folder / "pcalib.txt", response);
  WriteVignette(folder / "vignette.png", *pictures.sensor, pictures.camera, served);
}

void WriteEuroc(const fs::path& folder, const Frames& frames, const PicturesOfSequence& pictures,
                const sim::CameraParams& served) {
  sim::Scenario scenario;
  scenario.camera = served;
  scenario.time.rate_hz = pictures.rate_hz;
  const std::vector<std::string> problems = sim::Problems(sim::Layout::euroc, scenario);
  if (!problems.empty()) throw BadInput(fmt::format("{}", fmt::join(problems, "; ")));
  std::vector<sim::StampedTruth> stamps;
  for (const vo::SequenceReader::Entry& frame : frames) stamps.push_back({0, frame.stamp_ns, {}});
  for (const sim::StreamFile& file : sim::Lists(sim::Layout::euroc, scenario, stamps))
    if (file.path.starts_with("mav0/cam0")) base::WriteFileAndFolders(folder / file.path, base::AsText(file.bytes));
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

std::string InverseResponse(const sim::SensorParams& sensor) {
  if (sensor.processing.on()) return "";
  std::string line;
  for (int code = 0; code < 256; ++code)
    line +=
        fmt::format("{}{:.9g}", code > 0 ? " " : "", 255 * sim::ResponseCurve::Decode(sensor.response, code / 255.0));
  return line + "\n";
}

ServedSequence Serve(const campaign::SequenceCache& cache, const std::string& key, const PicturesOfSequence& pictures,
                     const campaign::ExternalSystem& system) {
  ServedSequence served{fs::absolute(cache.PathOf(key)), pictures.camera};
  const sim::CameraParams rectified = system.rectified ? RectifiedCamera(pictures.camera) : pictures.camera;
  if (system.rectified && (IsDistorted(pictures.camera) || rectified.width != pictures.camera.width ||
                           rectified.height != pictures.camera.height)) {
    const fs::path from = served.folder;
    served = {from.string() + ".rectified", rectified};
    MakeOnce(cache, key, served.folder, [&](const fs::path& partial) {
      WriteRectified(from, partial, pictures.camera, rectified);
      std::string camera = sim::CameraYaml(rectified, 0);
      base::WriteFile(partial / "camera.yaml", camera.erase(camera.find("rolling_shutter")));  // each row another time
    });
  }
  if (system.layout == SequenceLayout::tum) return served;
  const ServedSequence tum = served;
  served.folder += "." + campaign::Name(system.layout);
  MakeOnce(cache, key, served.folder, [&](const fs::path& partial) {
    const Frames frames = vo::SequenceReader(tum.folder).entries();
    const bool euroc = system.layout == SequenceLayout::euroc;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const fs::path link = partial / (euroc ? sim::NamesOf(sim::Layout::euroc, 0, frames[i].stamp_ns).image
                                             : fmt::format("images/{:06}.png", i));
      fs::create_directories(link.parent_path());
      fs::create_symlink(fs::relative(frames[i].image.parent_path(), link.parent_path()) / frames[i].image.filename(),
                         link);
    }
    euroc ? WriteEuroc(partial, frames, pictures, served.camera)
          : WriteImages(tum.folder, partial, frames, pictures, served.camera);
    fs::copy_file(tum.folder / "camera.yaml", partial / "camera.yaml");
  });
  return served;
}

}  // namespace vobench
