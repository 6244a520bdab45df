// SPDX-License-Identifier: Apache-2.0
// Measures how different two pictures look when one flips from one to the other on a screen:
// LDR-FLIP (Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild, "FLIP: A
// Difference Evaluator for Alternating Images", HPG 2020). 0: no difference to be seen, 1: black
// against white. It is pure, deterministic and uses all cores; it takes tens of milliseconds for a
// million pixels. Sizes must agree and not be 0 (std::invalid_argument otherwise).
#pragma once
#include "frame/frame.h"
#include "frame/tonemap.h"

namespace wellspring::test {

struct FlipSettings {
  // Pixels a degree of the viewer's visual angle; the paper's default is a 0.7 m wide screen of
  // 3840 pixels seen from 0.7 m. With more, finer detail is lost on the eye.
  float pixels_per_degree = 67;
};

struct FlipMap {
  int width = 0, height = 0;
  std::vector<float> error;  // error of each pixel, 0 to 1, top row first
  double mean = 0;           // the paper's pooling (section 5): one number for the pair
};

FlipMap eval_flip(const Image8& test, const Image8& reference, const FlipSettings& settings = {});

// Compares pictures in linear radiance as a visitor would see them: both go through our own display
// mapping (frame/tonemap.h: exposure, shoulder, sRGB, 8 bits) first, so that what the screen cannot
// show does not count and the numbers belong to our pictures, not to another tone mapper's. For
// HDR-FLIP's sweep over exposures, call it with several.
FlipMap eval_flip(const Frame& test, const Frame& reference, const Tonemap& display = {},
                  const FlipSettings& settings = {});

// Returns the mean alone.
double flip(const Frame& test, const Frame& reference, const Tonemap& display = {});

}  // namespace wellspring::test
