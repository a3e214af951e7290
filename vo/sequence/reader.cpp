#include "vo/sequence/reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "tools/base/limits/picture.h"
#include "tools/base/text.h"

namespace vo {
namespace {

namespace fs = std::filesystem;

// TUM's lists have seconds, not below 0.
std::optional<std::int64_t> StampInSeconds(std::string_view text) {
  const auto stamp_ns = base::ParseSeconds(text);
  return stamp_ns && *stamp_ns >= 0 ? stamp_ns : std::nullopt;
}

// ICL-NUIM numbers its frames at 30 Hz.
std::optional<std::int64_t> StampInFrames(std::string_view text) {
  const auto index = text.size() <= 9 ? base::ParseWhole(text) : std::nullopt;
  return index && *index >= 0 ? std::optional((*index * 1'000'000'000 + 15) / 30) : std::nullopt;
}

// EuRoC counts nanoseconds.
std::optional<std::int64_t> StampInNanoseconds(std::string_view text) {
  const auto stamp_ns = base::ParseWhole(text);
  return stamp_ns && *stamp_ns >= 0 && *stamp_ns <= base::kLatest_ns ? stamp_ns : std::nullopt;
}

// List of frames, one per line: the first word is the stamp.
struct ListFormat {
  fs::path list, images;  // file names are relative to `images`
  std::size_t words;
  std::optional<std::int64_t> (*stamp)(std::string_view);
  std::string not_a_stamp, expected;
  bool is_monocular = false;  // TUM's data set: `number time`, and mostly an exposure
};

// Whether an association's first words are seconds: one has a point. ICL-NUIM's have none, TUM's most.
bool HasSeconds(const fs::path& list) {
  std::ifstream stream(list);
  for (std::string line; std::getline(stream, line);) {
    const std::vector<base::Word> words = base::SplitWords(line);
    if (!words.empty() && !base::IsComment(words[0].text) && words[0].text.find('.') != std::string_view::npos)
      return true;
  }
  return false;
}

ListFormat FormatOf(const fs::path& folder, int camera) {
  if (!fs::exists(folder / "rgb.txt")) {
    for (const char* name : {"associations.txt", "association.txt", "associate.txt"}) {
      if (fs::exists(folder / name))
        return {folder / name,
                folder,
                4,
                HasSeconds(folder / name) ? StampInSeconds : StampInFrames,
                "a time stamp in seconds or the number of a frame",
                "stamp depth-file stamp image-file, or stamp image-file stamp depth-file"};
    }
    for (const char* images : {"image_0", "image_2"}) {  // KITTI's left cameras, grey and colour
      if (fs::exists(folder / "times.txt") && fs::is_directory(folder / images))
        return {folder / "times.txt", folder / images, 1, StampInSeconds, "a time in seconds", "time"};
    }
    if (fs::exists(folder / "times.txt") && fs::is_directory(folder / "images"))
      return {folder / "times.txt", folder / "images",      2,   StampInSeconds,
              "a time in seconds",  "number time exposure", true};
    if (fs::exists(folder / "mav0")) {
      const fs::path of = folder / ("mav0/cam" + std::to_string(camera));
      return {of / "data.csv", of / "data", 2, StampInNanoseconds, "a time stamp in nanoseconds", "timestamp,filename"};
    }
  }
  return {folder / "rgb.txt", folder, 2, StampInSeconds, "a time stamp in seconds", "timestamp filename"};
}

// A 16-bit grey PNG: depth, where it stands beside another picture.
bool IsDepth(const fs::path& file) {
  std::array<char, 26> head{};
  std::ifstream(file, std::ios::binary).read(head.data(), head.size());
  constexpr int kBits = 24, kColour = 25;
  return std::string_view(head.data(), 4) == "\x89PNG" && head[kBits] == 16 && head[kColour] == 0;
}

// Of the picture in KITTI's line `index`.
std::string NumberedName(std::size_t index) {
  const std::string digits = std::to_string(index);
  return std::string(6 - std::min<std::size_t>(6, digits.size()), '0') + digits + ".png";
}

// Of the picture that TUM's monocular data set numbers `number`.
std::string NumberedName(const fs::path& folder, std::string_view number) {
  const std::string name(number);
  std::error_code error;
  return name + (fs::exists(folder / (name + ".png"), error) ? ".png" : ".jpg");
}

// A file's name as lists have it, those made on Windows too.
std::string NameOf(const base::Word& word) {
  std::string name(word.text);
  std::ranges::replace(name, '\\', '/');
  std::erase(name, '"');
  return name;
}

// The words of "stamp name" where the name of a picture that is there has blanks or commas in it.
void JoinName(const fs::path& folder, std::vector<base::Word>& words) {
  const base::Word &first = words[1], &last = words.back();
  const char* end = last.text.data() + last.text.size();
  const base::Word name{{first.text.data(), static_cast<std::size_t>(end - first.text.data())}, first.column};
  std::error_code error;
  if (fs::is_regular_file(folder / NameOf(name), error)) words = {words[0], name};
}

// Which word names the image: the last; of a list of associations the picture that is no depth, which programs write
// first or last. 0: both are.
std::size_t ImageWord(const std::vector<base::Word>& words, const fs::path& folder) {
  const std::size_t last = words.size() - 1;
  if (words.size() < 4) return last;
  const auto is_called = [&](std::size_t i) { return words[i].text.find("depth") != std::string_view::npos; };
  for (const std::size_t i : {last, last - 2}) {
    if (!IsDepth(folder / NameOf(words[i])) && !(is_called(i) && !is_called(i == last ? last - 2 : last))) return i;
  }
  return 0;
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
  for (const std::string& problem : {limits::PictureProblem(bytes), limits::PictureEndProblem(bytes)}) {
    if (!problem.empty()) throw std::runtime_error(file.string() + ": " + problem);
  }
  cv::Mat image = Decode(bytes, file);
  if (image.empty()) throw std::runtime_error(file.string() + ": not an image that can be decoded");
  if (image.depth() != CV_8U && image.depth() != CV_16U)
    throw std::runtime_error(file.string() + ": expected an image of 8 or 16 bits");
  if (image.channels() == 4) cv::cvtColor(image, image, cv::COLOR_BGRA2BGR);  // alpha is not used
  if (image.depth() == CV_8U) return image;
  cv::Mat eight_bits;
  image.convertTo(eight_bits, CV_8U, 255.0 / 65535);
  return eight_bits;
}

}  // namespace

std::string RigProblem(const fs::path& folder) {
  if (!fs::exists(folder / "rig.yaml") || fs::exists(folder / "mav0")) return "";
  for (const char* list : {"rgb.txt", "associations.txt"})
    if (fs::exists(folder / list)) return "";
  return folder.string() + ": is the folder of a rig (rig.yaml); name that of one camera, such as " +
         (folder / "cam0").string();
}

SequenceReader::SequenceReader(const fs::path& folder, Images images, int camera) {
  if (!fs::is_directory(folder)) throw std::runtime_error(folder.string() + ": no such folder");
  if (const std::string problem = RigProblem(folder); !problem.empty()) throw std::runtime_error(problem);
  const ListFormat format = FormatOf(folder, camera);
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
    if (const std::string problem = number == 1 ? base::TextProblem(line) : ""; !problem.empty())
      throw std::runtime_error(list.string() + ": " + problem);
    std::vector<base::Word> words = base::SplitWords(number == 1 ? base::WithoutMark(line) : line);
    if (words.empty() || base::IsComment(words[0].text)) continue;
    if (format.is_monocular && (words.size() == 2 || words.size() == 3)) words = {words[1], words[0]};
    if (format.words == 2 && words.size() > 2) JoinName(format.images, words);
    if (entries_.empty() && problems.empty() && words[0].text.starts_with("time")) continue;  // names of columns
    const std::size_t of_image = words.size() == format.words ? ImageWord(words, format.images) : 0;
    const std::string stamp(words[of_image == 0 ? 0 : of_image - 1].text);
    const auto stamp_ns = format.stamp(stamp);
    if (!stamp_ns) {
      const std::string unit = format.stamp != StampInNanoseconds ? base::UnitOfStamp(stamp) : "";
      complain("'" + stamp + "' is not " + format.not_a_stamp + unit);
      if (!unit.empty()) break;  // so are all
      continue;
    }
    if (words.size() != format.words) {
      complain("expected '" + format.expected + "'");
      continue;
    }
    if (!entries_.empty() && *stamp_ns <= entries_.back().stamp_ns)
      complain("time stamp " + stamp + " does not increase over line " + std::to_string(last_number));
    const bool is_numbered = format.words == 1;
    const fs::path image = format.images / (format.is_monocular ? NumberedName(format.images, words[of_image].text)
                                            : is_numbered       ? NumberedName(entries_.size())
                                                                : NameOf(words[of_image]));
    std::error_code error;  // a name that is too long is reported like other problems
    if (of_image == 0 && !is_numbered) {
      complain("both pictures are depth (grey of 16 bits)");
    } else if (images == Images::needed && !fs::is_regular_file(image, error)) {
      complain("image " + image.string() + " is not there");
    }
    entries_.push_back({*stamp_ns, image});
    last_number = number;
  }
  constexpr std::int64_t kShortest_ns = 1'000'000;
  if (format.stamp == StampInNanoseconds && problems.empty() && entries_.size() > 1 &&
      entries_[1].stamp_ns - entries_[0].stamp_ns < kShortest_ns)
    problems.push_back(list.string() + ": the first frames are less than a millisecond apart: stamps are nanoseconds");
  constexpr std::int64_t kLongest_ns = 10'000'000'000;
  const auto is_far = [](const Entry& a, const Entry& b) { return b.stamp_ns - a.stamp_ns >= kLongest_ns; };
  if (problems.empty() && entries_.size() > 1 &&
      std::ranges::adjacent_find(entries_, std::not_fn(is_far)) == entries_.end())
    problems.push_back(list.string() + ": all frames are 10 s and more apart: stamps are " +
                       (format.stamp == StampInNanoseconds ? "nanoseconds" : "seconds"));
  if (problems.empty() && entries_.empty()) problems.push_back(list.string() + ": no frames");
  if (!problems.empty()) throw std::runtime_error(base::JoinProblems(problems));
}

std::optional<Frame> SequenceReader::Next() {
  if (next_ == entries_.size()) return std::nullopt;
  const Entry& entry = entries_[next_++];
  Frame frame{entry.stamp_ns, ReadImage(entry.image)};
  if (size_.empty()) size_ = frame.image.size();
  if (frame.image.size() != size_) {
    const auto text = [](const cv::Size& size) {
      return std::to_string(size.width) + " x " + std::to_string(size.height);
    };
    throw std::runtime_error(entry.image.string() + ": is " + text(frame.image.size()) +
                             " pixels, but the first image is " + text(size_));
  }
  return frame;
}

}  // namespace vo
