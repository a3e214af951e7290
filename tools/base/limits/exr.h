// Purpose: whether an OpenEXR file may be given to its library, by its header: the library (3.1) makes room for an
// attribute of any size
//          that the header tells, and for tables of a picture of any height.
// Source:  the OpenEXR file layout, openexr.com/en/latest/OpenEXRFileLayout.html.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace limits {

// What is wrong; empty: nothing. `file`: all of it. Sizes of pictures are those of PictureSizeProblem.
std::string ExrProblem(std::span<const std::uint8_t> file);

}  // namespace limits
