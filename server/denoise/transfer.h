// SPDX-License-Identifier: Apache-2.0
// What the published networks see of radiance: the perceptually uniform curve of Open Image Denoise
// (a fit of PU encoding, Aydin, Mantiuk, Seidel 2008, for luminances of 1e-6 to 65504), 0 to 1.
#pragma once
#include <algorithm>
#include <cmath>

#include "base/vec.h"

namespace wellspring::denoise {

namespace transfer {
inline constexpr float a = 1412.83765f, b = 1.64593172f, c = 0.431384981f, d = -0.00294139609f,
                       e = 0.192653254f, f = 0.00626026094f, g = 0.998620152f;
inline constexpr float y0 = 1.5794576e-6f, y1 = 0.0322087631f;  // where the pieces meet
inline constexpr float x0 = 0.00223151711f, x1 = 0.370974749f;  // the same, encoded
inline constexpr float most = 65504;                            // the largest half: is encoded as 1

inline float piece(float y) {
  if (y <= y0) return a * y;
  if (y <= y1) return b * std::pow(y, c) + d;
  return e * std::log(y + f) + g;
}
inline const float largest = piece(most);
}  // namespace transfer

// NaN and negative values become 0, larger ones than `most` that.
inline float encode_radiance(float y) {
  return transfer::piece(y > 0 ? std::min(y, transfer::most) : 0.0f) / transfer::largest;
}
inline float decode_radiance(float x) {
  using namespace transfer;
  x = (x > 0 ? std::min(x, 1.0f) : 0.0f) * largest;
  if (x <= x0) return x / a;
  if (x <= x1) return std::pow((x - d) / b, 1 / c);
  return std::exp((x - g) / e) - f;
}

}  // namespace wellspring::denoise
