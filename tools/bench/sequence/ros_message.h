// Binary form of a ROS message: packed (ROS 1), or CDR, aligned and with a head of four bytes (ROS 2).
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace vobench {

static_assert(std::endian::native == std::endian::little, "numbers are written as the machine has them");

// As the machine has it.
template <class T>
std::string Bytes(T number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}
// With its length before it.
inline std::string Sized(const std::string& text) { return Bytes(static_cast<std::uint32_t>(text.size())) + text; }

struct RosType {
  const char *name, *name2, *md5, *definition, *definition2;  // name2 and definition2: of ROS 2
};

class RosMessage {
 public:
  explicit RosMessage(bool ros2) : ros2_(ros2), bytes_(ros2 ? std::string("\0\1\0\0", 4) : "") {}
  RosMessage(bool ros2, std::int64_t stamp_ns, const std::string& frame) : RosMessage(ros2) {
    if (!ros2) Put(std::uint32_t{0});  // seq
    Put(static_cast<std::uint32_t>(stamp_ns / 1'000'000'000));
    Put(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000));
    Put(frame);
  }

  template <class T>
  requires std::integral<T> || std::floating_point<T>
  void Put(T number) {
    while (ros2_ && (bytes_.size() - 4) % sizeof(T) != 0) bytes_ += '\0';
    bytes_ += Bytes(number);
  }
  void Put(const std::string& text) {
    Put(static_cast<std::uint32_t>(text.size() + ros2_));
    bytes_ += text + std::string(ros2_ ? 1 : 0, '\0');
  }
  void PutBytes(std::string_view data) {
    Put(static_cast<std::uint32_t>(data.size()));
    bytes_ += data;
  }
  void Put(std::initializer_list<double> numbers) {
    for (const double number : numbers) Put(number);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  bool ros2_;
  std::string bytes_;
};

}  // namespace vobench
