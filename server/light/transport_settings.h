// SPDX-License-Identifier: Apache-2.0
// Says how far and how finely light is followed; techniques ignore settings that they do not read.
#pragma once

namespace wellspring::light {

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
  // Volumes that stand in the scene are seen by the eye itself, not only in mirrors. Else whoever
  // shows the picture lays them over it.
  bool sees_volumes = false;
  InstantRadiositySettings instant;
  SplatSettings splat;
};

}  // namespace wellspring::light
