#include "tools/bench/live/http_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace vobench {
namespace {

constexpr std::string_view kEndOfLine = "\r\n";

std::string_view NextLine(std::string_view& text) {
  const std::size_t end = text.find(kEndOfLine);
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + kEndOfLine.size());
  return line;
}

bool IsHost(std::string_view name) {
  constexpr std::string_view kHost = "host";
  return std::equal(name.begin(), name.end(), kHost.begin(), kHost.end(),
                    [](unsigned char a, char b) { return std::tolower(a) == b; });
}

std::string_view Trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

const char* Phrase(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 400:
      return "Bad Request";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    default:
      return "Request Header Fields Too Large";  // 431
  }
}

}  // namespace

std::optional<std::size_t> HeadLength(std::string_view bytes) {
  constexpr std::string_view kEnd = "\r\n\r\n";
  const std::size_t end = bytes.find(kEnd);
  if (end == std::string_view::npos) return std::nullopt;
  return end + kEnd.size();
}

std::optional<HttpRequest> ParseHead(std::string_view head) {
  const std::string_view first = NextLine(head);
  const std::size_t method = first.find(' '), path = first.rfind(' ');
  if (method == std::string_view::npos || path <= method || !first.substr(path + 1).starts_with("HTTP/1.")) {
    return std::nullopt;
  }
  HttpRequest request{std::string(first.substr(0, method)), std::string(first.substr(method + 1, path - method - 1)),
                      ""};
  bool told = false;
  while (!head.empty()) {
    const std::string_view line = NextLine(head);
    if (line.empty()) break;
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) return std::nullopt;
    if (!IsHost(line.substr(0, colon))) continue;
    if (told) return std::nullopt;
    told = true;
    request.host = Trimmed(line.substr(colon + 1));
  }
  return request;
}

std::string AnswerHead(int status, std::size_t bytes, std::string_view more) {
  return fmt::format("HTTP/1.1 {} {}\r\nContent-Length: {}\r\nConnection: close\r\n{}\r\n", status, Phrase(status),
                     bytes, more);
}

}  // namespace vobench
