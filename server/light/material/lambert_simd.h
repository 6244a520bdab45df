// SPDX-License-Identifier: Apache-2.0
// Lambert's law (Lambertian.h) at eight places side by side.
#pragma once
#include <bit>

#include "light/material/lambert.h"
#include "world/surface_simd.h"

namespace wellspring::light {

struct LambertLobeLanes {
  Lanes3 normal, geometric_normal, reflectance;
  LambertLobe at(int lane) const {
    return {normal.at(lane), geometric_normal.at(lane), reflectance.at(lane)};
  }
};

inline Lanes3 clean(Lanes3 c) {
  const Lanes zero{}, one = all_lanes(1.0f);
  auto within = [&](Lanes x) { return x > zero ? lanes_min(x, one) : zero; };
  return {within(c.x), within(c.y), within(c.z)};
}

inline LambertLobeLanes make_lambert(const LambertSurfaceLanes& surface, const Lanes3& direction) {
  LambertLobeLanes lobes{surface.normal, surface.geometric_normal, clean(surface.base_color)};
  unsigned grazing = negative_lanes(dot(surface.normal, direction) >= 0);
  for (unsigned bits = grazing | surface.bent; bits; bits &= bits - 1) {
    int i = std::countr_zero(bits);
    lobes.normal.set(
        i, usable_normal(surface.normal.at(i), surface.geometric_normal.at(i), -direction.at(i)));
  }
  return lobes;
}

// eval_lambert_pdf.
inline Lanes eval_lambert_pdfs(const LambertLobeLanes& lobes, const Lanes3& direction) {
  Lanes cosine = dot(direction, lobes.normal);
  LaneMask above = (dot(direction, lobes.geometric_normal) > 0) & (cosine > 1e-6f);
  return above ? lanes_min(cosine, all_lanes(1.0f)) * (1 / pi) : Lanes{};
}

// Directions of sample_cosine_hemisphere around each normal; u, v uniform in [0, 1).
inline Lanes3 sample_cosine_directions(const Lanes3& n, Lanes u, Lanes v) {
  Lanes quarter = v * 4;
  LaneMask turn = __builtin_convertvector(quarter + 0.5f, LaneMask);
  Lanes x = (quarter - __builtin_convertvector(turn, Lanes)) * (pi / 2), x2 = x * x;
  Lanes s = x2 * (1 / 362880.0f) - 1 / 5040.0f, c = x2 * (1 / 40320.0f) - 1 / 720.0f;
  s = x * (1 + x2 * (-1 / 6.0f + x2 * (1 / 120.0f + x2 * s)));
  c = 1 + x2 * (-0.5f + x2 * (1 / 24.0f + x2 * c));
  LaneMask odd = (turn & 1) != 0, back = (turn & 2) != 0;
  Lanes cosine = odd ? -s : c, sine = odd ? c : s, radius = lanes_sqrt(u);
  radius = back ? -radius : radius;
  // make_frame_axes.
  Lanes sign = LaneMask(n.z) < 0 ? all_lanes(-1) : all_lanes(1.0f);
  Lanes a = -1 / (sign + n.z), b = n.x * n.y * a;
  Lanes3 tangent{1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
  Lanes3 bitangent{b, sign + n.y * n.y * a, -n.y};
  return tangent * (radius * cosine) + bitangent * (radius * sine) +
         n * lanes_sqrt(lanes_max(1 - u, Lanes{}));
}

}  // namespace wellspring::light
