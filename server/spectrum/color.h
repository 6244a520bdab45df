// SPDX-License-Identifier: Apache-2.0
// Colorimetry (CIE 15:2018): from X, Y and Z to what colours look like, and how much they differ.
// Colours are relative: Y of a white surface is 1.
#pragma once
#include <optional>

#include "base/vec.h"

namespace wellspring::spectrum {

// Returns L*, a* and b* of a colour beside a white.
dvec3 lab_of(const dvec3& xyz, const dvec3& white);
// Returns the color difference CIEDE2000, of which 1 to 2 is just seen (Sharma, Wu, Dalal 2005).
double ciede2000(const dvec3& lab, const dvec3& other);
// Returns u' and v' (CIE 1976), in which equal distances look about equally far.
dvec2 uv_of(const dvec3& xyz);

// Returns the colour that looks beside the white `to` as this one looked beside `from`, to whom is
// used to each: CAT16 (Li and others 2017), completely for a degree of 1, not at all for 0. Whites
// have Y of 1.
dvec3 adapt_cat16(const dvec3& xyz, const dvec3& from, const dvec3& to, double degree = 1);

// Converts between X, Y, Z and linear Rec. 709 red, green, blue, whose white is D65.
dvec3 rgb_of(const dvec3& xyz);
dvec3 xyz_of_rgb(const dvec3& rgb);

// Tells which blackbody looks most like a light, and how far in u, v (CIE 1960) it is from that, to
// four decimals; above 0 is greener.
struct ColorTemperature {
  double kelvin = 0, duv = 0;
};
// Returns none where the light is farther than 0.05 from every blackbody of 1000 to 25000 K.
std::optional<ColorTemperature> correlated_temperature(const dvec3& xyz);

}  // namespace wellspring::spectrum
