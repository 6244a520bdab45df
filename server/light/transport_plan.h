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
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "light/material/material_use.h"
#include "world/scene.h"

namespace wellspring::light {

// How far and how finely light is followed; what no technique reads is ignored.

// Of instant_radiosity: numbers of each of the columns x rows sets of point lights and photons.
struct InstantRadiositySettings {
  int columns = 3, rows = 3;  // pixels that do not share a set; odd, up to 7
  int places = 24;            // on emitters and in the sky
  int walks = 32;             // from them, each leaving point lights where it scatters
  int bounced = 96;           // of those lights are kept, where few of them do most to the view
  int asked = 10;             // by a pixel, chosen by what they may do to its region; 0: all kept
  int edge_rays = 2;          // more eye rays for a pixel at an edge of a surface or colour
  int candidates = 16;  // times as many places and walks are drawn as numbered here; 1: all kept
  float clip = -1;      // metres: shortest distance that counts; 0: none; <0: by the scene's size
  bool compensate = true;   // what clipping took is gathered by a ray, else it is missing
  int photons = 12000;      // emitted towards specular things
  float photon_radius = 0;  // metres; 0: by the scene's size, shrinking from pass to pass
};

// How virtual point lights are chosen among the texels of reflective shadow maps.
enum class VirtualLightChoice : uint8_t {
  uniform,          // evenly over each map
  by_flux,          // by the flux that a texel reflects
  low_discrepancy,  // at Sobol' points of each map
  by_effect,        // by flux and by what a texel does, unshadowed, to places that are seen
};

// Of multires_splatting (light/splat).
struct SplatSettings {
  int virtual_lights = 256;  // at most most_virtual_lights
  int texels = 4096;         // of all reflective shadow maps together
  VirtualLightChoice choice = VirtualLightChoice::by_flux;
  int coarsest = 16;               // subsplats along the shorter side of the picture, at least
  int levels = -1;                 // of refinement from there; <0: down to single pixels
  float depth_threshold = 0.03f;   // of a subsplat's range of depth, as a share of its least depth
  float normal_threshold = 0.25f;  // of the range of a component of its unit normals
  float convergence = 0;   // >0: refined, too, where irradiance bends by more than that share of it
  bool visibility = true;  // shadow rays from what is lit to virtual lights
  // Where there are none, rays of each light that tell what of it arrives at what is seen, on
  // average (light/splat/splat_visibility.h); 0: all does.
  int light_rays = 0;
  int shadow_rays = 8;  // of each subsplat
  int probe_rays = 8;   // of each subsplat above a pixel, to find where visibility changes
  float visibility_threshold = 0.2f;  // it changes: probes differ in so much of their light
  int smooth_visibility = 2;          // subsplats around each over which its visibility is averaged
  float detail = 0;                   // surface detail term of the paper's section 4.2, 0 to 1
  float least_distance = 0;  // metres, of a virtual light's radius; 0: by the maps' distances
  float bound = 1;           // factor on that radius; 0: light is not bounded near virtual lights
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
