// Depth noise of a structured-light camera (Kinect).
// Source: Barron and Malik 2013, "Intrinsic scene properties from a single RGB-D image", as used for ICL-NUIM (Handa et
//   al. 2014): pixels are shifted, disparities are noisy and quantised.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sim {

// With (dx, dy) normal of standard deviation 1/2 px and n normal of standard deviation 1/6:
//   Z' = 351.30 m / round(351.30 m / Z(x + dx, y + dy) + n),
// Z(.) bilinear in depth where its four neighbours lie within 10 cm of each other, else the nearest of them. 0 stays 0.
// A function of the arguments alone.
std::vector<float> WithKinectNoise(std::span<const float> depth_m, int width, int height, std::uint64_t seed,
                                   std::int64_t frame);

}  // namespace sim
