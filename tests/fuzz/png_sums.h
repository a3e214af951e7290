// The checksums of a PNG's chunks, put right.
#pragma once

#include <cstdint>
#include <vector>

namespace fuzz {

// Of as many chunks as there are; what is no PNG is left alone.
void MendPngSums(std::vector<std::uint8_t>& bytes);

}  // namespace fuzz
