// SPDX-License-Identifier: Apache-2.0
// Tabulates how much of the light that a rough boundary scatters leaves it after one meeting with a
// facet, by angle and roughness. The rest meets more facets, and is given back by a lobe of its own
// (Kulla and Conty 2017, "Revisiting physically based shading at Imageworks"); light that a
// dielectric does not reflect goes to the layer beneath.
//
// Near the horizon the loss of a GGX surface depends on cosine / alpha alone: a ridge 11 % high
// where the two are equal, however smooth the surface. A table over the cosine cannot follow it, so
// losses are kept over t / (t + r), with t and r the roots of cosine and alpha; the mean Fresnel
// reflectance, which has no such ridge, is kept over t. Both are linear in between.
#pragma once
#include <cmath>
#include <memory>

#include "base/vec.h"

namespace wellspring::light {

// Lobes too smooth for any pixel to show the difference count as perfect.
inline constexpr float smooth_alpha = 1e-3f;

struct AlbedoTable {
  static constexpr int angles = 32, roughnesses = 40, averages = 8 * (roughnesses - 1) + 1;
  float value[roughnesses][angles];
  // Mean over the hemisphere, weighted by the cosine, of the values as they are looked up: by this
  // mean light given back adds up. It is more closely spaced, as it spans six orders of magnitude.
  float average[averages];
};

// Holds a row of the table at one roughness, ready for look-ups by angle.
struct AlbedoRow {
  const float* low = nullptr;
  const float* high = nullptr;
  float weight = 0, average = 0;
};
// Holds where rows of one roughness are, the same in all tables.
struct AlbedoPlace {
  int low, average;
  float weight, average_weight;
};
AlbedoPlace albedo_place(float root_alpha);  // smooth_alpha and above
inline AlbedoRow albedo_row(const AlbedoTable& table, const AlbedoPlace& at) {
  return {table.value[at.low], table.value[at.low + 1], at.weight,
          glm::mix(table.average[at.average], table.average[at.average + 1], at.average_weight)};
}
inline AlbedoRow albedo_row(const AlbedoTable& table, float alpha) {
  return albedo_row(table, albedo_place(std::sqrt(alpha)));
}

inline float eval_row(const AlbedoRow& row, float position) {
  position *= AlbedoTable::angles - 1;
  int at = glm::min(int(position), AlbedoTable::angles - 2);
  float weight = position - float(at);
  return glm::mix(glm::mix(row.low[at], row.low[at + 1], weight),
                  glm::mix(row.high[at], row.high[at + 1], weight), row.weight);
}

inline float eval_loss(const AlbedoRow& row, float root_alpha, float root_cosine) {
  return glm::max(eval_row(row, root_cosine / (root_cosine + root_alpha)), 1e-7f);
}

// Returns the share of light lost by a reflector that absorbs nothing.
const AlbedoTable& mirror_loss();

// Holds the tables for a dielectric of one index.
struct DielectricAlbedo {
  float fresnel_average = 0;  // mean over the smooth boundary, from outside
  // Mean reflectance of the facets whose light leaves; its `average` is that of all reflected light
  AlbedoTable fresnel;
  // Holds the share lost of reflection and refraction together, seen from outside and from inside.
  struct Glass {
    AlbedoTable into, out_of;
  };
  std::unique_ptr<const Glass> glass;  // null unless asked for
};
// Returns the tables of an index; 0: an infinite one. Indices are rounded to a fixed set, so that
// there is a bounded number of tables. They are made on first use (some tens of milliseconds, more
// with `glass`) and kept for the life of the process.
const DielectricAlbedo& dielectric_albedo(float ior, bool glass = true);

// Holds the same for one direction, summed over facets, for surfaces that no table covers.
struct FacetAlbedo {
  float kept = 1;       // share kept by a mirror
  float reflected = 1;  // share reflected by a dielectric
  float passed = 1;     // share reflected or refracted by it: the light that glass keeps
};
FacetAlbedo sum_albedo(vec3 view, vec2 alpha, float eta, bool glass, int points);

}  // namespace wellspring::light
