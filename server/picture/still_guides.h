// SPDX-License-Identifier: Apache-2.0
// Guides of a picture at rest (light/guides.h), from the visibility pass: the surface of every
// pixel at a few places of it. Only of what may be polished rays are asked, as its guides are those
// of what it shows.
#pragma once
#include "light/guides.h"
#include "light/see_picture.h"

namespace wellspring {

inline constexpr int guide_places = 4;  // that antialias well enough

// One visibility pass: adds what it sees at place `place` of the pixels, of guide_places. The first
// makes the planes the view's size and begins anew.
void add_still_guides(const World& world, const Lights& lights, const PictureSight& sight,
                      const View& view, RasterShows shows, int place, GuidePlanes& planes);

}  // namespace wellspring
