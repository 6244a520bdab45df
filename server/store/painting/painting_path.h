// SPDX-License-Identifier: Apache-2.0
// Makes the paths of paintings: of a short text, of letters, of a line drawn by hand.
#pragma once
#include <string>

#include "store/painting/painting.h"

namespace wellspring::store {

// Reads "M x y L x y C x y x y x y R x y x y ... Z": the letters of SVG, capitals only, and R for a
// smooth curve through points (Catmull and Rom 1974), which closes smoothly before Z. Returns what
// is wrong, empty: nothing.
std::string read_paint_path(const std::string& text, PaintPath& path);

// Returns an ellipse, turned by radians.
PaintPath ellipse_path(dvec2 middle, dvec2 radii, double turn);

// Describes letters: `family` is "serif", "sans" or "script"; `size` is that of an em.
struct PaintLettering {
  std::string text, family = "serif";
  bool bold = false, slanted = false;
  double size = 0.01, align = 0;  // 0: begins at `at`, 0.5: is centred there, 1: ends there
  dvec2 at{0};
  double turn = 0;  // radians
};
// Returns the letters' outlines; they come from the machine's fonts, and are the same at all
// scales.
PaintPath letter_path(const PaintLettering& lettering);
// Returns how far a line of letters reaches.
double letter_width(const PaintLettering& lettering);

// Returns the path with its straight lines cut and moved by up to `amount`, as a hand draws them.
PaintPath wobbled_path(const PaintPath& path, double amount, double period, uint64_t seed);

// Returns corners of the path's straight and curved lines; parts follow one another.
std::vector<dvec2> flatten_path(const PaintPath& path);
// Returns whether a point lies within corners, by the even-odd rule.
bool is_within(const std::vector<dvec2>& corners, dvec2 point);

}  // namespace wellspring::store
