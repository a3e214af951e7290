// Message of an expected exception.
#pragma once

#include <string>

namespace evaluation {

// The message of the Error that `call` throws; empty where it throws none. Other exceptions pass.
template <class Error, class Call>
std::string ComplaintOf(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace evaluation
