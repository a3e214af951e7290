// Exceptions by exit status: BadInput is a mistake of the caller (2), NotConsistent an inconsistent system where
// consistency was required (3); every other exception means that the work failed (1).
#pragma once

#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace vobench {

struct BadInput : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The work is done and written; a system is not consistent with its own model though that was required.
struct NotConsistent : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The work was stopped by a signal (exit 1); the message states what was kept.
struct Interrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Message of an exception; "PATH: why" for file system errors, which the standard library orders differently.
inline std::string WordsOf(const std::exception& error) {
  const auto* of_file = dynamic_cast<const std::filesystem::filesystem_error*>(&error);
  if (of_file == nullptr) return error.what();
  const std::string to = of_file->path2().empty() ? "" : " -> " + of_file->path2().string();
  return of_file->path1().string() + to + ": " + of_file->code().message();
}

// Reads an input: exceptions in there become BadInput. The libraries' messages name file, line and value.
template <class Function>
auto Input(Function&& read) {
  try {
    return std::forward<Function>(read)();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw BadInput(WordsOf(error));
  }
}

}  // namespace vobench
