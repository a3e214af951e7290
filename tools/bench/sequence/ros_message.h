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

template <class T>
std::string Bytes(T number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}
// With its length before it.
inline std::string Sized(std::string_view text) { return Bytes(static_cast<std::uint32_t>(text.size())).append(text); }

struct RosType {
  const char *package, *name, *md5, *definition, *definition2;  // definition2: of ROS 2
};

class RosMessage {
 public:
  explicit RosMessage(bool ros2) : bytes(ros2 ? std::string("\0\1\0\0", 4) : ""), ros2_(ros2) {}

  void Put(const auto&... values) { (PutOne(values), ...); }
  void PutData(std::string_view data) {
    Put(static_cast<std::uint32_t>(data.size()));
    bytes += data;
  }
  void PutNumbers(std::initializer_list<double> numbers) {
    for (const double number : numbers) Put(number);
  }

  std::string bytes;

 private:
  template <class T>
  void PutOne(const T& value) {
    if constexpr (std::convertible_to<T, std::string>) {
      const std::string text(value);
      PutData(ros2_ ? std::string_view(text.c_str(), text.size() + 1) : text);
    } else {
      while (ros2_ && (bytes.size() - 4) % sizeof(T) != 0) bytes += '\0';
      bytes += Bytes(value);
    }
  }
  bool ros2_;
};

}  // namespace vobench
