// SPDX-License-Identifier: Apache-2.0
// What a scene needs: which parts of light transport can matter, from what is in the Scene and what
// moves in it. A pure function; every decision says why. make_lights() builds, and techniques
// compute, only what the plan uses: `tables->plan` of Lights.
//
// A part is left out only where it provably cannot change a picture: a material counts by what its
// textures, vertex colours and alpha leave of it (light/material/material_use.h), a light by its
// power, and what no instance shows does not count. Milliseconds, more where big textures must be
// looked at.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "light/material/material_use.h"
#include "world/scene.h"

namespace wellspring::light {

enum class TransportPart : uint8_t {
  area_lights,       // emitting triangles are sampled
  light_tree,        // chosen among by power and place; else by power alone
  emission_texture,  // and within a picture by its brightness; else one radiance all over
  punctual_lights,
  environment,             // light from infinity
  environment_importance,  // sampled by brightness; else found by scattering
  panes,                   // light passes straight through thin smooth glass; else plain occlusion
  refraction,              // solids with an inside; else no walk asks what it runs in
  absorption,              // that tint what runs in them
  dispersion,              // and bend wavelengths apart; else no walk has a wavelength
  coats,                   // clearcoat or sheen over the base
  caustics,                // light from a specular thing onto a rough one: photons
  kept_light,              // results may persist: what stands still, lit by what stands still
  dynamic_lights,          // that move or change: their light is found anew for each picture
  count
};
inline constexpr size_t transport_parts = size_t(TransportPart::count);
const char* transport_part_name(TransportPart part);

struct TransportDecision {
  bool used = true;
  std::string why;  // a phrase: "nothing of glass splits colours"
};

struct TransportPlan {
  TransportDecision decisions[transport_parts];
  std::vector<MaterialUse> materials;  // of each of the scene's; not visible: nothing shows it
  bool uses(TransportPart part) const { return decisions[size_t(part)].used; }
};

// `moving`: the meshes that move in the scene (World's); their materials are the scene's.
TransportPlan make_transport_plan(const Scene& scene, std::span<const Mesh* const> moving = {});
// The plan as two aligned lists for people, parts used and parts left out, each with its reason,
// and below a part what techniques make of it where they differ.
std::string explain(const TransportPlan& plan);

}  // namespace wellspring::light
