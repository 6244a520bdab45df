// SPDX-License-Identifier: Apache-2.0
// Holds a surface's scattering at one place, seen from one direction, and the answers to requests;
// bsdf.h describes the model.
#pragma once
#include <cmath>
#include <cstdint>

#include "light/material/albedo_table.h"
#include "light/random/warp.h"
#include "world/surface.h"

namespace wellspring::light {

// The layers lie on top; the base gets what they leave.
struct Clearcoat {
  float strength = 0;                     // 0: none, and the rest is not set
  float alpha, share;                     // probability that sampling the specular lobes takes it
  vec3 tangent, bitangent, normal, view;  // its own frame, and the viewer in it
  float reflected;                        // share reflected at the viewer's angle
};
struct Sheen {
  vec3 color{0};  // black: none, and the rest is not set
  float alpha, share;
};

struct Bsdf {
  vec3 tangent{1, 0, 0}, bitangent{0, 0, 1},
      normal{0, 1, 0};  // shading frame, on the viewer's side
  vec3 geometric_normal{0, 1, 0};
  vec3 view{0, 0, 1};  // local, z > 0
  vec3 diffuse{0};     // diffuse reflectance
  vec3 metal{1};       // reflectance of the metal at normal incidence
  float metallic = 0;
  vec3 transmit{0};  // tint of light that goes through
  float alpha = 1;   // 0: perfectly smooth
  vec2 alphas{1};    // alpha along tangent and bitangent
  float eta = 1.5f;  // index of refraction beyond over here
  bool thin = true;
  bool within = false;  // the viewer is on the inner side of a solid's surface
  // The dielectric reflects facet_base + facet_slope * Fresnel (KHR_materials_specular).
  vec3 facet_base{0}, facet_slope{1};
  float dielectric_share = 1;  // dielectric's share of the reflection: the rest is metal

  // The following are shares of light by angle, all at this roughness.
  float root_alpha = 1;
  AlbedoRow loss, fresnel;             // rows of the facets; not set if smooth
  AlbedoRow glass_here, glass_beyond;  // share that glass loses, from either side
  // Multiple scattering: each times the loss at the other direction and its cosine.
  vec3 again{0}, glass_again{0}, glass_again_beyond{0};
  float again_share = 0, again_here = 1;  // chance that sampling takes it, and then to this side
  float again_scale = 0;                  // factor of its density
  bool has_coat = false;                  // the dielectric keeps some light from the diffuse layer
  // Light that the dielectric keeps: coat_loss * loss + coat_mirror * (1 - loss) + coat_fresnel *
  // (1 - loss) * fresnel.
  float coat_loss = 0, coat_mirror = 0, coat_fresnel = 0;
  float coat_passes = 1;    // 1 - reflected, from the viewer's angle
  float coat_scale = 1;     // 1 / (1 - average)
  float diffuse_share = 1;  // probability that sampling takes the diffuse lobe

  Clearcoat clearcoat;
  Sheen sheen;
  // Share that the layers leave to all of the above
  float beneath = 1;
  const struct WavelengthSpread* spread = nullptr;  // colours spread here (wavelengths.h); borrowed
};

// Holds each lobe's value times |cosine|, and the density with which sampling that lobe alone draws
// `l`. Perfect lobes count as 0. Sheen and clearcoat are specular lobes.
struct BsdfValue {
  vec3 diffuse{0}, specular{0};
  float diffuse_pdf = 0, specular_pdf = 0;
};

enum class Lobes : uint8_t { diffuse, specular, all };

enum class Bounce : uint8_t {
  reflect,
  refract,
  pass,  // straight through a thin smooth pane
};

struct BsdfSample {
  vec3 direction{0};
  vec3 weight{0};  // value * |cosine| / density; zero: the path ends
  float pdf = 0;   // 0: a perfect lobe
  Bounce bounce = Bounce::reflect;
  // A solid that light goes through caused it, smooth or by refraction: walks count that apart.
  bool glass = false;
};

// Makes the frames of a Bsdf's lobes from whatever normals and tangents a surface has.

inline vec3 to_local(const Bsdf& b, vec3 w) {
  return {dot(w, b.tangent), dot(w, b.bitangent), dot(w, b.normal)};
}
inline vec3 to_world(const Bsdf& b, vec3 w) {
  return b.tangent * w.x + b.bitangent * w.y + b.normal * w.z;
}

// Limits to `high` at most and 0 at least; NaN is 0.
inline float clean(float x, float high = 1) { return x > 0 ? std::min(x, high) : 0.0f; }
inline vec3 clean(vec3 c, float high = 1) {
  return {clean(c.x, high), clean(c.y, high), clean(c.z, high)};
}

// Returns the GGX alpha of a perceptual roughness; 0: perfectly smooth, as NaN is.
inline float alpha_of(float roughness) {
  float r = roughness > 0 ? std::min(roughness, 1.0f) : 0.0f;
  return r * r < smooth_alpha ? 0 : r * r;
}

// Returns a normal to shade with. A mapped or interpolated normal may face away from the viewer or
// mirror the viewer into the surface; then it is turned just far enough that its reflection leaves
// the surface.
inline vec3 usable_normal(vec3 n, vec3 geometric, vec3 v) {
  if (n == geometric && dot(v, n) > 0) return n;
  float least = std::min(0.01f, 0.9f * dot(v, geometric));
  vec3 mirrored = 2 * dot(v, n) * n - v;
  float height = dot(mirrored, geometric);
  if (dot(n, v) > 0 && height >= least) return n;
  mirrored = dot(n, v) > 0 ? mirrored + geometric * (least - height) : geometric;
  vec3 between = normalize(mirrored) + v;
  float length2 = dot(between, between);
  return length2 > 1e-12f ? between / std::sqrt(length2) : geometric;
}

// Makes axes around `n`, the first as near to `along` as possible; returns false if it is not
// possible.
inline bool make_frame_along(vec3 n, vec3 along, vec3& tangent, vec3& bitangent) {
  along -= n * dot(n, along);
  float length2 = dot(along, along);
  if (!(length2 > 1e-6f) || !std::isfinite(length2)) return false;
  tangent = along / std::sqrt(length2);
  bitangent = cross(n, tangent);
  return true;
}

}  // namespace wellspring::light
