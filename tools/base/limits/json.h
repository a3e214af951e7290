// Purpose: whether a JSON text may be parsed: nlohmann-json copies and prints values by recursion, so their depth is
// the stack's.
#pragma once

#include <string>
#include <string_view>

namespace limits {

constexpr int kDeepestJson = 100;  // of lists and objects in each other; ours go to ten

// What is wrong; empty: nothing. Whether it is JSON at all is left to the parser.
std::string JsonProblem(std::string_view text);

}  // namespace limits
