// SPDX-License-Identifier: Apache-2.0
// A surface's scattering at one place, seen from one direction, and what is asked of it; bsdf.h
// tells the model.
#pragma once
#include <cstdint>

#include "light/material/albedo_table.h"
#include "world/surface.h"

namespace wellspring::light {

// Layers on top; the base gets what they leave.
struct Clearcoat {
  float strength = 0;                     // 0: none, and the rest is not set
  float alpha, share;                     // probability that sampling the specular lobes takes it
  vec3 tangent, bitangent, normal, view;  // its own frame, and the viewer in it
  float reflected;                        // at the viewer's angle
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
  vec3 transmit{0};  // tint of what goes through
  float alpha = 1;   // 0: perfectly smooth
  vec2 alphas{1};    // along tangent and bitangent
  float eta = 1.5f;  // index of refraction beyond over here
  bool thin = true;
  bool within = false;  // the viewer is on the inner side of a solid's surface
  // The dielectric reflects facet_base + facet_slope * Fresnel (KHR_materials_specular).
  vec3 facet_base{0}, facet_slope{1};
  float dielectric_share = 1;  // of the reflection: the rest is metal

  // Shares of light by angle, all at this roughness.
  float root_alpha = 1;
  AlbedoRow loss, fresnel;             // of facets; not set where smooth
  AlbedoRow glass_here, glass_beyond;  // what glass loses, from either side
  // What scatters more than once: each times the loss at the other direction and its cosine.
  vec3 again{0}, glass_again{0}, glass_again_beyond{0};
  float again_share = 0, again_here = 1;  // that sampling takes it, and then to this side
  float again_scale = 0;                  // of its density
  bool has_coat = false;                  // the dielectric keeps something from the diffuse layer
  // That is coat_loss * loss + coat_mirror * (1 - loss) + coat_fresnel * (1 - loss) *
  // fresnel.
  float coat_loss = 0, coat_mirror = 0, coat_fresnel = 0;
  float coat_passes = 1;    // 1 - reflected, from the viewer's angle
  float coat_scale = 1;     // 1 / (1 - average)
  float diffuse_share = 1;  // probability that sampling takes the diffuse lobe

  Clearcoat clearcoat;
  Sheen sheen;
  float beneath = 1;                                // what the layers leave to all of the above
  const struct WavelengthSpread* spread = nullptr;  // colours parted here (wavelengths.h); borrowed
};

// Each lobe's value times |cosine|, and the density with which sampling that lobe alone draws `l`.
// Perfect lobes count as 0. Sheen and clearcoat are specular lobes.
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
  // A solid that light goes through did it, smooth or by refraction: walks count that apart.
  bool glass = false;
};

}  // namespace wellspring::light
