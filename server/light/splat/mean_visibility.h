// SPDX-License-Identifier: Apache-2.0
// Shadows of virtual lights for the price of few rays, where each place cannot have its own: what
// of a light arrives at the places that are seen, on average, is what arrives everywhere. So light
// does not pass through walls, and a picture's light is right in the mean; that of places half in
// shadow is not.
#pragma once
#include <span>

#include "light/sample/transport.h"
#include "light/splat/virtual_lights.h"

namespace wellspring::light {

// Dims each light by the share of its light that arrives at `probes`, by at most `rays` rays a
// light, to probes that would have most of it. Lights that reach none are left out. All cores.
void dim_hidden_lights(const Transport& transport, std::span<const LitProbe> probes, int rays,
                       VirtualLights& lights);

}  // namespace wellspring::light
