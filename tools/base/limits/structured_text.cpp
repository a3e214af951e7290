#include "tools/base/limits/structured_text.h"

#include <algorithm>

namespace limits {
namespace {

int DeepestElement(std::string_view text) {
  int depth = 0, deepest = 0;
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    if (text[i] != '<') continue;
    if (text[i + 1] == '/') {
      depth = std::max(0, depth - 1);
    } else if (text[i + 1] != '?' && text[i + 1] != '!') {
      deepest = std::max(deepest, ++depth);
    }
  }
  return deepest;
}

}  // namespace

std::string JsonProblem(std::string_view text) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kDeepestJson) return "nested more than " + std::to_string(kDeepestJson) + " deep";
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return "";
}

std::string OpenCvStorageProblem(std::string_view text) {
  if (text.size() > kMostStorageBytes) return "larger than " + std::to_string(kMostStorageBytes) + " bytes";
  if (text.find('\0') != std::string_view::npos)
    return "no text: it has a byte of zero";  // a null pointer in OpenCV's reader, as where it breaks off
  const std::string_view whole = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
  if (!whole.ends_with("</opencv_storage>")) return "cut off: it does not end with </opencv_storage>";
  return DeepestElement(text) > kDeepestStorage ? "nested more than " + std::to_string(kDeepestStorage) + " deep" : "";
}

}  // namespace limits
