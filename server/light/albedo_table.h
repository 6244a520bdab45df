// SPDX-License-Identifier: Apache-2.0
// How much a GGX reflection lobe reflects in all, by angle and roughness: what is left goes to the
// layer beneath (Kulla and Conty 2017), and what single scattering loses is given back to metals
// and rough glass (Turquin 2019).
#pragma once
#include "base/vec.h"

namespace wellspring {

struct AlbedoTable {
  static constexpr int angles = 32, roughnesses = 16;
  float reflected[roughnesses][angles];  // by sqrt(alpha) and sqrt(cosine), both over [0, 1]
  float average[roughnesses];            // cosine-weighted over the hemisphere
};

// A row of the table at one roughness, ready for look-ups by angle.
struct AlbedoRow {
  const float* low = nullptr;
  const float* high = nullptr;
  float weight = 0, average = 0;
};
AlbedoRow albedo_row(const AlbedoTable& table, float alpha);
float eval_albedo(const AlbedoRow& row, float cosine);

// A dielectric of one index: its reflection from outside, and reflection and refraction together
// from either side, which is what single scattering keeps of light that nothing absorbs.
struct DielectricAlbedo {
  AlbedoTable coat, into, out_of;
};
// Indices are rounded to a fixed set, so that there is a bounded number of tables. Made on first
// use (some ten milliseconds), kept for the life of the process.
const DielectricAlbedo& dielectric_albedo(float ior);
// For a reflector that absorbs nothing.
const AlbedoTable& mirror_albedo();

}  // namespace wellspring
