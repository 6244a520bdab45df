// SPDX-License-Identifier: Apache-2.0
// Files in centimetres or miles, found out by their size.
#pragma once

namespace wellspring::show {

// The scale that makes metres of a scene `largest` units across: 1 unless a visitor whose eye is
// `eye_height` metres high would take it for a toy (a tenth of that) or a country (250 times); a
// power of ten, for countries at most 0.01.
inline double propose_scale(double largest, double eye_height) {
  constexpr double toy = 0.1, country = 250, whole_toy = 0.3, whole_country = 30;
  double scale = 1;
  if (largest > country * eye_height)
    for (scale = 0.01; largest * scale > whole_country * eye_height;) scale /= 10;
  else if (largest > 0 && largest < toy * eye_height)
    while (largest * scale < whole_toy * eye_height) scale *= 10;
  return scale;
}

}  // namespace wellspring::show
