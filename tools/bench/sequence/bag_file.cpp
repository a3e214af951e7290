// ROS bag format 2.0: a record is a header of fields "name=value" and data, each with its length before it.
#include <initializer_list>
#include <utility>

#include "tools/bench/sequence/export_files.h"

namespace vobench {
namespace {

using Fields = std::initializer_list<std::pair<const char*, std::string>>;
using Number = std::uint32_t;

std::string Header(const Fields& fields) {
  std::string header;
  for (const auto& [name, value] : fields) header += Sized(std::string(name) + "=" + value);
  return header;
}
std::string Record(char op, const Fields& fields, const std::string& data) {
  return Sized(Header(fields) + Header({{"op", std::string(1, op)}})) + Sized(data);
}

std::string Time(std::int64_t stamp_ns) {
  return Bytes(static_cast<Number>(stamp_ns / 1'000'000'000)) + Bytes(static_cast<Number>(stamp_ns % 1'000'000'000));
}

class BagFile : public MessageFile {
 public:
  explicit BagFile(const std::filesystem::path& file) : MessageFile(file, false) { Append(Beginning(0)); }

 private:
  struct Written {
    std::uint64_t position;
    std::int64_t first_ns, last_ns;
    std::string counts;  // by connection, of eight bytes each
  };

  // Always 13 + 4096 bytes: it is rewritten at the end.
  std::string Beginning(std::uint64_t index) const {
    const std::string fields = Header({{"index_pos", Bytes(index)},
                                       {"conn_count", Bytes(static_cast<Number>(channels_.size()))},
                                       {"chunk_count", Bytes(static_cast<Number>(chunks_.size()))},
                                       {"op", "\3"}});
    return "#ROSBAG V2.0\n" + Sized(fields) + Sized(std::string(4096 - 8 - fields.size(), ' '));
  }

  std::string ConnectionRecord(Number channel) const override {
    const auto& [topic, type, count] = channels_[channel];
    return Record(7, {{"conn", Bytes(channel)}, {"topic", topic}},
                  Header({{"topic", topic},
                          {"type", std::string(type->package) + "/" + type->name},
                          {"md5sum", type->md5},
                          {"message_definition", type->definition}}));
  }
  std::string MessageRecord(Number channel, std::int64_t stamp_ns, const std::string& message) const override {
    return Record(2, {{"conn", Bytes(channel)}, {"time", Time(stamp_ns)}}, message);
  }

  void Write(const Chunk& chunk) override {
    Written& written = chunks_.emplace_back(Written{position_, chunk.first_ns, chunk.last_ns, ""});
    Append(Record(5, {{"compression", "none"}, {"size", Bytes(static_cast<Number>(chunk.records.size()))}},
                  chunk.records));
    for (const auto& [channel, messages] : chunk.index) {
      const std::string count = Bytes(static_cast<Number>(messages.size()));
      std::string places;
      for (const auto& [stamp_ns, offset] : messages) places += Time(stamp_ns) + Bytes(static_cast<Number>(offset));
      Append(Record(4, {{"ver", Bytes(Number{1})}, {"conn", Bytes(channel)}, {"count", count}}, places));
      written.counts += Bytes(channel) + count;
    }
  }

  void WriteEnd() override {
    const std::uint64_t index = position_;
    for (Number channel = 0; channel < channels_.size(); ++channel) Append(ConnectionRecord(channel));
    for (const Written& chunk : chunks_) {
      Append(Record(6,
                    {{"ver", Bytes(Number{1})},
                     {"chunk_pos", Bytes(chunk.position)},
                     {"start_time", Time(chunk.first_ns)},
                     {"end_time", Time(chunk.last_ns)},
                     {"count", Bytes(static_cast<Number>(chunk.counts.size() / 8))}},
                    chunk.counts));
    }
    file_.Overwrite(Beginning(index));
  }

  std::vector<Written> chunks_;
};

}  // namespace

std::unique_ptr<MessageFile> MakeBag(const std::filesystem::path& file) { return std::make_unique<BagFile>(file); }

}  // namespace vobench
