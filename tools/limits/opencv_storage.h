// Purpose: whether a YAML or XML text may be given to OpenCV's cv::FileStorage, which parses by recursion and has no
// bound (4.6): a few
//          10 kB of "[[[[" or "- - - -" end the program.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace limits {

constexpr std::size_t kMostStorageBytes = 1 << 20;
constexpr int kDeepestStorage = 100;  // brackets or XML elements in each other; and what can open a level on one line

// What is wrong; empty: nothing.
std::string OpenCvStorageProblem(std::string_view text);

}  // namespace limits
