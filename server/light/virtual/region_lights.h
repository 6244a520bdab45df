// SPDX-License-Identifier: Apache-2.0
// Chooses VPLs for every region of a picture: a pixel asks a few of the many that a pass
// has, chosen by what they would do, if nothing were in between, to a few places that its region
// shows. Pixels of a region belong to several lists, neighbours to different ones: what a list
// lacks is noise from pixel to pixel, which the filter and the eye take away, and not a block of
// one shade. All pixels of a region and list ask the same lights, so that their shadow rays stay
// near each other, and a pixel's result depends on nothing but the pass. Lights are chosen at
// random and weighed by their chance, so that in the mean they are worth all of them. After Wang
// and Akerlund, "Bidirectional Importance Sampling for Unstructured Direct Illumination" (2009),
// with a picture's regions for clusters.
#pragma once
#include "light/virtual/instant_pass.h"
#include "light/virtual/point_light_shading.h"
#include "light/sample/medium.h"
#include "world/view.h"

namespace wellspring::light {

// Finds a few places that a view shows, and chooses VPLs by what they do there: Georgiev
// and Slusallek, "Simple and Robust Iterative Importance Sampling of Virtual Point Lights" (2010).
// Most light of a castle never comes near the room that is looked at; of many candidates those that
// light it are kept, at random, each worth more the likelier it was to be dropped, so that the mean
// is that of all.

struct ViewProbes {
  std::vector<Surface> surfaces;
  std::vector<Bsdf> bsdfs;
  std::vector<Media> media;
  std::vector<LitPlace> places;  // made of the above
};

// Finds places first seen by rays through the picture, behind mirrors if those are all there is.
ViewProbes probe_view(const Transport& transport, const View& view, int max_depth, int count,
                      uint64_t seed, uint32_t index);

// Returns the typical length of a ray that leaves the places seen: half of all are shorter. 0: no
// ray hits anything.
float probe_free_path(const Transport& transport, const ViewProbes& probes);

// Chooses `wanted` of the lights [begin, end) of `candidates` by their mean effect on the probes, a
// share of them regardless of it, and deals them to `sets` sets; the light of each set is in the
// mean that of all candidates. If effects are so even that choosing would lose more than it saves,
// all are dealt. choose_u, deal_u: uniform in [0, 1).
struct ChosenLight {
  uint32_t light = 0, set = 0;
  float factor = 1;  // factor on the light's radiance
};
std::vector<ChosenLight> choose_lights(const Transport& transport, const ViewProbes& probes,
                                       const InstantPass& candidates, uint32_t begin, uint32_t end,
                                       int max_depth, int wanted, int sets, float choose_u,
                                       float deal_u);

// Fills pass.regions from its lights: about `asked` for each list of a region besides the exact
// ones.
void choose_region_lights(const Transport& transport, const View& view, int max_depth, int asked,
                          uint64_t seed, uint32_t index, InstantPass& pass);

}  // namespace wellspring::light
