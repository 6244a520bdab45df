// SPDX-License-Identifier: Apache-2.0
// Computes Lambert's law alone, for surfaces that is_lambertian: the results of make_bsdf,
// eval_bsdf and sample_bsdf there, without the lobes that such surfaces lack.
#pragma once
#include <bit>

#include "light/material/bsdf_types.h"
#include "world/surface.h"

namespace wellspring::light {

struct LambertLobe {
  vec3 normal, geometric_normal;  // the viewer's side; the shading normal as bsdf_types.h turns it
  vec3 reflectance;
};
inline LambertLobe make_lambert(const LambertSurface& surface, vec3 direction) {
  return {usable_normal(surface.normal, surface.geometric_normal, -direction),
          surface.geometric_normal, clean(surface.base_color)};
}

// Returns the density of sampling, which times the reflectance is also value times cosine.
inline float eval_lambert_pdf(const LambertLobe& lobe, vec3 direction) {
  float cosine = dot(direction, lobe.normal);
  bool above = dot(direction, lobe.geometric_normal) > 0 && cosine > 1e-6f;
  return above ? std::min(cosine, 1.0f) / pi : 0;
}

// Draws a direction. Its weight is the reflectance.
inline BsdfSample sample_lambert(const LambertLobe& lobe, vec2 u) {
  BsdfSample s;
  vec3 tangent, bitangent;
  make_frame_axes(lobe.normal, tangent, bitangent);
  vec3 l = sample_cosine_hemisphere(u);
  s.direction = tangent * l.x + bitangent * l.y + lobe.normal * l.z;
  s.pdf = eval_lambert_pdf(lobe, s.direction);
  if (s.pdf > 0) s.weight = lobe.reflectance;
  return s;
}

// Computes Lambert's law (lambert.h) at eight places side by side.

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

// Does eval_lambert_pdf in each lane.
inline Lanes eval_lambert_pdfs(const LambertLobeLanes& lobes, const Lanes3& direction) {
  Lanes cosine = dot(direction, lobes.normal);
  LaneMask above = (dot(direction, lobes.geometric_normal) > 0) & (cosine > 1e-6f);
  return above ? lanes_min(cosine, all_lanes(1.0f)) * (1 / pi) : Lanes{};
}

// Returns directions of sample_cosine_hemisphere around each normal; u, v uniform in [0, 1).
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
  // This is make_frame_axes.
  Lanes sign = LaneMask(n.z) < 0 ? all_lanes(-1) : all_lanes(1.0f);
  Lanes a = -1 / (sign + n.z), b = n.x * n.y * a;
  Lanes3 tangent{1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
  Lanes3 bitangent{b, sign + n.y * n.y * a, -n.y};
  return tangent * (radius * cosine) + bitangent * (radius * sine) +
         n * lanes_sqrt(lanes_max(1 - u, Lanes{}));
}

}  // namespace wellspring::light
