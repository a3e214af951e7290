// Copy of the scenes with textures of a quarter of the width: alike in small images, and loaded in a fifth of the time.
// Usage: small_scenes FROM TO
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <stdexcept>
#include <string>

namespace fs = std::filesystem;

int main(int argc, char** argv) {
  if (argc != 3) throw std::invalid_argument("usage: small_scenes FROM TO");
  const fs::path to = argv[2];
  fs::remove_all(to);
  fs::copy(argv[1], to, fs::copy_options::recursive);
  const std::set<std::string> pictures = {".jpg", ".png"};
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(to)) {
    if (!pictures.contains(entry.path().extension().string())) continue;
    const std::string file = entry.path().string();
    cv::Mat picture = cv::imread(file, cv::IMREAD_UNCHANGED);
    if (picture.cols < 400) continue;
    cv::resize(picture, picture, {}, 0.25, 0.25, cv::INTER_AREA);
    if (!cv::imwrite(file, picture)) throw std::runtime_error(file + ": cannot be written");
  }
}
