// SPDX-License-Identifier: Apache-2.0
// Takes sky and stars out of a picture of a nebula (Wenger and others, section 5.3: the background
// goes by a threshold, stars by a mask that diffusion fills). Light is linear.
#pragma once
#include <cstdint>
#include <vector>

#include "image/image.h"

namespace wellspring::volume {

// Returns linear light of sRGB codes (IEC 61966-2-1) of 8 or 16 bits, over black where alpha is
// less than whole. The picture's own curve is unknown: many are stretched to show what is faint.
image::LinearImage linearise(const image::ImageCodes& codes);

// Averages squares of `factor` times `factor` pixels; what is left over at the right and at the
// bottom is averaged over the pixels there are.
image::LinearImage shrink(const image::LinearImage& picture, int factor);

struct StarSettings {
  // Half the side of the window whose median stands for the nebula; 0: a 64th of the picture's
  // longer side, at least 3. Stars are found whose light lies within about a third of it; knots
  // and filaments of the nebula are wider.
  int radius = 0;
  double contrast = 1;    // least height of a star over that median, in medians
  double least = 0.01;    // and in parts of the picture's brightest light
  double roundest = 2.5;  // longest shape, long axis by short, that is a star
};

struct StarReport {
  vec3 sky{0};                // light that was taken off everywhere
  int stars = 0;              // found and filled
  int pixels = 0;             // filled with them
  std::vector<uint8_t> mask;  // 1: filled; a byte a pixel
};

// Makes every pixel a finite number of 0 and more, takes off the median of the picture's edge, and
// fills stars, if `remove_stars`, from what surrounds them.
StarReport clean_sky(image::LinearImage& picture, bool remove_stars,
                     const StarSettings& settings = {});

}  // namespace wellspring::volume
