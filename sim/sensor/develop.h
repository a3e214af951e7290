// Image processing after the sensor: demosaicing, JPEG compression.
#pragma once

#include "sim/sensor/image.h"

namespace sim {

// The channel that the pixel's filter lets through: RGGB, red at (0, 0). 0: red, 1: green, 2: blue.
inline int BayerChannel(int x, int y) { return (x & 1) + (y & 1); }

// Colour from a picture behind a Bayer filter, by OpenCV's edge-aware interpolation (8 bits) or its bilinear one. In a
// picture of one pixel a side a colour that has no pixel is that of the pixels that are there.
Image Demosaic(const Image& mosaic);

// The picture as it comes back from a JPEG file of this quality (1 ... 100), chroma at half resolution. 8 bits.
Image ThroughJpeg(const Image& image, int quality);

}  // namespace sim
