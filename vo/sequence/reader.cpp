#include "vo/sequence/reader.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <opencv2/imgcodecs.hpp>

namespace vo {
namespace {

namespace fs = std::filesystem;

// "12.0345" -> nanoseconds, exactly: through integers, never through a double (1305031102.175304 has no double to the ns).
std::optional<std::int64_t> ParseStamp(const std::string& text) {
  const std::size_t dot = text.find('.');
  const std::string whole = text.substr(0, dot);
  std::string fraction = dot == std::string::npos ? "" : text.substr(dot + 1);
  const auto digits = [](const std::string& s) { return std::all_of(s.begin(), s.end(), [](char c) { return c >= '0' && c <= '9'; }); };
  if (whole.empty() || whole.size() > 10 || !digits(whole) || !digits(fraction)) return std::nullopt;
  fraction.resize(9, '0');
  return std::stoll(whole) * 1'000'000'000 + std::stoll(fraction);
}

// OpenCV decodes a PNG or JPEG that breaks off and fills the rest with grey; a whole file ends with its end mark.
bool EndsAsItShould(const std::vector<std::uint8_t>& bytes) {
  static constexpr std::uint8_t png[] = {0x89, 'P', 'N', 'G'};
  static constexpr std::uint8_t iend[] = {'I', 'E', 'N', 'D', 0xAE, 0x42, 0x60, 0x82};
  if (bytes.size() < 12) return false;
  if (std::equal(std::begin(png), std::end(png), bytes.begin()))
    return std::search(bytes.end() - 12, bytes.end(), std::begin(iend), std::end(iend)) != bytes.end();
  if (bytes[0] == 0xFF && bytes[1] == 0xD8)
    return bytes[bytes.size() - 2] == 0xFF && bytes[bytes.size() - 1] == 0xD9;
  return true;
}

cv::Mat ReadImage(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in || bytes.empty()) throw std::runtime_error(file.string() + ": cannot be read, or is empty");
  if (!EndsAsItShould(bytes)) throw std::runtime_error(file.string() + ": image breaks off before its end");
  const cv::Mat image = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  if (image.empty()) throw std::runtime_error(file.string() + ": not an image that can be decoded");
  if (image.depth() != CV_8U || (image.channels() != 1 && image.channels() != 3))
    throw std::runtime_error(file.string() + ": expected an 8-bit grey or colour image");
  return image;
}

}  // namespace

SequenceReader::SequenceReader(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw std::runtime_error(folder.string() + ": no such folder");
  const fs::path list = folder / "rgb.txt";
  std::ifstream in(list);
  if (!in) throw std::runtime_error(list.string() + ": cannot be read (a sequence folder has one, see docs/sequence_format.md)");
  std::ostringstream problems;
  std::string line;
  int number = 0, last_number = 0;
  while (std::getline(in, line)) {
    ++number;
    std::istringstream words(line);
    std::string stamp, name, more;
    if (!(words >> stamp) || stamp[0] == '#') continue;
    const auto complain = [&](const std::string& text) { problems << list.string() << ":" << number << ": " << text << "\n"; };
    const auto stamp_ns = ParseStamp(stamp);
    if (!stamp_ns) {
      complain("'" + stamp + "' is not a time stamp in seconds");
      continue;
    }
    if (!(words >> name) || (words >> more)) {
      complain("expected 'timestamp filename'");
      continue;
    }
    if (!entries_.empty() && *stamp_ns <= entries_.back().stamp_ns)
      complain("time stamp " + stamp + " does not increase over line " + std::to_string(last_number));
    if (!fs::is_regular_file(folder / name)) complain("image " + (folder / name).string() + " is not there");
    entries_.push_back({*stamp_ns, folder / name});
    last_number = number;
  }
  std::string text = problems.str();
  if (text.empty() && entries_.empty()) text = list.string() + ": no frames\n";
  if (!text.empty()) {
    text.pop_back();
    throw std::runtime_error(text);
  }
}

std::optional<Frame> SequenceReader::Next() {
  if (next_ == entries_.size()) return std::nullopt;
  const Entry& entry = entries_[next_++];
  return Frame{entry.stamp_ns, ReadImage(entry.image)};
}

}  // namespace vo
