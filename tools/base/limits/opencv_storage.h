// Purpose: whether an XML text may be given to OpenCV's cv::FileStorage, which parses by recursion and has no bound (4.6): a few
//          10 kB of "<a><a><a>" end the program. (Its YAML is read by tools/settings.)
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace limits {

constexpr std::size_t kMostStorageBytes = 1 << 20;
constexpr int kDeepestStorage = 100;  // elements in each other

// What is wrong; empty: nothing.
std::string OpenCvStorageProblem(std::string_view text);

}  // namespace limits
