// SPDX-License-Identifier: Apache-2.0
// Intensity of a colour given as 8-bit codes, and the differences of its opponent colours.
#pragma once

namespace wellspring::attention {

// `out`: intensity (r + g + b) / 3, 0 to 1, and the differences of the broadly tuned colours R, G,
// B and Y, each colour over r + g + b, so that hue counts and brightness does not. Hue cannot be
// seen in the dark: both differences are 0 where r + g + b <= `dark`. For numbers and for eight of
// them. Y = (r + g) / 2 - |r - g| / 2 - b = min(r, g) - b.
template <class T, class Least, class Positive, class Choose>
void eval_channels(T r, T g, T b, T dark, const Least& least, const Positive& positive,
                   const Choose& choose, T (&out)[3]) {
  T sum = r + g + b;
  T red = positive(r - 0.5f * (g + b)), green = positive(g - 0.5f * (r + b)),
    blue = positive(b - 0.5f * (r + g)), yellow = positive(least(r, g) - b);
  out[0] = sum * (1 / 765.0f);
  out[1] = choose(sum > dark, (red - green) / sum);
  out[2] = choose(sum > dark, (blue - yellow) / sum);
}

}  // namespace wellspring::attention
