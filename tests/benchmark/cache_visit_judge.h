// SPDX-License-Identifier: Apache-2.0
// How good a displayed picture is, apart from FLIP: pure functions of pictures.
#pragma once
#include <span>
#include <vector>

#include "frame/frame.h"
#include "world/view.h"
#include "world/world.h"

namespace wellspring::test {

// Root of the mean squared difference of display values (sRGB-encoded, 0 to 1).
double display_rmse(const Image8& test, const Image8& reference);
// The same against what two independent, equally noisy pictures estimate: the mean of the product
// of the differences, in which the noise of neither counts. 0 where chance makes it negative.
double display_rmse(const Image8& test, const Image8& one, const Image8& other);

// Holds what a view really shows, by primary rays without samples of light: through every pixel's
// centre and, for objects, through the pixels' corners too.
struct TrueView {
  View view;
  std::vector<uint32_t> object, corner;  // corner: (width + 1) * (height + 1)
  std::vector<vec3> position;  // hits of the centres' rays; unit direction where nothing is hit
  std::vector<uint8_t> hit;
  std::vector<Hit> where;  // on a moving mesh: which triangle; else invalid
};

// Share of pixels whose object is neither at the pixel's centre nor at any of its corners: wrong
// even for a sample anywhere in the pixel.
double wrong_surface_share(const TrueView& truth, std::span<const uint32_t> shown);

// Returns where the surface at each pixel's centre was in the picture before, in pixels; NaN where
// it was not seen then. `moved_back(hit)`: where a place on a moving mesh was then.
template <class MovedBack>
std::vector<vec2> motion_vectors(const TrueView& now, const TrueView& before, MovedBack moved_back);

// Root mean square of luminance's (display, 0 to 1) change from one picture to the next along the
// motion: what flickers, crawls or jumps. Bilinear in the picture before. NaN where nothing
// compares.
double motion_compensated_error(const Image8& now, const Image8& before,
                                std::span<const vec2> motion);

// Implementation of the template.

// Place of a point in a view and whether that view sees it there: same object, and a place no
// farther off than the surface's own change across a pixel.
vec2 find_again(const TrueView& before, vec3 place, bool infinite, uint32_t object);

template <class MovedBack>
std::vector<vec2> motion_vectors(const TrueView& now, const TrueView& before,
                                 MovedBack moved_back) {
  std::vector<vec2> motion(now.object.size());
  for (size_t i = 0; i < motion.size(); i++) {
    vec3 place = now.where[i].valid() ? moved_back(now.where[i]) : now.position[i];
    motion[i] = find_again(before, place, !now.hit[i], now.object[i]);
  }
  return motion;
}

}  // namespace wellspring::test
