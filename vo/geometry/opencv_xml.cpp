#include "vo/geometry/opencv_xml.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tools/base/limits/structured_text.h"
#include "tools/base/settings/settings.h"
#include "vo/geometry/calibration_numbers.h"

namespace vo {
namespace {

class OpenCvXml {
 public:
  explicit OpenCvXml(const std::filesystem::path& file) : file_(file.string()) {
    std::ifstream stream(file, std::ios::binary);
    std::string text;
    for (std::array<char, 4096> block; stream && text.size() <= limits::kMostStorageBytes;) {
      stream.read(block.data(), block.size());
      text.append(block.data(), static_cast<std::size_t>(stream.gcount()));
    }
    if (const std::string problem = limits::OpenCvStorageProblem(text); !problem.empty())
      throw settings::Error({{file_, 0, 0, "OpenCV cannot read it: it is " + problem}});
    storage_.open(file_, cv::FileStorage::READ);
    if (!storage_.isOpened()) throw settings::Error({{file_, 0, 0, "OpenCV cannot read it"}});
  }

  Camera Read() {
    Camera camera;
    camera.width = Size("image_width", "image_Width");
    camera.height = Size("image_height", "image_Height");
    const std::vector<double> matrix = Matrix("camera_matrix", "Camera_Matrix");
    if (!matrix.empty()) {
      for (const std::string& problem : SetMatrix(matrix, camera)) Complain(problem);
    }
    const cv::FileNode fisheye = storage_["fisheye_model"];
    if (fisheye.isInt() && static_cast<int>(fisheye) != 0) camera.lens = Lens::fisheye;
    const std::vector<double> coefficients = Matrix("distortion_coefficients", "Distortion_Coefficients");
    if (!coefficients.empty()) {
      if (const std::string problem = SetLens(coefficients, camera); !problem.empty())
        Complain("'distortion_coefficients' " + problem);
    }
    if (!problems_.empty()) throw settings::Error(problems_);
    return camera;
  }

 private:
  void Complain(const std::string& message) { problems_.push_back({file_, 0, 0, message}); }

  cv::FileNode Find(const char* name, const char* other) const {
    const cv::FileNode node = storage_[name];
    return node.empty() ? storage_[other] : node;
  }

  int Size(const char* name, const char* other) {
    const cv::FileNode node = Find(name, other);
    const int value = node.isInt() ? static_cast<int>(node) : 0;
    if (value <= 0) Complain(std::string("'") + name + "' must be there, a positive whole number");
    return value;
  }

  // Entries row by row; empty after a problem.
  std::vector<double> Matrix(const char* name, const char* other) {
    const std::vector<double> values = Numbers(Find(name, other));
    if (values.empty()) Complain(std::string("'") + name + "' must be there, a matrix of numbers");
    for (const double value : values) {
      if (std::isfinite(value)) continue;
      Complain(std::string("'") + name + "' has a number that is none");
      return {};
    }
    return values;
  }

  // Without cv::Mat's reader, which allocates as many rows and columns as the file states.
  static std::vector<double> Numbers(const cv::FileNode& matrix) {
    if (!matrix.isMap()) return {};
    const cv::FileNode rows = matrix["rows"], columns = matrix["cols"], data = matrix["data"];
    if (!rows.isInt() || !columns.isInt() || !data.isSeq()) return {};
    const std::int64_t count = static_cast<std::int64_t>(static_cast<int>(rows)) * static_cast<int>(columns);
    if (count < 1 || static_cast<std::size_t>(count) != data.size()) return {};
    std::vector<double> values;
    for (const cv::FileNode& value : data) {
      if (!value.isInt() && !value.isReal()) return {};
      values.push_back(static_cast<double>(value));
    }
    return values;
  }

  std::string file_;
  cv::FileStorage storage_;
  std::vector<settings::Problem> problems_;
};

}  // namespace

Camera ReadOpenCvXml(const std::filesystem::path& file) {
  try {
    return OpenCvXml(file).Read();
  } catch (const settings::Error&) {
    throw;
  } catch (const cv::Exception& error) {
    throw settings::Error({{file.string(), 0, 0, "OpenCV cannot read it: " + error.err}});
  } catch (const std::exception& error) {  // the parser passes on those of the standard library
    throw settings::Error({{file.string(), 0, 0, std::string("OpenCV cannot read it: ") + error.what()}});
  }
}

}  // namespace vo
