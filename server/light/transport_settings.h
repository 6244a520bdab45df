// SPDX-License-Identifier: Apache-2.0
// How far and how finely light is followed; what no technique reads is ignored.
#pragma once

namespace wellspring {

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

struct TransportSettings {
  int max_depth = 8;  // path edges counted from the eye; 1: emission only, 2: direct light
  float clamp =
      0;  // >0: bound of what one sample owes to chance (radiance; biased, for display); 0: none
  InstantRadiositySettings instant;
};

}  // namespace wellspring
