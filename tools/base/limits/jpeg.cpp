#include "tools/base/limits/jpeg.h"

#include <algorithm>
#include <array>
#include <vector>

namespace limits {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr const char* kTruncated = "truncated JPEG: the end marker is missing";

bool IsRestart(std::uint8_t marker) { return marker >= 0xd0 && marker <= 0xd7; }

// Huffman code: by the next 16 bits, 256 times its length and the symbol; 0: there is none. Codes of up to 9 bits are
// in a small table, too.
struct Code {
  std::vector<std::uint16_t> of;
  std::array<std::uint16_t, 1 << 9> short_codes{};

  unsigned At(unsigned bits) const { return short_codes[bits >> 7] != 0 ? short_codes[bits >> 7] : of[bits]; }

  void Read(Bytes counts, Bytes symbols) {
    of.assign(1 << 16, 0);
    std::size_t code = 0, symbol = 0;
    for (std::size_t length = 1; length <= 16; ++length) {
      const std::size_t span = std::size_t{1} << (16 - length);
      for (int i = 0; i < counts[length - 1] && symbol < symbols.size() && (code + 1) * span <= of.size(); ++i)
        std::fill_n(of.begin() + static_cast<std::ptrdiff_t>(code++ * span), span,
                    static_cast<std::uint16_t>(length << 8 | symbols[symbol++]));
      code <<= 1;
    }
    for (std::size_t i = 0; i < short_codes.size(); ++i) short_codes[i] = of[i << 7] >> 8 <= 9 ? of[i << 7] : 0;
  }
};

// Bits of one interval between restarts, without stuffed zeros.
class Bits {
 public:
  explicit Bits(Bytes coded) {
    bytes_.reserve(coded.size() + 4);
    while (!coded.empty()) {
      const auto marker = std::ranges::find(coded, std::uint8_t{0xff});
      const auto end = static_cast<std::size_t>(marker - coded.begin());
      bytes_.insert(bytes_.end(), coded.begin(),
                    coded.begin() + static_cast<std::ptrdiff_t>(std::min(end + 1, coded.size())));
      coded = coded.subspan(std::min(end + 2, coded.size()));
    }
    size_ = 8 * bytes_.size();
    bytes_.resize(bytes_.size() + 4);
  }
  // The symbol of the next code, and its extra bits skipped: as many as its lower half says. -1: none, or no bits.
  int Next(const Code& code) {
    const std::uint8_t* at = &bytes_[at_ / 8];
    const std::uint32_t next = std::uint32_t{at[0]} << 24 | at[1] << 16 | at[2] << 8 | at[3];
    const unsigned found = code.At(next << (at_ % 8) >> 16);
    at_ += (found >> 8) + (found & 15u);
    return found == 0 || at_ > size_ ? -1 : static_cast<int>(found & 255u);
  }
  // Bytes that are left; none where they are padding.
  std::size_t Left() const {
    const auto rest = std::span(bytes_).subspan((at_ + 7) / 8, (size_ - at_) / 8);
    const bool is_padding = std::ranges::all_of(rest, [&](std::uint8_t byte) { return byte == rest[0]; });
    return is_padding ? 0 : rest.size();
  }

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t size_ = 0, at_ = 0;
};

class Walk {
 public:
  explicit Walk(Bytes file) : file_(file) {}

  std::string Problem() {
    bool in_scan = false;
    for (std::size_t at = 2, scan = 2;;) {
      if (in_scan) {  // entropy-coded data goes on until a marker that is neither a stuffed zero nor a restart
        while (at + 1 < file_.size() && (file_[at] != 0xff || file_[at + 1] == 0x00 || IsRestart(file_[at + 1]))) ++at;
      }
      const std::size_t end_of_scan = at;
      while (at + 1 < file_.size() && file_[at] == 0xff && file_[at + 1] == 0xff) ++at;  // fill bytes
      if (at + 2 > file_.size()) return kTruncated;
      if (file_[at] != 0xff) return "damaged JPEG: no marker at byte " + std::to_string(at);
      if (in_scan && !IsWhole(file_.subspan(scan, end_of_scan - scan)))
        return "damaged JPEG: its data from byte " + std::to_string(scan) + " to byte " + std::to_string(end_of_scan) +
               " cannot be that of the picture";
      const std::uint8_t marker = file_[at + 1];
      if (marker == 0xd9) return "";
      const std::size_t length = at + 4 > file_.size() ? 0 : Word(file_, at + 2);
      if (length > file_.size() - at - 2 || at + 4 > file_.size()) return kTruncated;
      if (length < 2) return "damaged JPEG: no length at byte " + std::to_string(at + 2);
      Read(marker, file_.subspan(at + 4, length - 2));
      at += 2 + length;
      in_scan = marker == 0xda;
      scan = at;
    }
  }

