#include "tools/limits/opencv_storage.h"

#include <algorithm>
#include <cctype>

namespace limits {
namespace {

// Of brackets and braces, wherever they stand, also in what is a text: more than there are, never less.
int DeepestBracket(std::string_view text) {
  int depth = 0, deepest = 0;
  for (const char c : text) {
    if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
    if (c == ']' || c == '}') depth = std::max(0, depth - 1);
  }
  return deepest;
}

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

// "- - - x" is three lists on one line, "a: b: x" two maps. Each deeper level on a line of its own is further to the
// right: a megabyte has room for 1400.
int MostOnOneLine(std::string_view text) {
  int here = 0, most = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool ends = i + 1 == text.size() || std::isspace(static_cast<unsigned char>(text[i + 1])) != 0;
    if ((text[i] == '-' || text[i] == '?') && ends) ++here;
    if (text[i] == ':') ++here;
    if (text[i] == '\n' || text[i] == '\r') here = 0;
    most = std::max(most, here);
  }
  return most;
}

}  // namespace

std::string OpenCvStorageProblem(std::string_view text) {
  if (text.size() > kMostStorageBytes) return "larger than " + std::to_string(kMostStorageBytes) + " bytes";
  if (text.find('\0') != std::string_view::npos)
    return "no text: it has a byte of zero";  // a null pointer in OpenCV's reader of XML
  if (text.starts_with("<?xml")) {            // the same, where it breaks off
    const std::string_view whole = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
    if (!whole.ends_with("</opencv_storage>")) return "cut off: it does not end with </opencv_storage>";
  }
  const bool deep = text.starts_with("<?xml") ? DeepestElement(text) > kDeepestStorage
                                              : std::max(DeepestBracket(text), MostOnOneLine(text)) > kDeepestStorage;
  return deep ? "nested more than " + std::to_string(kDeepestStorage) + " deep" : "";
}

}  // namespace limits
