// SPDX-License-Identifier: Apache-2.0
// Holds the cluster of wavelengths that a walk carries once colours no longer suffice: where glass
// spreads them (dispersion.h), or where a second thing that is known by wavelength is met
// (reflect_wavelengths). Until then a walk has all of them, and its light is known in closed form.
//
// A cluster is 8 wavelengths at equal steps of the share below them. The first, the hero, chooses
// directions; each event multiplies each wavelength's value and the density with which it would
// have led there. The light of a walk is the sum of values times light that arrives, over the sum
// of densities: multiple importance sampling over products along the path (Radziszewski, Boryczko
// and Alda 2009, equations 6, 7 and 12). It is the mean over the cluster if nothing depends on the
// wavelength, and the hero alone is left if all does perfectly. The paper's bidirectional path
// tracing is not done.
#pragma once
#include "base/simd.h"
#include "light/material/bsdf_types.h"
#include "light/material/spectral_tables.h"

namespace wellspring::light {

inline constexpr int wavelength_count = lane_count;

// Holds the wavelengths that a walk carries. Its throughput has colours as if there were none;
// tint_of() turns these into those of the wavelengths.
struct Wavelengths {
  int carried = 0;      // 0: all; 1: the hero alone
  int reflected = -1;   // carried 0: the one reflectance that the walk has met, of Scene::spectra
  bool tinted = false;  // the walk's throughput has the tint already: tint_of() is 1
  // The rest is set if any are carried.
  float place;                 // place of the hero in [0, 1); the others follow at equal steps
  float nm[wavelength_count];  // 0: not carried
  Lanes value;                 // throughput of the way so far, of each
  Lanes density;               // density with which each had led along it, over the hero's
  vec3 colored;                // the part of `value` that the throughput has as colours
  bool in_color() const { return tinted || (carried == 0 && reflected < 0); }
};

// Returns the colour of light that a lamp sends along a walk with these wavelengths, over that of a
// walk in colour. `lamp`: index of its relative power in Scene::spectra; -1: its light has a
// colour.
vec3 tint_of(const SpectralTables& tables, const Wavelengths& carried, int lamp = -1);
// Does the same with no channel below zero, for light that is kept in colours.
vec3 shown_tint(const SpectralTables& tables, const Wavelengths& carried);
// Returns a / b if b is above 0, else 0, channel by channel.
inline vec3 divide_tint(vec3 a, vec3 b) {
  for (int c = 0; c < 3; c++) a[c] = b[c] > 0 ? a[c] / b[c] : 0;
  return a;
}

// Returns the hero's place for a number of the sample's well spread ones, in [0, 1), and for bits
// that have nothing to do with these: they choose the hero among the cluster (the paper, section
// 2.5: a choice by the same sequence gives wrong colours).
inline float hero_place(float u, uint64_t bits) {
  return std::min((u + float(bits % wavelength_count)) / wavelength_count, 0x1.fffffep-1f);
}
// Makes a walk that has all wavelengths carry a cluster. `place`: hero_place().
void begin_cluster(const SpectralTables& tables, float place, Wavelengths& carried);

// Adds the event that a surface reflects by a row of the tables: the cluster has begun, or the walk
// has met no such surface yet.
void reflect_wavelengths(const SpectralTables& tables, int reflectance, Wavelengths& carried);
// Adds the event that a solid absorbs, to a cluster that has begun. `tint`: the share of light that
// is left, as the throughput has it; above 0.
void absorb_wavelengths(const SpectralTables& tables, int absorption, float metres, vec3 tint,
                        Wavelengths& carried);

// Holds one BSDF more for each further wavelength. It lives as long as the Bsdf that points to it
// is used.
struct WavelengthSpread {
  const SpectralTables* tables = nullptr;
  Wavelengths before;
  vec3 tint_before{1};            // shown_tint() of the walk up to here
  float index[wavelength_count];  // the solid's
  int made = 0;                   // further BSDFs that are set: none if the surface is smooth
  Bsdf others[wavelength_count - 1];
};

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
vec3 meet_hues(const SpectralTables& tables, float eye, float light);

// Makes the hero's value the cluster's, over `tint_before`; called by eval_bsdf. `others`: the
// values of spread.others.
void blend_wavelengths(const WavelengthSpread& spread, const BsdfValue* others, BsdfValue& value);

}  // namespace wellspring::light
