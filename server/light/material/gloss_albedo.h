// SPDX-License-Identifier: Apache-2.0
// What part of light from all around a surface's gloss reflects, about: for light whose direction
// is not known.
#pragma once
#include "base/simd.h"
#include "light/material/bsdf_frame.h"

namespace wellspring::light {

// What of a dielectric decides it.
struct GlossFactors {
  float f0, roughness, share;  // reflectance at the normal; 0 to 1; of what is no metal
};
inline GlossFactors gloss_factors(const Material& m) {
  float root = (m.ior - 1) / (m.ior + 1);
  return {clean(root * root * m.specular), clean(m.roughness), 1 - clean(m.metallic)};
}

// Albedo of a rough dielectric's reflection towards `cosine` of the normal (Karis 2014, "Physically
// Based Shading on Mobile": a fit).
inline Lanes gloss_albedo(Lanes f0, Lanes r, Lanes share, Lanes cosine) {
  Lanes steep = (1 - r) * (1 - r);
  Lanes power = all_lanes(1);  // 2^(-9.28 cosine), by (1 - x / 8)^8 of its logarithm
  for (int i = 0; i < 8; i++)
    power *= lanes_max(1 - cosine * (9.28f * 0.6931472f / 8), all_lanes(0));
  Lanes a = lanes_min(steep, power) * (1 - r) + (-0.0275f * r + 0.0425f);
  Lanes scale = -1.04f * a + (-0.572f * r + 1.04f), bias = 1.04f * a + (0.022f * r - 0.04f);
  Lanes albedo = (f0 * scale + (f0 > 0 ? bias : all_lanes(0))) * share;
  return lanes_min(lanes_max(albedo, all_lanes(0)), all_lanes(1));
}

}  // namespace wellspring::light
