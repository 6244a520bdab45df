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

// Says how far and how finely light is followed; techniques ignore settings that they do not read.

// Holds the settings of instant_radiosity; numbers are those of each of the columns x rows sets of
// point lights and photons.
struct InstantRadiositySettings {
  int columns = 3, rows = 3;  // block of pixels that do not share a set; odd, up to 7
  int places = 24;            // places on emitters and in the sky
  int walks = 32;             // walks from these, each leaving point lights where it scatters
  int bounced = 96;           // lights of walks that are kept, if few of them do most to the view
  int asked = 10;     // lights that a pixel asks, chosen by their effect on its region; 0: all kept
  int edge_rays = 2;  // more eye rays for a pixel at an edge of a surface or colour
  int candidates = 16;  // factor on the numbers of places and walks drawn; 1: all are kept
  float clip = -1;      // metres: shortest distance that counts; 0: none; <0: by the scene's size
  bool compensate = true;   // light that clipping took is gathered by a ray; else it is missing
  int photons = 12000;      // photons emitted towards specular things
  float photon_radius = 0;  // metres; 0: by the scene's size, shrinking from pass to pass
};

// Holds the settings of multires_splatting (light/virtual).
struct SplatSettings {
  int virtual_lights = 256;  // at most most_virtual_lights
  int texels = 4096;         // texels of all reflective shadow maps together
  int coarsest = 16;         // subsplats along the shorter side of the picture, at least
  int levels = -1;           // levels of refinement from there; <0: down to single pixels
  // Greatest range of a subsplat's depth, as a share of its least depth.
  float depth_threshold = 0.03f;
  float normal_threshold = 0.25f;  // greatest range of a component of its unit normals
  float convergence = 0;   // >0: refined also if irradiance bends by more than that share of it
  bool visibility = true;  // shadow rays from what is lit to virtual lights
  // Without shadow rays, each light sends so many rays to find the share of it that arrives at
  // visible places, on average (light/virtual/splat_visibility.h); 0: all arrives.
  int light_rays = 0;
  int shadow_rays = 8;  // shadow rays of each subsplat
  int probe_rays = 8;   // rays of each subsplat above a pixel, to find whether visibility changes
  // Share of their light by which probes differ if visibility changes.
  float visibility_threshold = 0.2f;
  int smooth_visibility = 2;  // subsplats around each over which its visibility is averaged
  float detail = 0;           // surface detail term of the paper's section 4.2, 0 to 1
  // Least radius of a virtual light, metres; 0: by the maps' distances.
  float least_distance = 0;
  float bound = 1;  // factor on that radius; 0: light is not bounded near virtual lights
};
inline constexpr int most_virtual_lights = 1 << 16;

struct TransportSettings {
  // Path edges counted from the eye, but for what glass does; 1: emission only, 2: direct light.
  int max_depth = 8;
  float clamp =
      0;  // >0: bound of what one sample owes to chance (radiance; biased, for display); 0: none
  InstantRadiositySettings instant;
  SplatSettings splat;
};

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
