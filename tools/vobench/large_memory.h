// Large blocks of memory in huge pages, where the system gives them on request (the default of Debian). A page of 4 KiB
// takes longer to map than to fill.
// Source: madvise(2); C++20, 17.6.3.2, replacement of the global allocation functions.
#pragma once

namespace vobench {

// Requests huge pages for OpenCV's matrices. The program's operator new does for all other large blocks.
void UseLargePagesForMatrices();

}  // namespace vobench
