#include "tests/unit/bench/report/page_data.h"

#include <gtest/gtest.h>

#include <cstring>

namespace vobench::report {
namespace {

std::string Decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0, value = 0;
  for (const char c : text) {
    if (c == '=') break;
    value = value << 6 | static_cast<unsigned>(digits.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(value >> bits & 0xFFu);
  }
  return bytes;
}

}  // namespace

nlohmann::json DataOf(const std::string& html) {
  const std::string start = "<script type=\"application/json\" id=\"data\">";
  const std::size_t begin = html.find(start);
  if (begin == std::string::npos) {
    ADD_FAILURE() << "the page has no data";
    return {};
  }
  const std::size_t text = begin + start.size();
  return nlohmann::json::parse(html.substr(text, html.find("</script>", text) - text));
}

nlohmann::json FigureOf(const nlohmann::json& data, const std::string& title) {
  for (const nlohmann::json& figure : data.at("figures")) {
    if (figure.at("title") == title) return figure;
  }
  return {};
}

std::vector<float> Column(const nlohmann::json& data, const nlohmann::json& index) {
  const std::string bytes = Decoded(data.at("columns").at(index.get<std::size_t>()).get<std::string>());
  std::vector<float> numbers(bytes.size() / 4);
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * 4);
  return numbers;
}

}  // namespace vobench::report
