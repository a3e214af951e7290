#include "vo/sequence/reader.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "tools/base/limits/picture.h"
#include "tools/base/text.h"

namespace vo {
namespace {

namespace fs = std::filesystem;

// ICL-NUIM numbers its frames at 30 Hz.
std::optional<std::int64_t> StampOfIndex(std::string_view text) {
  const auto index = text.size() <= 9 ? base::ParseWhole(text) : std::nullopt;
  return index && *index >= 0 ? std::optional((*index * 1'000'000'000 + 15) / 30) : std::nullopt;
}

// EuRoC counts nanoseconds.
std::optional<std::int64_t> StampInNanoseconds(std::string_view text) {
  const auto stamp_ns = base::ParseWhole(text);
  return stamp_ns && *stamp_ns >= 0 ? stamp_ns : std::nullopt;
}

// List of frames, one per line: the first word is the stamp, the last one the image.
struct ListFormat {
  fs::path list, images;  // file names are relative to `images`
  std::size_t words;
  std::optional<std::int64_t> (*stamp)(std::string_view);
  std::string not_a_stamp, expected;
};

ListFormat FormatOf(const fs::path& folder) {
  if (!fs::exists(folder / "rgb.txt")) {
    if (fs::exists(folder / "associations.txt"))
      return {folder / "associations.txt",        folder, 4, StampOfIndex, "the number of a frame",
              "index depth-file index image-file"};
    if (fs::exists(folder / "mav0"))
      return {folder / "mav0/cam0/data.csv", folder / "mav0/cam0/data", 2, StampInNanoseconds,
              "a time stamp in nanoseconds", "timestamp,filename"};
  }
  return {folder / "rgb.txt", folder, 2, base::ParseStamp, "a time stamp in seconds", "timestamp filename"};
}

// Words separated by blanks or commas.
std::vector<std::string> Words(std::string line) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), std::istream_iterator<std::string>()};
}

// Whether a PNG or JPEG has its end marker: OpenCV decodes a truncated file, and fills the rest with grey.
bool IsComplete(const std::vector<std::uint8_t>& bytes) {
  static constexpr std::uint8_t png[] = {0x89, 'P', 'N', 'G'};
  static constexpr std::uint8_t iend[] = {'I', 'E', 'N', 'D', 0xAE, 0x42, 0x60, 0x82};
  if (bytes.size() < 12) return false;
  if (std::equal(std::begin(png), std::end(png), bytes.begin()))
    return std::search(bytes.end() - 12, bytes.end(), std::begin(iend), std::end(iend)) != bytes.end();
  if (bytes[0] == 0xFF && bytes[1] == 0xD8) return bytes[bytes.size() - 2] == 0xFF && bytes[bytes.size() - 1] == 0xD9;
  return true;
}

cv::Mat Decode(const std::vector<std::uint8_t>& bytes, const fs::path& file) {
  try {
    return cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& error) {
    throw std::runtime_error(file.string() + ": cannot be decoded: " + error.err);
  }
}

cv::Mat ReadImage(const fs::path& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  std::vector<std::uint8_t> bytes(in ? static_cast<std::size_t>(in.tellg()) : 0);
  in.seekg(0);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in || bytes.empty()) throw std::runtime_error(file.string() + ": cannot be read, or is empty");
  if (!IsComplete(bytes)) throw std::runtime_error(file.string() + ": image breaks off before its end");
  if (const std::string problem = limits::PictureProblem(bytes); !problem.empty())
    throw std::runtime_error(file.string() + ": " + problem);
  const cv::Mat image = Decode(bytes, file);
  if (image.empty()) throw std::runtime_error(file.string() + ": not an image that can be decoded");
  if ((image.depth() != CV_8U && image.depth() != CV_16U) || (image.channels() != 1 && image.channels() != 3))
    throw std::runtime_error(file.string() + ": expected a grey or colour image of 8 or 16 bits");
  if (image.depth() == CV_8U) return image;
  cv::Mat eight_bits;
  image.convertTo(eight_bits, CV_8U, 255.0 / 65535);
  return eight_bits;
}

}  // namespace

SequenceReader::SequenceReader(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw std::runtime_error(folder.string() + ": no such folder");
  const ListFormat format = FormatOf(folder);
  const fs::path& list = format.list;
  std::ifstream in(list);
  if (!in)
    throw std::runtime_error(list.string() +
                             ": cannot be read (a sequence folder has one, see docs/sequence_format.md)");
  std::vector<std::string> problems;
  std::string line;
  int number = 0, last_number = 0;
  while (std::getline(in, line)) {
    ++number;
    const auto complain = [&](const std::string& text) {
      problems.push_back(list.string() + ":" + std::to_string(number) + ": " + text);
    };
    const std::vector<std::string> words = Words(line);
    if (words.empty() || words[0][0] == '#') continue;
    const auto stamp_ns = format.stamp(words[0]);
    if (!stamp_ns) {
      complain("'" + words[0] + "' is not " + format.not_a_stamp);
      continue;
    }
    if (words.size() != format.words) {
      complain("expected '" + format.expected + "'");
      continue;
    }
    if (!entries_.empty() && *stamp_ns <= entries_.back().stamp_ns)
      complain("time stamp " + words[0] + " does not increase over line " + std::to_string(last_number));
    const fs::path image = format.images / words.back();
    std::error_code error;  // a name that is too long is reported like other problems
    if (!fs::is_regular_file(image, error)) complain("image " + image.string() + " is not there");
    entries_.push_back({*stamp_ns, image});
    last_number = number;
  }
  if (problems.empty() && entries_.empty()) problems.push_back(list.string() + ": no frames");
  if (!problems.empty()) throw std::runtime_error(base::Join(problems, "\n"));
}

std::optional<Frame> SequenceReader::Next() {
  if (next_ == entries_.size()) return std::nullopt;
  const Entry& entry = entries_[next_++];
  return Frame{entry.stamp_ns, ReadImage(entry.image)};
}

}  // namespace vo
