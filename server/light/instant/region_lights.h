// SPDX-License-Identifier: Apache-2.0
// Point lights for every region of a picture: of the many that a pass has, a pixel asks a few, and
// which these are is chosen by what they would do, were nothing in between, to a few places that
// its region shows. Pixels of a region are of several lists, neighbours of different ones: what a
// list lacks is noise from pixel to pixel, which the filter and the eye take away, and not a block
// of one shade. All pixels of a region and list ask the same, so that their shadow rays stay near
// each other, and a pixel's answer depends on nothing but the pass. As chosen at random and weighed
// by their chance, they are in the mean worth all of them. After Wang and Akerlund, "Bidirectional
// Importance Sampling for Unstructured Direct Illumination" (2009), with a picture's regions for
// clusters.
#pragma once
#include "light/instant/instant_pass.h"
#include "world/view.h"

namespace wellspring::light {

// Fills pass.regions from its lights: about `asked` for each list of a region besides the exact
// ones.
void choose_region_lights(const Transport& transport, const View& view, int max_depth, int asked,
                          uint64_t seed, uint32_t index, InstantPass& pass);

}  // namespace wellspring::light
