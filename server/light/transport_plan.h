// SPDX-License-Identifier: Apache-2.0
// Decides which parts of light transport can matter to a scene, from what is in the Scene and what
// moves in it. The plan is a pure function of these; every decision has a reason. make_lights()
// builds, and techniques compute, only what the plan uses: `tables->plan` of Lights.
//
// A part is left out only if it provably cannot change a picture: a material counts by what its
// textures, vertex colours and alpha leave of it (light/material/material_use.h), a light by its
// power, and a mesh that no instance shows does not count. Takes milliseconds, more if big textures
// must be looked at.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "light/material/material_use.h"
#include "world/scene.h"

namespace wellspring::light {

enum class TransportPart : uint8_t {
  area_lights,       // emitting triangles are sampled
  light_tree,        // emitters are chosen by power and place; else by power alone
  emission_texture,  // places on them by their picture's brightness; else one radiance all over
  punctual_lights,
  environment,             // light from infinity
  environment_importance,  // sampled by brightness; else found by scattering
  panes,                   // light passes straight through thin smooth glass; else plain occlusion
  refraction,              // solids with an inside; else no walk asks what it runs in
  absorption,              // solids that tint light inside; else none is tinted
  dispersion,              // solids that bend wavelengths apart; else no walk has a wavelength
  spectra,                 // light and surfaces known by wavelength; else three colours are all
  coats,                   // clearcoat or sheen over the base
  caustics,                // light from a specular thing onto a rough one: photons
  kept_light,              // results may persist: what stands still, lit by what stands still
  dynamic_lights,          // lights that move or change, found anew for each picture
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
  std::vector<MaterialUse> materials;  // one for each of the scene's; not visible: nothing shows it
  bool uses(TransportPart part) const { return decisions[size_t(part)].used; }
};

// Makes the plan of a scene. `moving`: the meshes that move in it (World's); their materials are
// the scene's.
TransportPlan make_transport_plan(const Scene& scene, std::span<const Mesh* const> moving = {});
// Returns the plan as two aligned lists for people, parts used and parts left out, each with its
// reason, and below a part the notes of techniques that treat it differently.
std::string explain(const TransportPlan& plan);

}  // namespace wellspring::light
