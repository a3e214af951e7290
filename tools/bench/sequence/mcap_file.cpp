// MCAP format 0: a record is its number, the length of its content as 64 bits, and the content.
#include "tools/bench/sequence/export_files.h"

namespace vobench {
namespace {

using Id = std::uint16_t;

constexpr char kMagic[] = "\x89MCAP0\r\n";

std::string Record(char op, const std::string& content) {
  return std::string(1, op) + Bytes(std::uint64_t{content.size()}) + content;
}
std::string Time(std::int64_t stamp_ns) { return Bytes(static_cast<std::uint64_t>(stamp_ns)); }

class McapFile : public MessageFile {
 public:
  explicit McapFile(const std::filesystem::path& file) : MessageFile(file, true) {
    Append(kMagic + Record(1, Sized("ros2") + Sized("vobench")));
  }

 private:
  // A schema and a channel of one number, which counts from 1.
  std::string ConnectionRecord(std::uint32_t channel) const override {
    const auto& [topic, type, count] = channels_[channel];
    const std::string id = Bytes(static_cast<Id>(channel + 1));
    return Record(3, id + Sized(std::string(type->package) + "/msg/" + type->name) + Sized("ros2msg") +
                         Sized(type->definition2)) +
           Record(4, id + id + Sized(topic) + Sized("cdr") + Sized(""));
  }
  std::string MessageRecord(std::uint32_t channel, std::int64_t stamp_ns, const std::string& message) const override {
    return Record(5, Bytes(static_cast<Id>(channel + 1)) + Bytes(static_cast<std::uint32_t>(channels_[channel].count)) +
                         Time(stamp_ns) + Time(stamp_ns) + message);
  }

  void Write(const Chunk& chunk) override {
    const std::string times = Time(chunk.first_ns) + Time(chunk.last_ns),
                      size = Bytes(std::uint64_t{chunk.records.size()});
    if (chunks_ == 0) first_ns_ = chunk.first_ns;
    last_ns_ = chunk.last_ns;
    ++chunks_;
    const std::uint64_t start = position_;
    Append(Record(6, times + size + Bytes(std::uint32_t{0}) + Sized("") + size + chunk.records));  // no check sum
    const std::uint64_t end = position_;
    std::string offsets;
    for (const auto& [channel, messages] : chunk.index) {
      std::string places;
      for (const auto& [stamp_ns, offset] : messages) places += Time(stamp_ns) + Bytes(offset);
      offsets += Bytes(static_cast<Id>(channel + 1)) + Bytes(position_);
      Append(Record(7, Bytes(static_cast<Id>(channel + 1)) + Sized(places)));
    }
    chunk_index_ += Record(8, times + Bytes(start) + Bytes(end - start) + Sized(offsets) + Bytes(position_ - end) +
                                  Sized("") + size + size);
  }

  void WriteEnd() override {
    Append(Record(0x0f, Bytes(std::uint32_t{0})));
    const std::uint64_t summary = position_;
    std::uint64_t messages = 0;
    std::string counts;
    for (std::uint32_t channel = 0; channel < channels_.size(); ++channel) {
      Append(ConnectionRecord(channel));
      messages += channels_[channel].count;
      counts += Bytes(static_cast<Id>(channel + 1)) + Bytes(channels_[channel].count);
    }
    const auto channels = static_cast<std::uint32_t>(channels_.size());
    Append(chunk_index_ +
           Record(0x0b, Bytes(messages) + Bytes(static_cast<Id>(channels)) + Bytes(channels) + Bytes(std::uint64_t{0}) +
                            Bytes(chunks_) + Time(first_ns_) + Time(last_ns_) + Sized(counts)));
    Append(Record(2, Bytes(summary) + Bytes(std::uint64_t{0}) + Bytes(std::uint32_t{0})) + kMagic);
  }

  std::uint32_t chunks_ = 0;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  std::string chunk_index_;
};

}  // namespace

std::unique_ptr<MessageFile> MakeMcap(const std::filesystem::path& file) { return std::make_unique<McapFile>(file); }

}  // namespace vobench
