// Correction of the checksums of a PNG's chunks.
#pragma once

#include <cstdint>
#include <vector>

namespace fuzz {

// Corrects all complete chunks. Bytes that are no PNG stay unchanged.
void MendPngSums(std::vector<std::uint8_t>& bytes);

}  // namespace fuzz
