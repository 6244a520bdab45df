// SPDX-License-Identifier: Apache-2.0
// Holds the cluster of wavelengths that a walk carries once it has met dispersive glass
// (dispersion.h), and the colour it has.
//
// A channel of colour is the mean over wavelengths, weighted by a response that is nowhere negative
// and adds up to one: the matching functions of Wyman, Sloan and Shirley 2013 as Rec. 709, cut at
// zero. So white stays white, and no colour that reaches a picture is below zero or more than three
// times what an undispersed walk had brought.
#pragma once
#include "light/material/bsdf_types.h"

namespace wellspring::light {

inline constexpr int wavelength_count = 4;

// Holds the wavelengths that a walk carries.
struct Wavelengths {
  int carried = 0;                  // 0: none yet, and the rest is not set; 1: the hero alone
  float place;                      // place of the hero in [0, 1); the others follow at equal steps
  vec3 value[wavelength_count];     // throughput of the way so far, for each
  float density[wavelength_count];  // density with which each had led along it
};

// Returns the wavelength at a place in [0, 1), in nanometres: places are as dense as the mean
// response.
float wavelength_at(float place);
// Returns what a walk of this wavelength alone brings to each channel; the mean over places is 1.
vec3 response_at(float place);
// Returns the place of the i-th wavelength.
inline float place_of(const Wavelengths& carried, int i) {
  float place = carried.place + float(i) / wavelength_count;
  return place < 1 ? place : place - 1;
}
// Returns the colour of a walk that has come here with this cluster, against one without
// wavelengths.
vec3 tint_of(const Wavelengths& carried);
// Returns a / b if b is above 0, else 0, channel by channel.
inline vec3 divide_tint(vec3 a, vec3 b) {
  for (int c = 0; c < 3; c++) a[c] = b[c] > 0 ? a[c] / b[c] : 0;
  return a;
}

// Holds one BSDF more for each further wavelength. It lives as long as the Bsdf that points to it
// is used.
struct WavelengthSpread {
  Wavelengths before;
  bool fresh = false;  // the walk was in colour up to here
  Bsdf others[wavelength_count - 1];
};
inline vec3 tint_before(const WavelengthSpread& spread) {
  return spread.fresh ? vec3(1) : tint_of(spread.before);
}

// Returns the place of the one wavelength that is left; <0: the walk is in colour, or in a cluster,
// which is nearly the same.
inline float hue_of(const Wavelengths& carried) {
  return carried.carried == 1 ? carried.place : -1;
}
// Walks of the eye and of light that meet are one walk if they have the same wavelength, which by
// chance they never have: two within a bandwidth are taken for one, as photons within a radius are
// taken for the same place. meet_hues() returns the factor on the product of both walks' colours;
// its mean over either hue is that of one walk.
inline constexpr float hue_bandwidth = 1.0f / 8;
vec3 meet_hues(float eye, float light);

// Makes the hero's value the cluster's; called by eval_bsdf. `others`: the values of spread.others.
void blend_wavelengths(const WavelengthSpread& spread, const BsdfValue* others, BsdfValue& value);

}  // namespace wellspring::light
