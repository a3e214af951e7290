// Purpose: the few words of HTTP/1.1 that the live view knows: the head of a request, the head of an answer.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace vobench {

struct HttpRequest {
  std::string method;  // "GET"
  std::string path;    // "/0f...9c/data"
  std::string host;    // "127.0.0.1:40123"; empty without the header
};

// How long the head is, with the empty line that ends it; nothing as long as that has not come.
std::optional<std::size_t> HeadLength(std::string_view bytes);

// Nothing for what is no request: a line that cannot be read, more than one Host.
std::optional<HttpRequest> ParseHead(std::string_view head);

// The head of an answer that ends the connection. `more` are whole header lines, each with its end.
std::string AnswerHead(int status, std::size_t bytes, std::string_view more);

}  // namespace vobench
