// SPDX-License-Identifier: Apache-2.0
// A few places that a view shows, and point lights chosen by what they do there: Georgiev and
// Slusallek, "Simple and Robust Iterative Importance Sampling of Virtual Point Lights" (2010). Most
// light of a castle never comes near the room that is looked at; of many candidates those are kept,
// at random, that light it, each worth more the likelier it was to be dropped, so that the mean is
// that of all.
#pragma once
#include "light/instant/point_light_shading.h"
#include "light/sample/medium.h"
#include "world/view.h"

namespace wellspring::light {

struct ViewProbes {
  std::vector<Surface> surfaces;
  std::vector<Bsdf> bsdfs;
  std::vector<Media> media;
  std::vector<LitPlace> places;  // of them
};

// Places first seen by rays through the picture, behind mirrors where those are all there is.
ViewProbes probe_view(const Transport& transport, const View& view, int max_depth, int count,
                      uint64_t seed, uint32_t index);

// Typical length of a ray that leaves the places seen: half of all are shorter. 0: none hits
// anything.
float probe_free_path(const Transport& transport, const ViewProbes& probes);

// Chooses `wanted` of the lights [begin, end) of `candidates` by their mean effect on the probes, a
// share of them regardless of it, and deals them to `sets` sets; the light of each set is in the
// mean that of all candidates. Where effects are so even that choosing would lose more than it
// saves, all are dealt. choose_u, deal_u: uniform in [0, 1).
struct ChosenLight {
  uint32_t light = 0, set = 0;
  float factor = 1;  // on its radiance
};
std::vector<ChosenLight> choose_lights(const Transport& transport, const ViewProbes& probes,
                                       const InstantPass& candidates, uint32_t begin, uint32_t end,
                                       int max_depth, int wanted, int sets, float choose_u,
                                       float deal_u);

}  // namespace wellspring::light
