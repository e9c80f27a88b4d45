#pragma once

#include <cstdint>

namespace loopgrid {

struct Color {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;

  bool operator==(const Color&) const = default;
};

inline constexpr Color kBlack{0, 0, 0};
inline constexpr Color kWhite{255, 255, 255};

/// Mixes two colours: `share` 0 gives `a`, 1 gives `b`.
Color Mix(Color a, Color b, double share);

}  // namespace loopgrid