 private:
  struct Component {
    std::uint8_t name = 0;
    std::size_t across = 1, down = 1;  // blocks in a unit of the whole picture
  };
  struct OfScan {
    Component component;
    const Code* dc;
    const Code* ac;
  };

  static std::size_t Word(Bytes bytes, std::size_t at) { return std::size_t{bytes[at]} << 8 | bytes[at + 1]; }

  void Read(std::uint8_t marker, Bytes content) {
    const bool is_frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (marker == 0xc4) {
      while (content.size() > 17) {
        const Bytes counts = content.subspan(1, 16);
        std::size_t symbols = 0;
        for (const std::uint8_t count : counts) symbols += count;
        const Bytes rest = content.subspan(17);
        codes_[content[0] >> 4 & 1][content[0] & 3].Read(counts, rest.first(std::min(symbols, rest.size())));
        content = rest.subspan(std::min(symbols, rest.size()));
      }
    } else if (marker == 0xdd && content.size() >= 2) {
      restart_ = Word(content, 0);
    } else if (is_frame && content.size() >= 6) {
      is_baseline_ = marker <= 0xc1 && content[0] == 8;
      height_ = Word(content, 1), width_ = Word(content, 3);
      components_.clear();
      for (std::size_t i = 6; i + 3 <= content.size(); i += 3) {
        const auto factor = [](int nibble) { return static_cast<std::size_t>(std::max(1, nibble)); };
        components_.push_back({content[i], factor(content[i + 1] >> 4), factor(content[i + 1] & 15)});
        most_across_ = std::max(most_across_, components_.back().across);
        most_down_ = std::max(most_down_, components_.back().down);
      }
    } else if (marker == 0xda) {
      scan_.clear();
      for (std::size_t i = 1; i + 2 <= content.size() && scan_.size() < content[0]; i += 2) {
        const auto of = std::ranges::find(components_, content[i], &Component::name);
        if (of != components_.end())
          scan_.push_back({*of, &codes_[0][content[i + 1] >> 4 & 3], &codes_[1][content[i + 1] & 3]});
      }
    }
  }

  // Whether a scan's data are as many blocks as the picture has. Where codes or sizes are not known here, they are.
  bool IsWhole(Bytes data) const {
    const auto is_known = [](const OfScan& c) { return !c.dc->of.empty() && !c.ac->of.empty(); };
    if (!is_baseline_ || height_ == 0 || scan_.empty() || !std::ranges::all_of(scan_, is_known)) return true;
    const bool is_alone = scan_.size() == 1;
    const auto units = [&](std::size_t size, std::size_t of, std::size_t most) {
      const std::size_t pixels = is_alone ? (size * of + most - 1) / most : size;
      return (pixels + 8 * (is_alone ? 1 : most) - 1) / (8 * (is_alone ? 1 : most));
    };
    const Component& first = scan_[0].component;
    std::size_t left = units(width_, first.across, most_across_) * units(height_, first.down, most_down_);
    while (left > 0) {
      std::size_t end = 0;
      while (end + 1 < data.size() && !(data[end] == 0xff && IsRestart(data[end + 1]))) ++end;
      const bool is_last = end + 1 >= data.size();
      const std::size_t here = restart_ > 0 ? std::min(restart_, left) : left;
      if (!IsInterval(data.first(is_last ? data.size() : end), here, is_alone) || (is_last && here < left))
        return false;
      data = data.subspan(is_last ? data.size() : end + 2);
      left -= here;
    }
    return true;
  }

  bool IsInterval(Bytes data, std::size_t units, bool is_alone) const {
    constexpr std::size_t kMostLeft = 16;  // bytes that cameras leave behind
    Bits bits(data);
    for (; units > 0; --units) {
      for (const OfScan& c : scan_) {
        for (std::size_t blocks = is_alone ? 1 : c.component.across * c.component.down; blocks > 0; --blocks) {
          if (bits.Next(*c.dc) < 0) return false;
          for (int k = 1; k < 64;) {
            const int symbol = bits.Next(*c.ac);
            if (symbol == 0) break;  // the block's end
            k += (symbol >> 4) + 1;
            if (symbol < 0 || k > 64) return false;
          }
        }
      }
    }
    return bits.Left() < kMostLeft;
  }

  Bytes file_;
  bool is_baseline_ = false;
  std::size_t width_ = 0, height_ = 0, restart_ = 0, most_across_ = 1, most_down_ = 1;
  std::vector<Component> components_;
  std::vector<OfScan> scan_;
  std::array<std::array<Code, 4>, 2> codes_;  // of DC and of AC
};

}  // namespace

std::string JpegProblem(Bytes file) { return Walk(file).Problem(); }

}  // namespace limits
