#include "tools/python/docs.h"

#include <cstring>
#include <stdexcept>
#include <string>

namespace vobench::python {
namespace {

struct Entry {
  const char *key, *text;
};
constexpr Entry kDocs[] = {
#include "docstrings.inc"
};

}  // namespace

const char* Doc(const char* key) {
  for (const Entry& entry : kDocs) {
    if (std::strcmp(entry.key, key) == 0) return entry.text;
  }
  throw std::logic_error(std::string("no documentation of ") + key);
}

}  // namespace vobench::python
