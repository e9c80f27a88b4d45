#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace loopgrid {

/// How many bytes a pixel has, and what they mean.
enum class PixelFormat {
  kGrey = 1,
  kRedGreenBlue = 3,
};

/// The bytes of a PNG file of 8 bits a channel. `pixels` are row-major, the first row is the top.
/// The same pixels give the same bytes. Throws Error (kOutput) if the picture has no pixels, more
/// than 1,000,000 a side or another number of bytes than its size says, or if memory runs out.
std::string EncodePng(int width, int height, PixelFormat format,
                      std::span<const std::uint8_t> pixels);

}  // namespace loopgrid
