#include "mapping/color.h"

#include <cmath>

namespace loopgrid {
namespace {

std::uint8_t MixChannel(std::uint8_t a, std::uint8_t b, double share) {
  return static_cast<std::uint8_t>(std::lround(a + share * (b - a)));
}

}  // namespace

Color Mix(Color a, Color b, double share) {
  return {MixChannel(a.red, b.red, share), MixChannel(a.green, b.green, share),
          MixChannel(a.blue, b.blue, share)};
}

}  // namespace loopgrid
