// SPDX-License-Identifier: Apache-2.0
// Guides of a picture at rest (light/visible/guides.h), from the visibility pass: the surface of
// every pixel at a few places of it. Only of what may be polished a ray is asked, in the first
// pass, as its guides are those of what it shows.
#pragma once
#include <cstdint>
#include <vector>

#include "light/visible/guides.h"
#include "light/visible/visibility.h"

namespace wellspring::picture {

inline constexpr int guide_places = 4;  // that antialias well enough

// One visibility pass: adds what it sees at place `place` of the pixels, of guide_places. The first
// makes the planes the view's size, begins anew and overwrites `followed`: not 0 of pixels whose
// guides are a ray's, which the others leave alone.
void add_still_guides(const World& world, const Lights& lights, const VisibilityPass& visibility,
                      const View& view, RasterShows shows, int place, GuidePlanes& planes,
                      std::vector<uint8_t>& followed);

}  // namespace wellspring::picture
